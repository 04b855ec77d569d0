#include "drivers/sensor_model.hpp"

#include <algorithm>

#include "drivers/hesai/models.hpp"
#include "drivers/ouster/models.hpp"
#include "drivers/robosense/models.hpp"
#include "drivers/velodyne/models.hpp"

namespace landfix::drivers {
namespace {

template <std::size_t... Sizes>
constexpr auto concatenate(const std::array<SensorModel, Sizes>&... parts) noexcept {
  std::array<SensorModel, (Sizes + ...)> all{};
  auto* next = all.begin();
  ((next = std::copy(parts.begin(), parts.end(), next)), ...);
  return all;
}

constexpr auto kModels = concatenate(velodyne::kModels, hesai::kModels, ouster::kModels, robosense::kModels);

}  // namespace

std::string_view to_string(CalibrationUse use) noexcept {
  switch (use) {
    case CalibrationUse::none:
      return "none";
    case CalibrationUse::optional:
      return "optional";
    case CalibrationUse::in_stream:
      return "in_stream";
    case CalibrationUse::required:
      return "required";
  }
  return "unknown";
}

std::span<const SensorModel> sensor_models() noexcept { return kModels; }

const SensorModel* find_sensor_model(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(kModels, name, &SensorModel::name);
  return found == kModels.end() ? nullptr : found;
}

bool looks_like(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  return model.recognise != nullptr && model.recognise(model, payload);
}

bool has_size_of(const SensorModel& model, std::span<const std::byte> payload) noexcept {
  return std::ranges::find(model.payload_sizes, payload.size()) != model.payload_sizes.end();
}

}  // namespace landfix::drivers
