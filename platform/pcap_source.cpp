#include "platform/pcap_source.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <pcap/pcap.h>

#include "platform/nanoseconds.hpp"

namespace landfix::platform {
namespace {

struct LinkTypeName {
  int pcap_type;
  LinkType link;
};

constexpr std::array kLinkTypes{
    LinkTypeName{DLT_EN10MB, LinkType::ethernet},
    LinkTypeName{DLT_LINUX_SLL, LinkType::linux_cooked},
    LinkTypeName{DLT_LINUX_SLL2, LinkType::linux_cooked2},
    LinkTypeName{DLT_RAW, LinkType::raw_ip},
    LinkTypeName{DLT_IPV4, LinkType::raw_ip},
    LinkTypeName{DLT_IPV6, LinkType::raw_ip},
    LinkTypeName{DLT_NULL, LinkType::loopback},
    LinkTypeName{DLT_LOOP, LinkType::loopback},
};

LinkType link_type(const std::filesystem::path& path, int pcap_type) {
  for (const LinkTypeName& row : kLinkTypes) {
    if (row.pcap_type == pcap_type) return row.link;
  }
  const char* const name = pcap_datalink_val_to_name(pcap_type);
  throw std::runtime_error(
      fmt::format("{}: link type {} ({}) is not read; capture on an Ethernet interface or on \"any\"",
                  path.string(), pcap_type, name == nullptr ? "unknown" : name));
}

/// Nothing where a damaged time stamp does not fit.
std::optional<std::int64_t> stamp_utc_ns(const pcap_pkthdr& header) noexcept {
  constexpr std::int64_t kMaxSeconds = std::numeric_limits<std::int64_t>::max() / kNs_per_s - 1;
  const std::int64_t seconds = header.ts.tv_sec;
  const std::int64_t nanoseconds = header.ts.tv_usec;  // so named, but opened with nanosecond precision
  if (seconds < 0 || seconds > kMaxSeconds || nanoseconds < 0 || nanoseconds >= kNs_per_s)
    return std::nullopt;
  return seconds * kNs_per_s + nanoseconds;
}

/// Whose records do not depend on what came before them, as those of pcapng do. False for what is no regular
/// file, which can be read but once.
bool is_classic_pcap(const std::filesystem::path& path) {
  constexpr std::array<unsigned char, 4> kPcapng{0x0A, 0x0D, 0x0D, 0x0A};
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return false;
  std::array<unsigned char, 4> magic{};
  std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(magic.data()), magic.size());
  return magic != kPcapng;
}

}  // namespace

void PcapSource::Close::operator()(pcap* handle) const noexcept { pcap_close(handle); }

PcapSource::PcapSource(std::filesystem::path path) : path_(std::move(path)) { rewind(); }

void PcapSource::rewind() {
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  capture_.reset(
      pcap_open_offline_with_tstamp_precision(path_.c_str(), PCAP_TSTAMP_PRECISION_NANO, error.data()));
  if (!capture_) {
    throw std::runtime_error(
        fmt::format("{}: cannot read it as a capture: {}; pcap and pcapng files are read, uncompressed",
                    path_.string(), error.data()));
  }
  link_ = link_type(path_, pcap_datalink(capture_.get()));
  extractor_ = std::make_unique_for_overwrite<UdpExtractor>();  // a MiB that need not be zero
  read_error_ = "";
  std::error_code no_size;
  const auto size = std::filesystem::file_size(path_, no_size);
  total_bytes_ = no_size ? 0 : size;
  first_record_ = is_classic_pcap(path_) ? ::ftello(pcap_file(capture_.get())) : -1;
}

bool PcapSource::restart() noexcept {
  if (first_record_ >= 0) {
    if (::fseeko(pcap_file(capture_.get()), first_record_, SEEK_SET) != 0) return false;
    extractor_->reset();
    read_error_ = "";
    return true;
  }
  try {
    rewind();
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

ReadStatus PcapSource::next(UdpPacket& packet) noexcept {
  if (*read_error_ != '\0') return ReadStatus::truncated;  // what follows would be read from the wrong place
  pcap_pkthdr* header = nullptr;
  const unsigned char* data = nullptr;
  int status = 0;
  while ((status = pcap_next_ex(capture_.get(), &header, &data)) == 1) {
    const std::optional<std::int64_t> stamp = stamp_utc_ns(*header);
    if (!stamp) {
      extractor_->count_malformed();
      continue;
    }
    const auto captured = std::as_bytes(std::span(data, header->caplen));
    const std::optional<UdpDatagram> udp = extractor_->extract(link_, captured, header->len, *stamp);
    if (!udp) continue;
    packet = {.payload = udp->payload,
              .receive_utc_ns = *stamp,
              .source_address = udp->source_address,
              .source_port = udp->source_port,
              .destination_port = udp->destination_port};
    return ReadStatus::packet;
  }
  extractor_->finish();
  if (status == PCAP_ERROR_BREAK) return ReadStatus::end;
  read_error_ = pcap_geterr(capture_.get());
  return ReadStatus::truncated;
}

double PcapSource::percent_read() const noexcept {
  const auto position = ::ftello(pcap_file(capture_.get()));
  if (position < 0 || total_bytes_ == 0) return 0.0;
  return std::min(100.0, 100.0 * static_cast<double>(position) / static_cast<double>(total_bytes_));
}

}  // namespace landfix::platform
