#include "tools/capture_losses.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace landfix::tools {

std::string describe_losses(const platform::CaptureCounters& counters) {
  std::vector<std::string> losses;
  const auto list = [&losses](std::uint64_t count, std::string_view what) {
    if (count != 0) losses.push_back(fmt::format("{} {}", count, what));
  };
  list(counters.malformed, "malformed frames");
  list(counters.cut_short, "frames cut short by the capture's snapshot length");
  list(counters.fragments_dropped, "fragments of incomplete datagrams");
  return fmt::format("{}", fmt::join(losses, ", "));
}

void warn_of_losses(const std::string& pcap, const platform::CaptureCounters& counters) {
  const std::string losses = describe_losses(counters);
  if (!losses.empty()) fmt::print(stderr, "{}: left out: {}\n", pcap, losses);
}

}  // namespace landfix::tools
