#include "tools/capture_census.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace landfix::tools {
namespace {

constexpr std::size_t kListed = 8;

}  // namespace

CaptureCensus::CaptureCensus(platform::PacketSource& source) {
  platform::UdpPacket packet;
  while (source.next(packet) == platform::ReadStatus::packet) {
    ++counts_[{packet.destination_port, packet.payload.size()}];
    for (const drivers::SensorModel& model : drivers::sensor_models()) {
      if (!drivers::looks_like(model, packet.payload)) continue;
      if (std::ranges::find(candidates_, &model) == candidates_.end()) candidates_.push_back(&model);
    }
  }
}

std::uint16_t CaptureCensus::port_of(const drivers::SensorModel& model) const {
  std::map<std::uint16_t, std::uint64_t> by_port;
  for (const auto& [key, count] : counts_) {
    const auto& [port, size] = key;
    if (size != 0 && std::ranges::find(model.payload_sizes, size) != model.payload_sizes.end()) {
      by_port[port] += count;
    }
  }
  if (by_port.empty()) return 0;
  if (by_port.contains(model.data_port)) return model.data_port;
  return std::ranges::max_element(by_port, {}, [](const auto& entry) { return entry.second; })->first;
}

std::string CaptureCensus::to_string() const {
  if (counts_.empty()) return "no UDP packet";
  std::vector<std::pair<PortAndSize, std::uint64_t>> sorted(counts_.begin(), counts_.end());
  std::ranges::stable_sort(sorted, std::greater(), [](const auto& entry) { return entry.second; });
  std::string text;
  for (std::size_t i = 0; i < std::min(sorted.size(), kListed); ++i) {
    const auto& [key, count] = sorted[i];
    text += fmt::format("{}{} UDP packets of {} bytes to port {}", i == 0 ? "" : ", ", count, key.second,
                        key.first);
  }
  if (sorted.size() > kListed) text += fmt::format(", and {} other kinds", sorted.size() - kListed);
  return text;
}

}  // namespace landfix::tools
