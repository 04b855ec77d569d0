#include "tools/capture_census.hpp"

#include <algorithm>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace landfix::tools {
namespace {

constexpr std::size_t kListed = 8;

}  // namespace

CaptureCensus::CaptureCensus(platform::PacketSource& source) {
  platform::UdpPacket packet;
  while (source.next(packet) == platform::ReadStatus::packet) {
    ++counts_[{packet.destination_port, packet.payload.size()}];
    for (const drivers::SensorModel& model : drivers::sensor_models()) {
      if (!drivers::has_size_of(model, packet.payload)) continue;
      ++sized_[&model][packet.destination_port];
      if (drivers::looks_like(model, packet.payload)) ++recognised_[&model][packet.destination_port];
    }
  }
  for (const auto& [model, ports] : recognised_) candidates_.push_back(model);
}

std::uint16_t CaptureCensus::port_of(const drivers::SensorModel& model) const {
  for (const auto* const counts : {&recognised_, &sized_}) {
    const auto by_port = counts->find(&model);
    if (by_port == counts->end()) continue;
    if (by_port->second.contains(model.data_port)) return model.data_port;
    return std::ranges::max_element(by_port->second, {}, [](const auto& entry) { return entry.second; })
        ->first;
  }
  return 0;
}

std::string CaptureCensus::to_string() const {
  if (counts_.empty()) return "no UDP packet";
  std::vector<std::pair<PortAndSize, std::uint64_t>> sorted(counts_.begin(), counts_.end());
  std::ranges::stable_sort(sorted, std::greater(), [](const auto& entry) { return entry.second; });
  std::vector<std::string> kinds;
  for (const auto& [key, count] : std::span(sorted).first(std::min(sorted.size(), kListed))) {
    kinds.push_back(fmt::format("{} UDP packets of {} bytes to port {}", count, key.second, key.first));
  }
  if (sorted.size() > kListed) kinds.push_back(fmt::format("and {} other kinds", sorted.size() - kListed));
  return fmt::format("{}", fmt::join(kinds, ", "));
}

}  // namespace landfix::tools
