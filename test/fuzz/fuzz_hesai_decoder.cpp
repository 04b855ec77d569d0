// The first byte says which packet is changed: either model's, or a GPS packet.
#include "fuzz/fuzz_decoder.hpp"
#include "support/synthetic_packets.hpp"

namespace {

void fuzz(const char* model, landfix::test::PandarPacket sound, std::span<const std::byte> input) {
  sound.set_azimuths(35980, 20, 2);
  for (std::size_t slot = 0; slot < sound.lasers(); ++slot) sound.set_return(3, slot, 1000);
  landfix::test::fuzz_decoder(model, sound.bytes(), input);
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
  if (size == 0) return 0;
  const auto input = std::as_bytes(std::span(data, size)).subspan(1);
  switch (data[0] % 3) {
    case 0:
      fuzz("pandar64", landfix::test::Pandar64Packet(0x39, 6, 1), input);
      break;
    case 1:
      fuzz("pandar40p", landfix::test::Pandar40pPacket(0x39, 1), input);
      break;
    default:
      landfix::test::fuzz_decoder("pandar40p", gps_packet(), input);
  }
  return 0;
}
