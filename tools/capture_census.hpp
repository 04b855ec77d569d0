// What a capture holds, so that a command can name its sensor or say why it cannot.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "drivers/sensor_model.hpp"
#include "platform/packet_source.hpp"

namespace landfix::tools {

class CaptureCensus {
 public:
  /// Reads the source to its end.
  explicit CaptureCensus(platform::PacketSource& source);

  /// Models that packets were recognised of, in the order of the catalogue.
  [[nodiscard]] const std::vector<const drivers::SensorModel*>& candidates() const { return candidates_; }

  /// Port to which the model's data packets were sent: those that name it, or, where none does, those of its
  /// size; its usual port first, then the one with most. 0 if there are none.
  [[nodiscard]] std::uint16_t port_of(const drivers::SensorModel& model) const;

  /// "603 UDP packets of 1206 bytes to port 2368, ...", or "no UDP packet".
  [[nodiscard]] std::string to_string() const;

 private:
  using PortAndSize = std::pair<std::uint16_t, std::size_t>;
  using CountByPort = std::map<std::uint16_t, std::uint64_t>;
  std::map<PortAndSize, std::uint64_t> counts_;
  std::map<const drivers::SensorModel*, CountByPort> recognised_;
  std::map<const drivers::SensorModel*, CountByPort> sized_;
  std::vector<const drivers::SensorModel*> candidates_;
};

}  // namespace landfix::tools
