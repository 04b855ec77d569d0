#include "tools/metrics_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "platform/http_request.hpp"
#include "platform/monotonic_clock.hpp"
#include "platform/sleep_until.hpp"
#include "tools/metrics_socket.hpp"
#include "tools/metrics_text.hpp"
#include "tools/status_json.hpp"

namespace landfix::tools {
namespace {

using platform::HttpVerdict;

constexpr std::int64_t kMs = 1'000'000;
/// A request on this computer comes at once, and whoever is waiting behind it should not wait long.
constexpr std::int64_t kRequestTime_ns = 250 * kMs;
constexpr std::int64_t kResponseTime_ns = 1000 * kMs;

constexpr std::string_view kText = "text/plain; charset=utf-8";
constexpr std::string_view kHelp =
    "landfixd\n\n/metrics      for Prometheus\n/status.json  all of it as JSON, as `landfix top` reads it\n";

/// Whether it is so before the deadline.
[[nodiscard]] bool wait_for(int socket, short events, std::int64_t deadline_mono_ns) {
  const std::int64_t left_ms = (deadline_mono_ns - platform::monotonic_ns()) / kMs;
  if (left_ms <= 0) return false;
  pollfd waiting{.fd = socket, .events = events, .revents = 0};
  return ::poll(&waiting, 1, static_cast<int>(left_ms)) > 0;
}

[[nodiscard]] bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

/// All of the request's header, or what came of it in time.
[[nodiscard]] std::string receive_request(int client) {
  const std::int64_t deadline_mono_ns = platform::monotonic_ns() + kRequestTime_ns;
  std::string request;
  std::array<char, 2048> part;
  while (platform::parse_http_request(request).verdict == HttpVerdict::incomplete &&
         wait_for(client, POLLIN, deadline_mono_ns)) {
    const ::ssize_t length = ::recv(client, part.data(), part.size(), 0);
    if (length < 0 && would_block()) continue;
    if (length <= 0) break;
    request.append(part.data(), static_cast<std::size_t>(length));
  }
  return request;
}

void send_response(int client, std::string_view response) {
  const std::int64_t deadline_mono_ns = platform::monotonic_ns() + kResponseTime_ns;
  while (!response.empty() && wait_for(client, POLLOUT, deadline_mono_ns)) {
    const ::ssize_t length = ::send(client, response.data(), response.size(), MSG_NOSIGNAL);
    if (length < 0 && would_block()) continue;
    if (length <= 0) return;
    response.remove_prefix(static_cast<std::size_t>(length));
  }
  // Closing while something lies unread would reset the connection, and the answer could be lost with it.
  ::shutdown(client, SHUT_WR);
  std::array<char, 2048> rest;
  for (int i = 0; i < 16 && ::recv(client, rest.data(), rest.size(), MSG_DONTWAIT) > 0; ++i) {
  }
}

}  // namespace

MetricsServer::MetricsServer(const std::string& address)
    : listener_(listen_at(address)),
      stop_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      port_(port_of(listener_)) {
  constexpr std::string_view kUnix = "unix:";
  if (address.starts_with(kUnix)) unix_path_ = address.substr(kUnix.size());
  thread_ = std::make_unique<platform::RealtimeThread>(platform::RealtimeThreadSettings{.name = "metrics"},
                                                       [this]() noexcept { serve(); });
}

MetricsServer::~MetricsServer() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(stop_.number(), &one, sizeof(one));
  thread_.reset();
  if (!unix_path_.empty()) ::unlink(unix_path_.c_str());
}

void MetricsServer::publish(platform::EngineStatus status) {
  const std::lock_guard lock(mutex_);
  status_ = std::move(status);
}

void MetricsServer::serve() noexcept {
  constexpr std::int64_t kBreath_ns = 100 * kMs;
  while (true) {
    std::array<pollfd, 2> waiting{pollfd{.fd = listener_.number(), .events = POLLIN, .revents = 0},
                                  pollfd{.fd = stop_.number(), .events = POLLIN, .revents = 0}};
    ::poll(waiting.data(), waiting.size(), -1);
    if (waiting[1].revents != 0) return;
    if (waiting[0].revents == 0) continue;
    const platform::FileDescriptor client(
        ::accept4(listener_.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!client.is_open()) {
      // Out of descriptors, say: asking again at once would find the same.
      if (!would_block()) platform::sleep_until(platform::monotonic_ns() + kBreath_ns);
      continue;
    }
    try {
      answer(client.number());
    } catch (const std::exception&) {  // no memory: this client goes without
    }
  }
}

void MetricsServer::answer(int client) {
  const std::string request = receive_request(client);
  if (!request.empty()) send_response(client, response_to(request));
}

std::string MetricsServer::response_to(const std::string& bytes) {
  const platform::HttpRequest request = platform::parse_http_request(bytes);
  switch (request.verdict) {
    case HttpVerdict::get:
    case HttpVerdict::head:
      break;
    case HttpVerdict::other_method:
      return platform::http_response(405, kText, "only GET\n");
    case HttpVerdict::too_long:
      return platform::http_response(431, kText, "the request is too long\n");
    case HttpVerdict::incomplete:
    case HttpVerdict::malformed:
      return platform::http_response(400, kText, "this is no request\n");
  }
  const bool with_body = request.verdict == HttpVerdict::get;
  if (request.path == "/") return platform::http_response(200, kText, kHelp, with_body);
  const bool is_metrics = request.path == "/metrics";
  if (!is_metrics && request.path != "/status.json") {
    return platform::http_response(404, kText, "there are /metrics and /status.json\n", with_body);
  }
  std::optional<platform::EngineStatus> status;
  {
    const std::lock_guard lock(mutex_);
    status = status_;
  }
  if (!status) return platform::http_response(503, kText, "no status yet\n", with_body);
  return is_metrics
             ? platform::http_response(200, "text/plain; version=0.0.4; charset=utf-8",
                                       to_prometheus(*status), with_body)
             : platform::http_response(200, "application/json", to_json(*status).dump() + "\n", with_body);
}

}  // namespace landfix::tools
