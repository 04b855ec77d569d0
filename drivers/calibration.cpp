#include "drivers/calibration.hpp"

#include <stdexcept>
#include <string>

#include "drivers/hesai/calibration.hpp"
#include "drivers/ouster/metadata_file.hpp"
#include "drivers/robosense/calibration.hpp"
#include "drivers/velodyne/azimuth_offsets.hpp"
#include "drivers/velodyne/hdl64_calibration_file.hpp"

namespace landfix::drivers {

Calibration parse_calibration(const SensorModel& model, std::span<const std::byte> file,
                              std::string_view name) {
  switch (model.format) {
    case PacketFormat::hesai_pandar:
      return hesai::parse_calibration(file, name, model.beams);
    case PacketFormat::robosense_rs32:
    case PacketFormat::robosense_rs16:
    case PacketFormat::robosense_helios16p:
      return robosense::parse_calibration(file, name, model.beam_count);
    case PacketFormat::ouster:
      return ouster::parse_metadata(model, file, name);
    case PacketFormat::velodyne_hdl64_s1:
    case PacketFormat::velodyne_hdl64_s2:
    case PacketFormat::velodyne_hdl64_s3:
      return velodyne::parse_hdl64_calibration(file, name);
    case PacketFormat::velodyne_vls128:
      return velodyne::parse_azimuth_offsets(file, name, model.beams);
    case PacketFormat::velodyne_hdl32e:
    case PacketFormat::velodyne_vlp32c:
    case PacketFormat::velodyne_vlp16:
    case PacketFormat::velodyne_vlp16hires:
      break;
  }
  throw std::runtime_error(std::string(name) + ": " + std::string(model.name) +
                           " takes no calibration, its beams are the model's");
}

}  // namespace landfix::drivers
