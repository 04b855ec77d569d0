// What each thread did when, sweep by sweep, as the JSON that Perfetto (ui.perfetto.dev) and Chrome show.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "platform/atomic_file.hpp"
#include "platform/engine_links.hpp"

namespace landfix::tools {

/// Written as it comes, in fixed memory. Times count from the first sweep's first packet. Not for a real-time
/// thread; throws std::runtime_error where the file cannot be written.
class TraceWriter {
 public:
  explicit TraceWriter(const std::filesystem::path& path);

  /// In the order of the sweeps.
  void add(const platform::SolvedSweep& sweep);
  /// In the order of sending, each after its sweep.
  void add(const platform::SentSweep& sent);
  /// Without it there will be no file.
  void commit();

 private:
  enum class Track : std::uint8_t { receive, solve, send };
  static constexpr std::size_t kTracks = 3;
  struct Span {
    std::int64_t begin_ns = 0;
    std::int64_t end_ns = 0;
  };

  void add_event(std::string_view event);
  bool add_span(Track track, std::string_view name, Span span, std::string_view arguments = {});
  void add_flow(Track track, char phase, std::int64_t at_ns, std::int64_t stamp_utc_ns);
  void add_counter(std::string_view name, std::int64_t at_ns, double value);
  [[nodiscard]] double us(std::int64_t at_ns) const { return 1e-3 * static_cast<double>(at_ns - begin_ns_); }

  platform::AtomicFile file_;
  bool has_event_ = false;
  std::int64_t begin_ns_ = 0;
  std::array<std::int64_t, kTracks> ended_ns_{};  ///< of each track's last span
  std::int64_t counted_ns_ = 0;
};

}  // namespace landfix::tools
