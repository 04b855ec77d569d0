#include "drivers/decoder.hpp"

namespace landfix::drivers {

std::uint64_t rejected(const StatusCounts& counts) noexcept {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (is_rejected(static_cast<DecodeStatus>(i))) sum += counts[i];
  }
  return sum;
}

std::string_view to_string(DecodeStatus status) noexcept {
  switch (status) {
    case DecodeStatus::decoded:
      return "decoded";
    case DecodeStatus::telemetry:
      return "position, status or calibration";
    case DecodeStatus::wrong_size:
      return "payload size is not the model's";
    case DecodeStatus::wrong_header:
      return "a marker, flag, count or unit does not fit the model";
    case DecodeStatus::wrong_model:
      return "the packet names another sensor model or unit";
    case DecodeStatus::wrong_return_mode:
      return "return mode is not one of the model's";
    case DecodeStatus::wrong_azimuth:
      return "azimuth is not within one turn";
    case DecodeStatus::wrong_time:
      return "not a date or a time, or far from that of its neighbours";
    case DecodeStatus::wrong_checksum:
      return "checksum does not fit: damaged on the way";
    case DecodeStatus::uncalibrated:
      return "the unit's calibration has not come yet";
    case DecodeStatus::duplicate:
      return "has come before";
    case DecodeStatus::late:
      return "its sweep has been handed over already";
  }
  return "unknown status";
}

}  // namespace landfix::drivers
