#include "drivers/decoder.hpp"

namespace landfix::drivers {

std::string_view to_string(DecodeStatus status) noexcept {
  switch (status) {
    case DecodeStatus::decoded:
      return "decoded";
    case DecodeStatus::wrong_size:
      return "payload size is not the model's";
    case DecodeStatus::wrong_header:
      return "a marker, flag, count or unit does not fit the model";
    case DecodeStatus::wrong_model:
      return "the packet names another sensor model";
    case DecodeStatus::wrong_return_mode:
      return "return mode is not one of the model's";
    case DecodeStatus::wrong_azimuth:
      return "azimuth is not within one turn";
    case DecodeStatus::wrong_time:
      return "not a date or a time";
  }
  return "unknown status";
}

}  // namespace landfix::drivers
