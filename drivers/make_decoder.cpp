#include "drivers/make_decoder.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

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

/// As many beams as the model has, of the table or of the unit.
std::span<const Beam> beams_of(const SensorModel& model, const Calibration& calibration) {
  const auto* const unit = std::get_if<std::vector<Beam>>(&calibration);
  const auto beams = unit != nullptr ? std::span<const Beam>(*unit) : model.beams;
  if (beams.size() != model.beam_count) {
    throw std::runtime_error(std::string(model.name) + " has " + std::to_string(model.beam_count) +
                             " beams, its calibration " + std::to_string(beams.size()) +
                             ": is it another sensor's?");
  }
  return beams;
}

/// Exactly N beams of the table or of the unit.
template <std::size_t N>
std::span<const Beam, N> beams_of(const SensorModel& model, const Calibration& calibration) {
  return beams_of(model, calibration).first<N>();
}

const robosense::Description& robosense_description(PacketFormat format) {
  if (format == PacketFormat::robosense_rs32) return robosense::kRs32;
  return format == PacketFormat::robosense_rs16 ? robosense::kRs16 : robosense::kHelios16p;
}

AnyDecoder make_robosense(const SensorModel& model, const DecoderOptions& options,
                          const Calibration& calibration) {
  const robosense::Description& description = robosense_description(model.format);
  const auto* const unit = std::get_if<std::vector<Beam>>(&calibration);
  const auto beams = unit != nullptr ? std::span<const Beam>(*unit) : std::span<const Beam>();
  if (unit != nullptr && beams.size() != description.lasers) {
    throw std::runtime_error(std::string(model.name) + " has " + std::to_string(description.lasers) +
                             " beams, its calibration " + std::to_string(beams.size()) +
                             ": is it another sensor's?");
  }
  return AnyDecoder(robosense::Decoder(description, beams, options));
}

const ouster::Metadata& metadata_of(const SensorModel& model, const Calibration& calibration) {
  const auto* const metadata = std::get_if<ouster::Metadata>(&calibration);
  if (metadata == nullptr) {
    throw std::runtime_error(std::string(model.name) +
                             " needs its metadata file: get it from http://SENSOR/api/v1/sensor/metadata");
  }
  if (metadata->beam_count != model.beam_count) {
    throw std::runtime_error(std::string(model.name) + " has " + std::to_string(model.beam_count) +
                             " beams, its metadata " + std::to_string(metadata->beam_count) +
                             ": is it another sensor's?");
  }
  return *metadata;
}

AnyDecoder make_hdl64(const SensorModel& model, velodyne::Hdl64Generation generation,
                      const DecoderOptions& options, const Calibration& calibration) {
  if (std::holds_alternative<std::vector<Beam>>(calibration)) {
    throw std::runtime_error(std::string(model.name) + ": the calibration is another sensor's");
  }
  const auto* const unit = std::get_if<velodyne::Hdl64Calibration>(&calibration);
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
          velodyne::Vls128Decoder(beams_of<velodyne::kVls128Lasers>(model, calibration), options));
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
      return make_robosense(model, options, calibration);
  }
  throw std::runtime_error(std::string(model.name) + ": its packet format has no decoder");
}

}  // namespace landfix::drivers
