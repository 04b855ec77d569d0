// Offers the engine's status over HTTP: /metrics for Prometheus, /status.json for `landfix top`. One thread
// answers one client after the other, each within a stated time. Not cpp-httplib: Debian's brings OpenSSL and
// Brotli into the daemon's locked memory, and a client that sends a byte now and then holds it for ever.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "platform/engine_status.hpp"
#include "platform/file_descriptor.hpp"
#include "platform/realtime_thread.hpp"

namespace landfix::tools {

class MetricsServer {
 public:
  /// Listens and answers from now on: 503 until there is a status. Throws std::runtime_error where it cannot.
  explicit MetricsServer(const std::string& address);
  ~MetricsServer();
  MetricsServer(const MetricsServer&) = delete;
  MetricsServer& operator=(const MetricsServer&) = delete;

  /// Takes a lock: for a thread that is not real-time.
  void publish(platform::EngineStatus status);

  /// The port that was asked for, or for port 0 the one that the kernel chose.
  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

 private:
  void serve() noexcept;
  void answer(int client);
  [[nodiscard]] std::string response_to(const std::string& bytes);

  std::string unix_path_;  ///< to be removed in the end; empty: none
  platform::FileDescriptor listener_;
  platform::FileDescriptor stop_;  ///< an eventfd
  std::uint16_t port_ = 0;
  std::mutex mutex_;
  std::optional<platform::EngineStatus> status_;
  std::unique_ptr<platform::RealtimeThread> thread_;  ///< for its stack; it has no priority
};

}  // namespace landfix::tools
