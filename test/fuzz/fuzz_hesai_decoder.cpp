// The first byte says of which model the packets are, and whether GPS packets are among them.
#include <array>
#include <string_view>

#include "fuzz/fuzz_decoder.hpp"
#include "support/synthetic_packets.hpp"

namespace {

using landfix::test::FuzzedSensor;

std::vector<std::byte> data_packet(landfix::test::PandarPacket sound) {
  sound.set_azimuths(35980, 20, 2);
  for (std::size_t slot = 0; slot < sound.lasers(); ++slot) sound.set_return(3, slot, 1000);
  return landfix::test::to_bytes(sound.bytes());
}

/// Locked, 2020-06-25 12:02:09.
std::vector<std::byte> gps_packet() {
  std::vector<std::byte> packet(512);
  constexpr std::string_view kStamp =
      "\xFF\xEE"
      "026052"
      "902021";
  for (std::size_t i = 0; i < kStamp.size(); ++i) packet[i] = static_cast<std::byte>(kStamp[i]);
  packet[506] = std::byte{'A'};
  packet[507] = std::byte{1};
  return packet;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto pandar64 = data_packet(landfix::test::Pandar64Packet(0x39, 6, 1));
  static const auto pandar40p = data_packet(landfix::test::Pandar40pPacket(0x39, 1));
  static const std::array sensors{FuzzedSensor("pandar64", {pandar64}),
                                  FuzzedSensor("pandar40p", {pandar40p}),
                                  FuzzedSensor("pandar64", {pandar64, gps_packet()}),
                                  FuzzedSensor("pandar40p", {pandar40p, gps_packet()})};
  if (size == 0) return 0;
  landfix::test::fuzz_decoder(sensors[data[0] % sensors.size()],
                              std::as_bytes(std::span(data, size).subspan(1)));
  return 0;
}
