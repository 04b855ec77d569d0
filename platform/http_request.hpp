// As much of HTTP/1 as answering "GET /metrics" takes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace landfix::platform {

inline constexpr std::size_t kMaxHttpRequest_bytes = 8192;

enum class HttpVerdict : std::uint8_t {
  incomplete,    ///< its header has not ended yet
  get,           ///< `path` is asked for
  head,          ///< likewise, without the body
  other_method,  ///< 405
  malformed,     ///< 400
  too_long,      ///< 431
};

struct HttpRequest {
  HttpVerdict verdict = HttpVerdict::incomplete;
  std::string_view path;  ///< without a query
};

/// `bytes`: all that has come of a request, which must outlive the answer.
[[nodiscard]] HttpRequest parse_http_request(std::string_view bytes);

/// The whole answer, after which the connection is closed.
[[nodiscard]] std::string http_response(int code, std::string_view content_type, std::string_view body,
                                        bool with_body = true);

}  // namespace landfix::platform
