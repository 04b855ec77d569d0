#include "platform/ip_reassembly.hpp"

#include <algorithm>

#include "platform/big_endian.hpp"
#include "platform/internet_checksum.hpp"

namespace landfix::platform {
namespace {

// A sensor sends the fragments of a datagram back to back, and its 16-bit identification comes round again
// within half a minute: hosts wait as long as that, which would mix two datagrams.
constexpr std::int64_t kTimeout_ns = 1'000'000'000;

// Of the IPv4 payload: the total length with the shortest header is at most 65,535.
constexpr std::size_t kMaxDatagramBytes = 65535 - 20;

/// A capture's clock may step either way.
bool is_stale(std::int64_t first_utc_ns, std::int64_t now_utc_ns) noexcept {
  return now_utc_ns < first_utc_ns || now_utc_ns - first_utc_ns > kTimeout_ns;
}

}  // namespace

std::optional<UdpDatagram> IpReassembly::add(const IpFragment& fragment, std::int64_t stamp_utc_ns) noexcept {
  ++counters_.fragments;
  for (Slot& slot : slots_) {
    if (slot.used && is_stale(slot.first_utc_ns, stamp_utc_ns)) give_up(slot);
  }
  if (fragment.bytes.empty() || fragment.offset + fragment.bytes.size() > kMaxDatagramBytes) {
    ++counters_.dropped;
    return std::nullopt;
  }
  Slot& slot = find(fragment, stamp_utc_ns);
  Insertion insertion = insert(slot, fragment);
  if (insertion == Insertion::contradiction) {
    // Another datagram with the same identification: the older one will not be completed.
    give_up(slot);
    begin(slot, fragment, stamp_utc_ns);
    insertion = insert(slot, fragment);
  }
  if (insertion == Insertion::duplicate) {
    ++counters_.duplicates;
    return std::nullopt;
  }
  ++slot.fragments;
  const std::size_t all_units = (slot.total_bytes + kUnitBytes - 1) / kUnitBytes;
  return slot.total_bytes != 0 && slot.units == all_units ? finish(slot) : std::nullopt;
}

void IpReassembly::clear() noexcept {
  for (Slot& slot : slots_) {
    if (slot.used) give_up(slot);
  }
}

/// The datagram's slot; or a new one, in place of the oldest if none is free.
IpReassembly::Slot& IpReassembly::find(const IpFragment& fragment, std::int64_t stamp_utc_ns) noexcept {
  Slot* replaceable = &slots_.front();
  for (Slot& slot : slots_) {
    if (slot.used && slot.identification == fragment.identification &&
        slot.source_address == fragment.source_address &&
        slot.destination_address == fragment.destination_address) {
      return slot;
    }
    const bool better = !slot.used || slot.first_utc_ns < replaceable->first_utc_ns;
    if (replaceable->used && better) replaceable = &slot;
  }
  if (replaceable->used) give_up(*replaceable);
  begin(*replaceable, fragment, stamp_utc_ns);
  return *replaceable;
}

/// Bytes that have come before must be the same when they come again.
IpReassembly::Insertion IpReassembly::insert(Slot& slot, const IpFragment& fragment) noexcept {
  const std::size_t end = fragment.offset + fragment.bytes.size();
  const bool ends_elsewhere = !fragment.more && slot.total_bytes != 0 && slot.total_bytes != end;
  const bool beyond_end = slot.total_bytes != 0 && end > slot.total_bytes;
  const bool ends_too_early = !fragment.more && end < slot.end_bytes;
  if (ends_elsewhere || beyond_end || ends_too_early) return Insertion::contradiction;

  for (std::size_t at = 0; at < fragment.bytes.size(); at += kUnitBytes) {
    if (!slot.has_unit[(fragment.offset + at) / kUnitBytes]) continue;
    const auto unit = fragment.bytes.subspan(at, std::min(kUnitBytes, fragment.bytes.size() - at));
    if (!std::equal(unit.begin(), unit.end(), slot.bytes.data() + fragment.offset + at)) {
      return Insertion::contradiction;
    }
  }
  const bool tells_end = !fragment.more && slot.total_bytes == 0;
  const std::size_t units_before = slot.units;
  for (std::size_t at = 0; at < fragment.bytes.size(); at += kUnitBytes) {
    auto has_unit = slot.has_unit[(fragment.offset + at) / kUnitBytes];
    if (has_unit) continue;
    has_unit = true;
    ++slot.units;
    const auto unit = fragment.bytes.subspan(at, std::min(kUnitBytes, fragment.bytes.size() - at));
    std::copy(unit.begin(), unit.end(), slot.bytes.data() + fragment.offset + at);
  }
  slot.end_bytes = std::max(slot.end_bytes, end);
  if (tells_end) slot.total_bytes = end;
  return tells_end || slot.units != units_before ? Insertion::added : Insertion::duplicate;
}

std::optional<UdpDatagram> IpReassembly::finish(Slot& slot) noexcept {
  const std::span<const std::byte> bytes(slot.bytes.data(), slot.total_bytes);
  const std::optional<UdpDatagram> udp = parse_udp(bytes, slot.source_address);
  // Length and checksum tell where fragments of two datagrams were mixed; a checksum of 0 was not computed.
  const bool intact =
      udp && load_be16(bytes, 4) == bytes.size() &&
      (load_be16(bytes, 6) == 0 || udp_checksum(slot.source_address, slot.destination_address, bytes) == 0);
  if (!intact) {
    give_up(slot);
    return std::nullopt;
  }
  slot.used = false;
  ++counters_.reassembled;
  return udp;
}

void IpReassembly::begin(Slot& slot, const IpFragment& fragment, std::int64_t stamp_utc_ns) noexcept {
  slot.used = true;
  slot.source_address = fragment.source_address;
  slot.destination_address = fragment.destination_address;
  slot.identification = fragment.identification;
  slot.first_utc_ns = stamp_utc_ns;
  slot.fragments = 0;
  slot.total_bytes = 0;
  slot.end_bytes = 0;
  slot.units = 0;
  slot.has_unit.reset();
}

void IpReassembly::give_up(Slot& slot) noexcept {
  counters_.dropped += slot.fragments;
  slot.used = false;
}

}  // namespace landfix::platform
