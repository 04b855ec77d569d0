// What a log of CAN frames holds: poses, and all that is wrong with their protection.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "platform/pose_frame_decoder.hpp"
#include "platform/pose_report.hpp"

namespace landfix::tools {

enum class CanFaultKind : std::uint8_t {
  wrong_crc,
  repeated,
  lost,
  wrong_sequence,
  out_of_order,
  incomplete_pose,
  silence,
};
inline constexpr std::size_t kCanFaultKinds = 7;
/// As the keys of --json.
[[nodiscard]] std::string_view to_string(CanFaultKind kind);

struct CanFault {
  std::int64_t stamp_utc_ns = 0;  ///< of the frame that shows it
  std::string_view frame;
  CanFaultKind kind{};
  std::string what;  ///< for people
};

/// Nothing for a frame that is as it should be; else one or more.
[[nodiscard]] std::vector<CanFault> faults_of(const platform::DecodedFrame& decoded,
                                              std::int64_t stamp_utc_ns);
/// The log ends in the middle of a pose.
[[nodiscard]] CanFault end_of_log_fault(std::size_t frames_missing, std::int64_t stamp_utc_ns);

[[nodiscard]] nlohmann::ordered_json to_json(const platform::PoseReport& pose);
/// Of DecodedFrame::geodetic.
[[nodiscard]] nlohmann::ordered_json to_json_geodetic(const platform::PoseReport& place);
[[nodiscard]] nlohmann::ordered_json to_json(const CanFault& fault);

/// The title of the columns of `to_line`, as a comment.
[[nodiscard]] std::string pose_title();
[[nodiscard]] std::string to_line(const platform::PoseReport& pose);
[[nodiscard]] std::string to_line_geodetic(const platform::PoseReport& place);
[[nodiscard]] std::string to_line(const CanFault& fault);

}  // namespace landfix::tools
