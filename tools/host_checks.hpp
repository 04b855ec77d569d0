// Whether a host is fit for real time: what its /proc and /sys say, one row a question, with the mend.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace landfix::tools {

enum class Verdict : std::uint8_t {
  pass,
  warn,
  unknown,  ///< the host does not say: a container, a virtual machine, another kernel
};
/// "PASS", "WARN", "?"
[[nodiscard]] const char* to_string(Verdict verdict) noexcept;

struct HostCheck {
  std::string name;
  Verdict verdict{};
  std::string found;
  std::string mend{};  ///< empty unless warned
};

/// What of the host matters depends on the configuration.
struct HostNeeds {
  std::vector<int> cores{};         ///< to which real-time threads are bound
  std::uint64_t receive_bytes = 0;  ///< buffer of the sensor's socket
  std::string can_interface{};      ///< empty: none
  std::string sensor_interface{};   ///< Ethernet, to the sensor; empty: not known
};

/// Reads below `root`, "/" for this host. Throws nothing for files that are missing or say nothing of use.
[[nodiscard]] std::vector<HostCheck> check_host(const std::filesystem::path& root, const HostNeeds& needs);

}  // namespace landfix::tools
