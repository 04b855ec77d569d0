// IPv4 addresses as text: 192.168.1.201 is 0xC0A801C9 (host byte order).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <arpa/inet.h>

namespace landfix::platform {

[[nodiscard]] inline std::optional<std::uint32_t> parse_ipv4(std::string_view text) {
  in_addr address{};
  const bool is_address = text.find('\0') == std::string_view::npos &&
                          ::inet_pton(AF_INET, std::string(text).c_str(), &address) == 1;
  return is_address ? std::optional(ntohl(address.s_addr)) : std::nullopt;
}

/// 224.0.0.0 to 239.255.255.255
[[nodiscard]] constexpr bool is_multicast(std::uint32_t address) noexcept { return address >> 28U == 0xE; }

[[nodiscard]] inline std::string to_ipv4_text(std::uint32_t address) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    text += std::to_string(address >> static_cast<unsigned>(shift) & 0xFFU);
    if (shift != 0) text += '.';
  }
  return text;
}

}  // namespace landfix::platform
