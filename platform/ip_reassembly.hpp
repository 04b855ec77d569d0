// Puts together UDP datagrams that IPv4 split (an Ouster packet of 12,608 or 33,024 bytes is 9 or 23
// fragments), in fixed memory: sixteen datagrams may be under way at a time.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "platform/udp_frame.hpp"

namespace landfix::platform {

/// Fragments end as part of a reassembled datagram, as duplicates, as dropped, or are still waiting.
struct ReassemblyCounters {
  std::uint64_t fragments = 0;
  std::uint64_t reassembled = 0;  ///< datagrams
  std::uint64_t duplicates = 0;   ///< fragments that brought nothing new
  std::uint64_t dropped = 0;      ///< fragments of datagrams that were given up
};

/// More than 1 MiB: keep it on the heap, or static.
class IpReassembly {
 public:
  /// The whole datagram, UDP header included, valid until the next call; or nothing yet.
  [[nodiscard]] std::optional<UdpDatagram> add(const IpFragment& fragment,
                                               std::int64_t stamp_utc_ns) noexcept;

  /// Gives up what is still incomplete.
  void clear() noexcept;
  /// As new.
  void reset() noexcept {
    clear();
    counters_ = {};
  }

  [[nodiscard]] const ReassemblyCounters& counters() const noexcept { return counters_; }

 private:
  static constexpr std::size_t kSlots = 16;
  static constexpr std::size_t kUnitBytes = 8;  // offsets of fragments count in these
  static constexpr std::size_t kMaxBytes = 65536;

  struct Slot {
    bool used = false;
    std::uint32_t source_address = 0;
    std::uint32_t destination_address = 0;
    std::uint16_t identification = 0;
    std::int64_t first_utc_ns = 0;
    std::uint64_t fragments = 0;
    std::size_t total_bytes = 0;  // 0 until the last fragment has come
    std::size_t end_bytes = 0;    // of what has come
    std::size_t units = 0;
    std::bitset<kMaxBytes / kUnitBytes> has_unit;
    std::array<std::byte, kMaxBytes> bytes;
  };
  enum class Insertion : std::uint8_t { added, duplicate, contradiction };

  [[nodiscard]] Slot& find(const IpFragment& fragment, std::int64_t stamp_utc_ns) noexcept;
  [[nodiscard]] static Insertion insert(Slot& slot, const IpFragment& fragment) noexcept;
  [[nodiscard]] std::optional<UdpDatagram> finish(Slot& slot) noexcept;
  static void begin(Slot& slot, const IpFragment& fragment, std::int64_t stamp_utc_ns) noexcept;
  void give_up(Slot& slot) noexcept;

  std::array<Slot, kSlots> slots_;
  ReassemblyCounters counters_;
};

}  // namespace landfix::platform
