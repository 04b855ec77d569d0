// CAN frames of anybody, many of them with their protection made right: nothing but a frame that is sound,
// new and of its pose gives a pose, and what is read can be sent again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "platform/pose_frame_decoder.hpp"
#include "platform/pose_frames.hpp"

namespace {

using namespace landfix::platform;

constexpr std::uint32_t kBaseId = 0x3A0;

/// Takes one frame off the input: how it is made, its identifier's offset, its counter, and its data.
CanFrame take_frame(std::span<const std::uint8_t>& input) {
  const unsigned how = input[0];
  const unsigned which = input[1];
  const std::uint8_t counter = input[2];
  input = input.subspan(3);
  CanFrame frame{.id = kBaseId + which % 16, .extended = (how & 1U) != 0, .fd = (how & 2U) != 0};
  const bool is_sound = (how & 4U) != 0;
  const FrameLayout& layout = kFrameLayouts[which % kFrameLayouts.size()];
  if (is_sound) {
    frame = {.id = kBaseId + layout.id_offset, .fd = layout.fd, .length = layout.length()};
  } else {
    frame.length = counter;
  }
  const std::size_t size = std::min<std::size_t>(input.size(), frame.payload().size());
  std::transform(input.begin(), input.begin() + static_cast<std::ptrdiff_t>(size), frame.data.begin(),
                 [](std::uint8_t byte) { return std::byte{byte}; });
  input = input.subspan(size);
  if (is_sound) {
    e2e_protect(layout.profile(), std::span(frame.data).first(layout.length()), layout.data_id(),
                static_cast<std::uint8_t>(counter % e2e_counter_end(layout.profile())));
  }
  return frame;
}

void send_again(const FrameLayout& layout, const CanFrame& frame) {
  PoseReport report;
  decode_frame(layout, frame.payload(), report);
  for (const Signal& signal : layout.signals) {
    const std::uint64_t raw = get_bits(frame.payload(), signal.bits);
    const RawValue again = encode_signal(signal, report);
    const bool is_lost_time = report.stamp_utc_ns == PoseReport::kNoTime &&
                              std::holds_alternative<std::int64_t PoseReport::*>(signal.field);
    if (again.saturated || (again.raw != raw && !is_lost_time)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  PoseFrameDecoder decoder(kBaseId);
  std::span<const std::uint8_t> input(data, size);
  std::size_t poses = 0;
  std::size_t accepted = 0;
  for (std::int64_t stamp_utc_ns = 0; input.size() >= 3; stamp_utc_ns += 1'000'000) {
    const CanFrame frame = take_frame(input);
    const DecodedFrame decoded = decoder.decode(frame, stamp_utc_ns);
    if (decoded.layout == nullptr && decoded.pose) std::abort();
    if (decoded.layout == nullptr || !is_accepted(decoded.check.status)) {
      if (decoded.pose) std::abort();
      continue;
    }
    if (frame.extended || frame.fd != decoded.layout->fd || frame.length != decoded.layout->length())
      std::abort();
    ++accepted;
    if (decoded.pose) ++poses;
    send_again(*decoded.layout, frame);
  }
  if (poses > accepted || decoder.frames_missing() >= kClassicPoseFrames) std::abort();
  return 0;
}
