// What a capture has lost before it is read: frames that its recording or its network damaged.
#pragma once

#include <string>

#include "platform/udp_extractor.hpp"

namespace landfix::tools {

/// "2 frames cut short by the capture's snapshot length, 5 fragments of incomplete datagrams"; empty where
/// nothing is lost.
[[nodiscard]] std::string describe_losses(const platform::CaptureCounters& counters);

/// Warns of them, in a line on stderr, where there are any.
void warn_of_losses(const std::string& pcap, const platform::CaptureCounters& counters);

}  // namespace landfix::tools
