// CAN frames as lines of text, as candump -l writes and canplayer reads them:
//   (1700000000.123456) can0 3A0#471387D6124CA4FE
//   (1700000000.123456) can0 3A9##1...             CAN FD: flags, 1 for the faster bit rate; then the data
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/atomic_file.hpp"
#include "platform/can_frame.hpp"

namespace landfix::platform {

/// As the kernel takes them: 1 to 15 characters, no blank, no slash.
[[nodiscard]] bool is_can_interface_name(std::string_view name) noexcept;

/// A log in place of a bus. The file appears, whole, with `commit`.
class CandumpLog final : public FrameSink {
 public:
  /// `interface`: the name that the lines carry. Throws std::runtime_error.
  CandumpLog(std::filesystem::path path, std::string interface);

  /// Does not allocate; stamps are cut to microseconds. Takes nothing more once the disk has refused a write.
  [[nodiscard]] std::size_t send(std::span<const CanFrame> group,
                                 std::int64_t stamp_utc_ns) noexcept override;

  /// Throws std::runtime_error where a write has failed.
  void commit();

 private:
  [[nodiscard]] bool write(const CanFrame& frame, std::int64_t stamp_utc_ns) noexcept;

  AtomicFile file_;
  std::string interface_;
  bool failed_ = false;
};

struct LoggedFrame {
  std::int64_t stamp_utc_ns = 0;
  std::string_view interface;  ///< points into the line
  CanFrame frame{};
};

/// The data frames of a log, by rising stamps, those of one stamp in the order of the log. Throws
/// std::runtime_error where there is none.
[[nodiscard]] std::vector<StampedFrame> read_candump(const std::filesystem::path& path);

/// A data frame; nothing for remote frames and lines that are no frame.
[[nodiscard]] std::optional<LoggedFrame> parse_candump_line(std::string_view line) noexcept;

}  // namespace landfix::platform
