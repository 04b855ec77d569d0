// What the receiving thread runs: packets from sockets or a capture into the ring, a batch a call.
#pragma once

#include <cstdint>

#include "platform/packet_ring.hpp"
#include "platform/relaxed_counter.hpp"

namespace landfix::platform {

enum class ReceiveStatus : std::uint8_t {
  packets,    ///< at least one is in the ring
  nothing,    ///< none came in time, or none that is kept
  end,        ///< there will be no more
  truncated,  ///< like `end`, but the capture ends in the middle of a record
  failed,     ///< the system refuses for a reason that may pass; calling again at once would find the same
};

/// Every packet that arrives is counted once, but that of `dropped_by_kernel` nothing more is known.
struct ReceiveCounters {
  RelaxedCounter packets;  ///< put into the ring
  RelaxedCounter bytes;    ///< of payload, of these
  RelaxedCounter dropped_ring_full;
  RelaxedCounter dropped_by_kernel;  ///< its buffer was full: the receiving thread came too late
  RelaxedCounter truncated;          ///< larger than a slot of the ring
  RelaxedCounter strangers;          ///< from another address than the sensor's
  RelaxedCounter other_ports;        ///< of a capture; a socket hears only its own
  RelaxedCounter errors;             ///< calls that the system refused
};

/// The one virtual seam of the receiving thread, which alone calls it; its counters may be read by any.
class PacketReceiver {
 public:
  PacketReceiver() = default;
  PacketReceiver(const PacketReceiver&) = delete;
  PacketReceiver& operator=(const PacketReceiver&) = delete;
  virtual ~PacketReceiver() = default;

  /// Fills free slots of the ring with what has come; if nothing has, waits until `deadline_mono_ns` at the
  /// longest.
  [[nodiscard]] virtual ReceiveStatus receive(PacketRing& ring, std::int64_t deadline_mono_ns) noexcept = 0;
  [[nodiscard]] virtual const ReceiveCounters& counters() const noexcept = 0;
};

}  // namespace landfix::platform
