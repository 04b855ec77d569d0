#include "platform/http_request.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace landfix::platform {
namespace {

[[nodiscard]] std::string_view reason_of(int code) {
  constexpr std::array<std::pair<int, std::string_view>, 6> kReasons{
      {{200, "OK"},
       {400, "Bad Request"},
       {404, "Not Found"},
       {405, "Method Not Allowed"},
       {431, "Request Header Fields Too Large"},
       {503, "Service Unavailable"}}};
  for (const auto& [known, reason] : kReasons) {
    if (known == code) return reason;
  }
  return "Error";
}

[[nodiscard]] std::string_view take_to_space(std::string_view& line) {
  const std::size_t length = std::min(line.find(' '), line.size());
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(std::min(length + 1, line.size()));
  return word;
}

[[nodiscard]] bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char character) { return character > ' ' && character < 0x7F; });
}

}  // namespace

HttpRequest parse_http_request(std::string_view bytes) {
  const std::size_t end_of_line = bytes.find('\n');
  const bool has_ended =
      bytes.find("\r\n\r\n") != std::string_view::npos || bytes.find("\n\n") != std::string_view::npos;
  if (!has_ended) {
    return {bytes.size() >= kMaxHttpRequest_bytes ? HttpVerdict::too_long : HttpVerdict::incomplete, {}};
  }
  std::string_view line = bytes.substr(0, end_of_line);
  if (line.ends_with('\r')) line.remove_suffix(1);
  const std::string_view method = take_to_space(line);
  const std::string_view target = take_to_space(line);
  if (!line.starts_with("HTTP/1.") || !target.starts_with('/') || !is_printable(target) || method.empty()) {
    return {HttpVerdict::malformed, {}};
  }
  const std::string_view path = target.substr(0, target.find('?'));
  if (method == "GET") return {HttpVerdict::get, path};
  return {method == "HEAD" ? HttpVerdict::head : HttpVerdict::other_method, path};
}

std::string http_response(int code, std::string_view content_type, std::string_view body, bool with_body) {
  std::string response = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n{}\r\n", code,
      reason_of(code), content_type, body.size(), code == 405 ? "Allow: GET, HEAD\r\n" : "");
  if (with_body) response += body;
  return response;
}

}  // namespace landfix::platform
