#include "platform/udp_receiver.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include <poll.h>

#include "platform/monotonic_clock.hpp"
#include "platform/multicast.hpp"
#include "platform/nanoseconds.hpp"
#include "platform/utc_clock.hpp"

namespace landfix::platform {
namespace {

/// What a socket tells once and then goes on, such as that its interface was down.
[[nodiscard]] bool passes(int error) noexcept {
  return error == EAGAIN || error == EINTR || error == ECONNREFUSED || error == ENETDOWN ||
         error == ENETUNREACH || error == EHOSTUNREACH;
}

}  // namespace

std::uint64_t CountedSocket::settle(const CountedSocket& other) noexcept {
  const std::uint64_t known = drops > other.broadcasts ? drops - other.broadcasts : 0;
  if (known <= overflowed) return 0;
  const std::uint64_t more = known - overflowed;
  overflowed = known;
  return more;
}

ReceiveStatus UdpReceiver::receive(PacketRing& ring, std::int64_t deadline_mono_ns) noexcept {
  wait(deadline_mono_ns);
  std::size_t kept = 0;
  bool has_failed = false;
  for (Port& port : ports_) kept += receive(port, ring, has_failed);
  if (multicast_group_ != 0) join_if_silent();
  if (kept != 0) return ReceiveStatus::packets;
  return has_failed ? ReceiveStatus::failed : ReceiveStatus::nothing;
}

/// Strangers do not wake it: they are looked at when the sensor has, or at the deadline.
void UdpReceiver::wait(std::int64_t deadline_mono_ns) noexcept {
  const std::int64_t left_ns = std::max<std::int64_t>(deadline_mono_ns - monotonic_ns(), 0);
  const timespec left{.tv_sec = left_ns / kNs_per_s, .tv_nsec = left_ns % kNs_per_s};
  ::ppoll(watched_.data(), watched_.size(), &left, nullptr);
}

/// How many came into the ring.
std::size_t UdpReceiver::receive(Port& port, PacketRing& ring, bool& has_failed) noexcept {
  const std::size_t room = std::min(ring.free_slots(UdpBatch::kMost), UdpBatch::kMost);
  for (std::size_t i = 0; i < UdpBatch::kMost; ++i) batch_.point(i, i < room ? ring.room(i) : nowhere_);
  const Read sensors = read(port.sensor, room == 0 ? UdpBatch::kMost : room);
  has_failed |= sensors.has_failed;
  std::size_t kept = 0;
  if (room == 0)
    drop_all(port.sensor, sensors, counters_.dropped_ring_full);
  else
    kept = keep(port, ring, sensors);

  if (sensors.is_dry) counters_.strangers += port.strangers.settle(port.sensor);
  if (port.strangers.socket.is_open()) {
    for (std::size_t i = 0; i < UdpBatch::kMost; ++i) batch_.point(i, nowhere_);
    const Read strangers = read(port.strangers, UdpBatch::kMost);
    drop_all(port.strangers, strangers, counters_.strangers);
    if (!strangers.is_dry) return kept;
  }
  counters_.dropped_by_kernel += port.sensor.settle(port.strangers);
  return kept;
}

UdpReceiver::Read UdpReceiver::read(CountedSocket& from, std::size_t count) noexcept {
  const int received = batch_.receive(from.socket.number(), count);
  if (received < 0) {
    if (errno == EAGAIN) return {};
    ++counters_.errors;
    return {.has_failed = !passes(errno)};
  }
  const auto taken = static_cast<std::size_t>(received);
  return {.count = taken, .is_dry = taken < count};
}

/// Each datagram lies in its slot; those behind one that is not kept move up.
std::size_t UdpReceiver::keep(Port& port, PacketRing& ring, const Read& read) noexcept {
  if (read.count == 0) return 0;
  const std::int64_t taken_mono_ns = monotonic_ns();
  port.clock.set(utc_ns(), taken_mono_ns, read.is_dry);
  heard_or_joined_mono_ns_ = taken_mono_ns;
  std::size_t kept = 0;
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < read.count; ++i) {
    const Datagram datagram = batch_.datagram(i);
    note(port.sensor, datagram);
    if (datagram.is_truncated) {
      ++counters_.truncated;
      continue;
    }
    if (kept != i) std::memcpy(ring.room(kept).data(), ring.room(i).data(), datagram.size);
    ring.header_to_fill(kept++) = {
        .receive_utc_ns = datagram.stamp_utc_ns,
        .arrived_mono_ns = port.clock.arrived_mono_ns(datagram.stamp_utc_ns),
        .taken_mono_ns = taken_mono_ns,
        .source_address = datagram.source_address,
        .source_port = datagram.source_port,
        .destination_port = port.number,
        .size = static_cast<std::uint32_t>(datagram.size),
    };
    bytes += datagram.size;
  }
  ring.publish(kept);
  counters_.packets += kept;
  counters_.bytes += bytes;
  return kept;
}

void UdpReceiver::drop_all(CountedSocket& of, const Read& read, RelaxedCounter& counter) noexcept {
  for (std::size_t i = 0; i < read.count; ++i) note(of, batch_.datagram(i));
  counter += read.count;
}

void UdpReceiver::note(CountedSocket& of, const Datagram& datagram) noexcept {
  if (datagram.is_broadcast) ++of.broadcasts;
  // The kernel's counter is 32 bits and runs around; it rides on the first datagram that found room again.
  if (datagram.kernel_drops != 0) of.drops += datagram.kernel_drops - static_cast<std::uint32_t>(of.drops);
}

/// An interface that was taken away and came back has forgotten who listens.
void UdpReceiver::join_if_silent() noexcept {
  constexpr std::int64_t kSilence_ns = kNs_per_s;
  const std::int64_t now_mono_ns = monotonic_ns();
  if (now_mono_ns - heard_or_joined_mono_ns_ < kSilence_ns) return;
  heard_or_joined_mono_ns_ = now_mono_ns;
  for (const Port& port : ports_) {
    if (!join_group(port.sensor.socket.number(), multicast_group_, interface_address_)) ++counters_.errors;
  }
}

}  // namespace landfix::platform
