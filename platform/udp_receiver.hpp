// The packets of a sensor from the network: a socket for each of its ports, read straight into the ring.
//
// Where the sensor's address is known, each port has two sockets. The kernel shows every datagram to a filter
// of its source: the sensor's go to the first, all others to a small second one, where they are counted. So a
// flood from elsewhere never takes the sensor's room. (To connect the first one instead, the port from which
// the sensor sends would have to be known.)
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <poll.h>

#include "platform/arrival_clock.hpp"
#include "platform/file_descriptor.hpp"
#include "platform/packet_receiver.hpp"
#include "platform/udp_batch.hpp"
#include "platform/udp_settings.hpp"

namespace landfix::platform {

/// A socket, and what it has lost.
struct CountedSocket {
  FileDescriptor socket;
  std::uint64_t drops = 0;       ///< full or filtered, as of the last datagram that was read
  std::uint64_t broadcasts = 0;  ///< datagrams read that went to every socket of the port
  std::uint64_t overflowed = 0;  ///< drops that are known to be for want of room

  /// After everything that waited in `other`, the socket of the same port with the contrary filter, was read:
  /// a broadcast that the one has refused the other has received. Returns how many more have overflowed.
  [[nodiscard]] std::uint64_t settle(const CountedSocket& other) noexcept;
};

class UdpReceiver final : public PacketReceiver {
 public:
  /// Throws std::runtime_error that says what to do where a socket cannot be had.
  explicit UdpReceiver(const UdpSettings& settings);
  ~UdpReceiver() override;  // the first virtual one: where it is defined the compiler puts what deletes
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  [[nodiscard]] ReceiveStatus receive(PacketRing& ring, std::int64_t deadline_mono_ns) noexcept override;
  [[nodiscard]] const ReceiveCounters& counters() const noexcept override { return counters_; }

  /// What works less well than was asked for, each a sentence that says how to mend it.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }
  /// The i-th of the settings' ports.
  [[nodiscard]] std::uint16_t port(std::size_t i) const noexcept { return ports_[i].number; }

 private:
  struct Port {
    std::uint16_t number = 0;
    CountedSocket sensor;
    CountedSocket strangers;  ///< not open where the sensor's address is not known
    ArrivalClock clock;
  };
  /// How a read from a socket went.
  struct Read {
    std::size_t count = 0;
    bool is_dry = true;
    bool has_failed = false;
  };

  void wait(std::int64_t deadline_mono_ns) noexcept;
  [[nodiscard]] std::size_t receive(Port& port, PacketRing& ring, bool& has_failed) noexcept;
  [[nodiscard]] Read read(CountedSocket& from, std::size_t count) noexcept;
  [[nodiscard]] std::size_t keep(Port& port, PacketRing& ring, const Read& read) noexcept;
  static void note(CountedSocket& of, const Datagram& datagram) noexcept;
  void drop_all(CountedSocket& of, const Read& read, RelaxedCounter& counter) noexcept;
  void join_if_silent() noexcept;

  std::uint32_t multicast_group_;
  std::uint32_t interface_address_;
  std::vector<Port> ports_;
  std::vector<std::string> warnings_;
  std::vector<pollfd> watched_;           ///< the sensor's sockets
  std::int64_t heard_or_joined_mono_ns_;  ///< the last sign of the sensor, or attempt to get one
  UdpBatch batch_;
  std::array<std::byte, 1> nowhere_{};
  alignas(64) ReceiveCounters counters_;  // which others read
};

}  // namespace landfix::platform
