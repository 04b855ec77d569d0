#include "fuzz/fuzz_decoder.hpp"
#include "support/ouster_packets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace ouster = landfix::drivers::ouster;
  auto input = std::as_bytes(std::span(data, size));
  if (input.empty()) return 0;
  // The first byte chooses the profile, the header and whether there is a window.
  const auto choice = std::to_integer<std::size_t>(input[0]);
  input = input.subspan(1);
  const auto profile = static_cast<ouster::Profile>(choice % ouster::kProfiles.size());
  ouster::Metadata metadata = landfix::test::ouster_metadata(profile, 16, 512);
  if (choice >= 128) metadata.header_type = ouster::HeaderType::fusa;
  if (choice >= 192) metadata.window = {.first = 370, .last = 85};
  landfix::test::OusterPacket sound(metadata);
  sound.set_place(2, 1'700'000'000'000'000'000);
  for (std::size_t row = 0; row < 16; ++row) sound.set_return(3, row, 1000);
  for (const auto& model : landfix::drivers::sensor_models()) {
    static_cast<void>(landfix::drivers::looks_like(model, input));
  }
  landfix::test::fuzz_decoder("os1-16", sound.bytes(), input, metadata);
  return 0;
}
