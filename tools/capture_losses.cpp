#include "tools/capture_losses.hpp"

#include <array>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

namespace landfix::tools {

std::string describe_losses(const platform::CaptureCounters& counters) {
  struct Loss {
    std::uint64_t count;
    std::string_view what;
  };
  const std::array losses{
      Loss{counters.malformed, "malformed frames"},
      Loss{counters.cut_short, "frames cut short by the capture's snapshot length"},
      Loss{counters.fragments_dropped, "fragments of incomplete datagrams"},
  };
  std::string text;
  for (const Loss& loss : losses) {
    if (loss.count == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", loss.count, loss.what);
  }
  return text;
}

void warn_of_losses(const std::string& pcap, const platform::CaptureCounters& counters) {
  const std::string losses = describe_losses(counters);
  if (!losses.empty()) fmt::print(stderr, "{}: left out: {}\n", pcap, losses);
}

}  // namespace landfix::tools
