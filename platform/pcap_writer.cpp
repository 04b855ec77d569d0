#include "platform/pcap_writer.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "platform/big_endian.hpp"
#include "platform/internet_checksum.hpp"
#include "platform/nanoseconds.hpp"

namespace landfix::platform {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
constexpr std::size_t kFileHeaderBytes = 24;
constexpr std::size_t kRecordHeaderBytes = 16;
constexpr std::size_t kEthernetHeaderBytes = 14;
constexpr std::size_t kIpv4HeaderBytes = 20;
constexpr std::size_t kUdpHeaderBytes = 8;
constexpr std::size_t kMaxPayloadBytes = 65535 - kIpv4HeaderBytes - kUdpHeaderBytes;
constexpr std::size_t kMinMtuBytes = 68;  // RFC 791

/// Big-endian like the packets within: readers tell from the magic number, here that of nanoseconds.
std::array<std::byte, kFileHeaderBytes> file_header() {
  std::array<std::byte, kFileHeaderBytes> header{};
  store_be32(header, 0, 0xA1B23C4D);
  store_be16(header, 4, 2);  // version 2.4
  store_be16(header, 6, 4);
  store_be32(header, 16, 262144);  // snapshot length: libpcap's largest
  store_be32(header, 20, 1);       // LINKTYPE_ETHERNET
  return header;
}

void fill_record_header(std::span<std::byte> header, std::size_t frame_bytes, std::int64_t stamp_utc_ns) {
  store_be32(header, 0, static_cast<std::uint32_t>(stamp_utc_ns / kNs_per_s));
  store_be32(header, 4, static_cast<std::uint32_t>(stamp_utc_ns % kNs_per_s));
  store_be32(header, 8, static_cast<std::uint32_t>(frame_bytes));
  store_be32(header, 12, static_cast<std::uint32_t>(frame_bytes));
}

/// To everybody, from a locally administered address that tells sensors apart.
void fill_ethernet_header(std::span<std::byte> header, std::uint32_t source_address) {
  std::fill_n(header.begin(), 6, std::byte{0xFF});
  store_be16(header, 6, 0x0200);
  store_be32(header, 8, source_address);
  store_be16(header, 12, 0x0800);
}

void fill_ipv4_header(std::span<std::byte> header, const UdpFlow& flow, std::size_t body_bytes,
                      std::uint16_t identification, std::uint16_t flags_and_offset) {
  store_be16(header, 0, 0x4500);
  store_be16(header, 2, static_cast<std::uint16_t>(header.size() + body_bytes));
  store_be16(header, 4, identification);
  store_be16(header, 6, flags_and_offset);
  store_be16(header, 8, static_cast<std::uint16_t>(64 << 8 | kProtocolUdp));  // time to live, protocol
  store_be32(header, 12, flow.source_address);
  store_be32(header, 16, flow.destination_address);
  InternetChecksum checksum;
  checksum.add(header);
  store_be16(header, 10, checksum.value());
}

void fill_udp_header(std::span<std::byte> datagram, const UdpFlow& flow) {
  store_be16(datagram, 0, flow.source_port);
  store_be16(datagram, 2, flow.destination_port);
  store_be16(datagram, 4, static_cast<std::uint16_t>(datagram.size()));
  store_be16(datagram, 6, 0);
  const std::uint16_t checksum = udp_checksum(flow.source_address, flow.destination_address, datagram);
  store_be16(datagram, 6, checksum == 0 ? std::uint16_t{0xFFFF} : checksum);  // 0 would say: none given
}

}  // namespace

PcapWriter::PcapWriter(std::filesystem::path path, std::size_t mtu_bytes)
    : path_(std::move(path)), file_(path_), mtu_bytes_(mtu_bytes) {
  if (mtu_bytes < kMinMtuBytes) {
    throw std::runtime_error(fmt::format("{}: an MTU of {} bytes is less than IPv4's minimum of {}",
                                         path_.string(), mtu_bytes, kMinMtuBytes));
  }
  buffer_.reserve(kBufferBytes + 2 * kMaxPayloadBytes);
  const auto header = file_header();
  buffer_.assign(header.begin(), header.end());
}

void PcapWriter::write(const UdpFlow& flow, std::span<const std::byte> payload, std::int64_t stamp_utc_ns) {
  if (payload.size() > kMaxPayloadBytes) {
    throw std::runtime_error(fmt::format("{}: a payload of {} bytes does not fit a UDP datagram (at most {})",
                                         path_.string(), payload.size(), kMaxPayloadBytes));
  }
  if (stamp_utc_ns < 0 || stamp_utc_ns / kNs_per_s > 0xFFFFFFFF) {
    throw std::runtime_error(
        fmt::format("{}: time {} ns is not within 1970 to 2106, all that a pcap file can hold",
                    path_.string(), stamp_utc_ns));
  }
  datagram_.resize(kUdpHeaderBytes + payload.size());
  std::copy(payload.begin(), payload.end(), datagram_.begin() + kUdpHeaderBytes);
  fill_udp_header(datagram_, flow);

  const std::size_t room = mtu_bytes_ - kIpv4HeaderBytes;
  const std::size_t step = datagram_.size() <= room ? room : room / 8 * 8;
  for (std::size_t offset = 0; offset < datagram_.size(); offset += step) {
    const std::size_t size = std::min(step, datagram_.size() - offset);
    append_frame(flow, std::span(datagram_).subspan(offset, size), offset, offset + size < datagram_.size(),
                 stamp_utc_ns);
  }
  ++identification_;
  if (buffer_.size() >= kBufferBytes) flush();
}

void PcapWriter::append_frame(const UdpFlow& flow, std::span<const std::byte> body, std::size_t offset,
                              bool more, std::int64_t stamp_utc_ns) {
  constexpr std::size_t kHeadersBytes = kRecordHeaderBytes + kEthernetHeaderBytes + kIpv4HeaderBytes;
  const std::size_t begin = buffer_.size();
  buffer_.resize(begin + kHeadersBytes);
  const auto headers = std::span(buffer_).subspan(begin);
  fill_record_header(headers, kEthernetHeaderBytes + kIpv4HeaderBytes + body.size(), stamp_utc_ns);
  fill_ethernet_header(headers.subspan(kRecordHeaderBytes), flow.source_address);
  fill_ipv4_header(headers.last(kIpv4HeaderBytes), flow, body.size(), identification_,
                   static_cast<std::uint16_t>(offset / 8 | (more ? 0x2000U : 0U)));
  buffer_.insert(buffer_.end(), body.begin(), body.end());
}

void PcapWriter::flush() {
  file_.write(buffer_);
  buffer_.clear();
}

void PcapWriter::commit() {
  flush();
  file_.commit();
}

}  // namespace landfix::platform
