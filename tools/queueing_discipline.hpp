// By which rule the kernel queues what an interface is to send.
#pragma once

#include <optional>
#include <string>

namespace landfix::tools {

/// Such as "pfifo_fast", "fq_codel", "noqueue"; nothing where there is no such interface or the kernel does
/// not say.
[[nodiscard]] std::optional<std::string> queueing_discipline(const std::string& interface);

}  // namespace landfix::tools
