#include <cstdint>

#include "fuzz/fuzz_decoder.hpp"
#include "support/ouster_packets.hpp"

namespace {

namespace ouster = landfix::drivers::ouster;

landfix::test::FuzzedSensor os1(ouster::Metadata metadata) {
  landfix::test::OusterPacket sound(metadata);
  sound.set_place(2, 1'700'000'000'000'000'000);
  for (std::size_t row = 0; row < 16; ++row) sound.set_return(3, row, 1000);
  return {"os1-16", {landfix::test::to_bytes(sound.bytes())}, metadata};
}

/// Each profile: with its own header, with FUSA's, and that with a window.
std::vector<landfix::test::FuzzedSensor> all_profiles() {
  std::vector<landfix::test::FuzzedSensor> sensors;
  for (std::size_t i = 0; i < ouster::kProfiles.size(); ++i) {
    auto metadata = landfix::test::ouster_metadata(static_cast<ouster::Profile>(i), 16, 512);
    sensors.push_back(os1(metadata));
    metadata.header_type = ouster::HeaderType::fusa;
    sensors.push_back(os1(metadata));
    metadata.window = {.first = 370, .last = 85};
    sensors.push_back(os1(metadata));
  }
  return sensors;
}

}  // namespace

/// The first byte says of which profile the packets are.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto sensors = all_profiles();
  if (size == 0) return 0;
  landfix::test::fuzz_decoder(sensors[data[0] % sensors.size()],
                              std::as_bytes(std::span(data, size).subspan(1)));
  return 0;
}
