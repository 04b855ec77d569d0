#include "drivers/make_decoder.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace landfix::drivers {
namespace {

void check(const SensorModel& model, const DecoderOptions& options) {
  if (!std::isfinite(options.cut_deg))
    throw std::runtime_error("cut_deg is not a number: give an angle in degrees");
  if (!(options.min_range_m >= 0.0 && options.min_range_m < options.max_range_m)) {
    throw std::runtime_error("min_range_m must be at least 0 and less than max_range_m");
  }
  if (!options.range_unit_m) return;
  if (model.format != PacketFormat::robosense_rs32) {
    throw std::runtime_error("range_unit_m is for rs32 alone: leave it out for " + std::string(model.name));
  }
  if (*options.range_unit_m != 0.005 && *options.range_unit_m != 0.01) {
    throw std::runtime_error("range_unit_m is 0.005 or 0.01: leave it out if the firmware is not from 2018");
  }
}

/// The unit's own; null where there is none. Throws where it is of another kind than the model's.
template <class T>
const T* unit_of(const SensorModel& model, const Calibration& calibration) {
  const T* const unit = std::get_if<T>(&calibration);
  if (unit == nullptr && !std::holds_alternative<std::monostate>(calibration)) {
    throw std::runtime_error(std::string(model.name) +
                             ": the calibration is of another kind of sensor: give the file of this unit");
  }
  return unit;
}

void check_beam_count(const SensorModel& model, std::size_t count) {
  if (count == model.beam_count) return;
  throw std::runtime_error(std::string(model.name) + " has " + std::to_string(model.beam_count) +
                           " beams, its calibration " + std::to_string(count) + ": is it another sensor's?");
}

/// Of the unit, else of the model, whose table may be empty.
std::span<const Beam> beams_of(const SensorModel& model, const Calibration& calibration) {
  const auto* const unit = unit_of<std::vector<Beam>>(model, calibration);
  if (unit == nullptr) return model.beams;
  check_beam_count(model, unit->size());
  return *unit;
}

const robosense::Description& robosense_description(PacketFormat format) {
  if (format == PacketFormat::robosense_rs32) return robosense::kRs32;
  return format == PacketFormat::robosense_rs16 ? robosense::kRs16 : robosense::kHelios16p;
}

const ouster::Metadata& metadata_of(const SensorModel& model, const Calibration& calibration) {
  const auto* const metadata = unit_of<ouster::Metadata>(model, calibration);
  if (metadata == nullptr) {
    throw std::runtime_error(std::string(model.name) +
                             " needs its metadata file: get it from http://SENSOR/api/v1/sensor/metadata");
  }
  check_beam_count(model, metadata->beam_count);
  return *metadata;
}

AnyDecoder make_hdl64(const SensorModel& model, velodyne::Hdl64Generation generation,
                      const DecoderOptions& options, const Calibration& calibration) {
  const auto* const unit = unit_of<velodyne::Hdl64Calibration>(model, calibration);
  if (unit == nullptr && model.calibration == CalibrationUse::required) {
    throw std::runtime_error(std::string(model.name) +
                             " has no points without the unit's calibration: give its db.xml");
  }
  return AnyDecoder(velodyne::Hdl64Decoder(generation, unit, options));
}

}  // namespace

AnyDecoder make_decoder(const SensorModel& model, const DecoderOptions& options,
                        const Calibration& calibration) {
  check(model, options);
  if (model.calibration == CalibrationUse::none && !std::holds_alternative<std::monostate>(calibration)) {
    throw std::runtime_error(std::string(model.name) + " takes no calibration, its beams are the model's");
  }
  switch (model.format) {
    case PacketFormat::velodyne_vls128:
      return AnyDecoder(
          velodyne::Vls128Decoder(beams_of(model, calibration).first<velodyne::kVls128Lasers>(), options));
    case PacketFormat::velodyne_hdl64_s1:
      return make_hdl64(model, velodyne::Hdl64Generation::s1, options, calibration);
    case PacketFormat::velodyne_hdl64_s2:
      return make_hdl64(model, velodyne::Hdl64Generation::s2, options, calibration);
    case PacketFormat::velodyne_hdl64_s3:
      return make_hdl64(model, velodyne::Hdl64Generation::s3, options, calibration);
    case PacketFormat::velodyne_hdl32e:
      return AnyDecoder(velodyne::BlockDecoder(velodyne::kHdl32e, model.beams, options));
    case PacketFormat::velodyne_vlp32c:
      return AnyDecoder(velodyne::BlockDecoder(velodyne::kVlp32c, model.beams, options));
    case PacketFormat::velodyne_vlp16:
      return AnyDecoder(velodyne::BlockDecoder(velodyne::kVlp16, model.beams, options));
    case PacketFormat::velodyne_vlp16hires:
      return AnyDecoder(velodyne::BlockDecoder(velodyne::kVlp16HiRes, model.beams, options));
    case PacketFormat::hesai_pandar:
      return AnyDecoder(
          hesai::PandarDecoder(hesai::layout_of(model.beam_count), beams_of(model, calibration), options));
    case PacketFormat::ouster:
      return AnyDecoder(ouster::OusterDecoder(metadata_of(model, calibration), options));
    case PacketFormat::robosense_rs32:
    case PacketFormat::robosense_rs16:
    case PacketFormat::robosense_helios16p:
      return AnyDecoder(
          robosense::Decoder(robosense_description(model.format), beams_of(model, calibration), options));
  }
  throw std::runtime_error(std::string(model.name) + ": its packet format has no decoder");
}

}  // namespace landfix::drivers
