// What a client of the metrics sends; the path lies within it.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "platform/http_request.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace landfix::platform;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const HttpRequest request = parse_http_request(bytes);
  if (request.verdict == HttpVerdict::get && bytes.find(request.path) == std::string_view::npos) std::abort();
  return 0;
}
