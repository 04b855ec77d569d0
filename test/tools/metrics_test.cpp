#include <algorithm>
#include <atomic>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>

#include "platform/file_descriptor.hpp"
#include "platform/http_request.hpp"
#include "support/error_of.hpp"
#include "support/run_landfix.hpp"
#include "support/test_data.hpp"
#include "tools/metrics_server.hpp"
#include "tools/metrics_socket.hpp"
#include "tools/metrics_text.hpp"

namespace landfix::tools {
namespace {

using platform::HttpVerdict;
using test::error_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;

platform::EngineStatus some_status() {
  const auto histogram = std::make_unique<platform::LatencyHistogram>();
  for (int i = 1; i <= 1000; ++i) histogram->record(i * 1000);
  platform::EngineStatus status;
  status.version = "1.2.3";
  status.sensor = "vlp\"16\\";
  status.uptime_s = 100.0;
  status.state = ndt::State::tracking;
  status.pose = ndt::make_pose({1.0, 2.0, 3.0}, {});
  status.sigma_along_m = 0.02;
  status.packets = 75'400;
  status.packets_dropped_ring = 3;
  status.receive_errors = 7;
  status.odometry.is_speed_believed = true;
  status.sweeps = 1000;
  status.stages[static_cast<std::size_t>(platform::Stage::total)] = platform::summarise(*histogram);
  status.threads = {{"rx", true, 0, 0}, {"solve", true, 1, 0}, {"tx", false, 0, 2}};
  return status;
}

/// Names the first line that the text format does not allow; empty if there is none.
std::string fault_of(const std::string& text) {
  std::set<std::string> described;
  std::set<std::string> series;
  std::string family;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    if (line.starts_with("# HELP ") || line.starts_with("# TYPE ")) {
      std::string hash;
      std::string what;
      std::string rest;
      words >> hash >> what >> family >> rest;
      if (rest.empty() || !described.insert(what + family).second) return line;
      continue;
    }
    const std::size_t name_end = line.find_first_of("{ ");
    const std::string name = line.substr(0, name_end);
    for (const char character : name) {
      if (std::isalnum(static_cast<unsigned char>(character)) == 0 && character != '_') return line;
    }
    if (!name.starts_with(family) || described.count("TYPE" + family) == 0) return line;
    const std::size_t value_at = line.rfind(' ');
    if (value_at == std::string::npos || !series.insert(line.substr(0, value_at)).second) return line;
    std::size_t used = 0;
    const std::string value = line.substr(value_at + 1);
    try {
      (void)std::stod(value, &used);
    } catch (const std::exception&) {
      return line;
    }
    if (used != value.size()) return line;
  }
  return text.ends_with('\n') ? "" : "no end of line at the end";
}

/// A client that does as it pleases.
class RawClient {
 public:
  explicit RawClient(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_.number(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  }
  void send(std::string_view bytes) const {
    (void)::send(socket_.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  [[nodiscard]] std::string receive() const {
    std::string all;
    char part[4096];
    for (::ssize_t length = 0; (length = ::recv(socket_.number(), part, sizeof(part), 0)) > 0;) {
      all.append(part, static_cast<std::size_t>(length));
    }
    return all;
  }

 private:
  platform::FileDescriptor socket_;
};

std::string local(const MetricsServer& server) { return "127.0.0.1:" + std::to_string(server.port()); }

TEST(Metrics, AreWhatPrometheusReads) {
  const std::string text = to_prometheus(some_status());
  EXPECT_EQ(fault_of(text), "");
  for (const char* const line :
       {"landfix_packets_total{sensor=\"vlp\\\"16\\\\\"} 75400\n",
        "landfix_packets_dropped_total{where=\"ring\"} 3\n", "landfix_receive_errors_total 7\n",
        "landfix_odometry_believed{quantity=\"speed\"} 1\n",
        "landfix_odometry_believed{quantity=\"yaw_rate\"} 0\n", "landfix_gnss_guesses_total 0\n",
        "landfix_scans_total 1000\n", "landfix_pose_state{state=\"TRACKING\"} 1\n",
        "landfix_pose_state{state=\"LOST\"} 0\n", "landfix_pose_sigma_meters{axis=\"along\"} 0.02\n",
        "# TYPE landfix_stage_duration_seconds histogram\n",
        "landfix_stage_duration_seconds_count{stage=\"total\"} 1000\n",
        "landfix_stage_duration_seconds_bucket{stage=\"total\",le=\"+Inf\"} 1000\n",
        "landfix_heap_allocations_total{thread=\"tx\"} 2\n",
        "landfix_page_faults_total{thread=\"solve\"} 1\n"}) {
    EXPECT_THAT(text, HasSubstr(line));
  }
}

TEST(Metrics, LeaveOutWhatIsNotKnown) {
  platform::EngineStatus status = some_status();
  status.heap_is_counted = false;
  EXPECT_EQ(to_prometheus(status).find("heap_allocations"), std::string::npos);
  status.score = std::nan("");
  EXPECT_EQ(fault_of(to_prometheus(status)), "");
}

TEST(DurationSummary, CountsUpToEachBound) {
  const platform::DurationSummary total =
      some_status().stages[static_cast<std::size_t>(platform::Stage::total)];
  for (std::size_t i = 0; i < total.within.size(); ++i) {
    const double expected = std::min(1000.0, platform::kDurationBounds_s[i] * 1e6);
    EXPECT_NEAR(static_cast<double>(total.within[i]), expected, 1.0 + 0.008 * expected) << i;
  }
  EXPECT_NEAR(total.sum_s, 0.5005, 0.004);
  EXPECT_NEAR(total.percentiles_s[0], 500e-6, 4e-6);
  EXPECT_NEAR(total.max_s, 1000e-6, 1e-12);
}

TEST(MetricsServer, AnswersOnAPort) {
  MetricsServer server("127.0.0.1:0");
  EXPECT_THAT(error_of([&] { return http_get(local(server), "/metrics"); }), HasSubstr("503"));
  server.publish(some_status());
  EXPECT_EQ(http_get(local(server), "/metrics"), to_prometheus(some_status()));
  EXPECT_THAT(http_get(local(server), "/"), HasSubstr("/status.json"));
  const auto status = nlohmann::json::parse(http_get(local(server), "/status.json"));
  EXPECT_EQ(status["state"], "TRACKING");
  EXPECT_EQ(status["packets"]["total"], 75'400);
  EXPECT_THAT(error_of([&] { return http_get(local(server), "/favicon.ico"); }), HasSubstr("404 Not Found"));
}

TEST(MetricsServer, AnswersOnAUnixSocket) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path path = directory.path() / "metrics";
  for (int round = 0; round < 2; ++round) {
    MetricsServer server("unix:" + path.string());
    server.publish(some_status());
    EXPECT_THAT(http_get("unix:" + path.string(), "/metrics"), HasSubstr("landfix_scans_total 1000"));
    EXPECT_THAT(error_of([&] { return std::make_unique<MetricsServer>("unix:" + path.string()); }),
                HasSubstr("Address already in use"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  // What a killed daemon leaves behind is in nobody's way.
  { const platform::FileDescriptor left = listen_at("unix:" + path.string()); }
  EXPECT_TRUE(std::filesystem::exists(path));
  const MetricsServer server("unix:" + path.string());
}

TEST(MetricsServer, StandsSlowManyAndMalformedClients) {
  MetricsServer server("127.0.0.1:0");
  server.publish(some_status());
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 5; ++i) silent.push_back(std::make_unique<RawClient>(server.port()));
  silent.front()->send("GET /met");
  EXPECT_THAT(http_get(local(server), "/metrics"), HasSubstr("landfix_scans_total"));
  EXPECT_THAT(silent.front()->receive(), StartsWith("HTTP/1.1 400"));
  for (const auto& [request, answer] :
       std::vector<std::pair<std::string, std::string>>{{"hello\r\n\r\n", "HTTP/1.1 400"},
                                                        {std::string("\0\xFF\r\n\r\n", 6), "HTTP/1.1 400"},
                                                        {"POST /metrics HTTP/1.1\r\n\r\n", "HTTP/1.1 405"},
                                                        {std::string(9000, 'a'), "HTTP/1.1 431"},
                                                        {"HEAD /metrics HTTP/1.0\r\n\r\n", "HTTP/1.1 200"}}) {
    const RawClient client(server.port());
    client.send(request);
    EXPECT_THAT(client.receive(), StartsWith(answer));
  }
  for (int i = 0; i < 50; ++i) RawClient(server.port()).send("GET /metrics HTTP/1.1\r\n\r\n");
  EXPECT_THAT(http_get(local(server), "/metrics"), HasSubstr("landfix_scans_total"));
}

TEST(MetricsServer, IsReadWhileItIsPublishedTo) {
  MetricsServer server("127.0.0.1:0");
  server.publish(some_status());
  std::atomic<bool> ends{false};
  std::thread house([&] {
    while (!ends) server.publish(some_status());
  });
  for (int i = 0; i < 20; ++i) EXPECT_EQ(fault_of(http_get(local(server), "/metrics")), "");
  ends = true;
  house.join();
}

TEST(MetricsServer, SaysWhyItCannotListen) {
  EXPECT_THAT(error_of([] { return std::make_unique<MetricsServer>("192.0.2.1:9464"); }),
              StartsWith("192.0.2.1:9464: cannot offer metrics there: "));
  EXPECT_THAT(error_of([] { return std::make_unique<MetricsServer>("unix:/no/such/folder/metrics"); }),
              HasSubstr("No such file"));
}

TEST(TopCommand, ShowsTheDaemonAtAGlance) {
  MetricsServer server("127.0.0.1:0");
  server.publish(some_status());
  const test::Outcome top = test::run_landfix({"top", "--address", local(server)});
  EXPECT_EQ(top.code, 0) << top.error;
  for (const char* const text : {"landfixd 1.2.3", "state     TRACKING", "x 1.000  y 2.000  z 3.000 m",
                                 "packets   754/s", "ring 3", "total ", "up 0:01:40", "STANDS"}) {
    EXPECT_THAT(top.out, HasSubstr(text));
  }
  const test::Outcome as_json = test::run_landfix({"top", "--address", local(server), "--json"});
  EXPECT_EQ(nlohmann::json::parse(as_json.out)["state"], "TRACKING");
}

TEST(TopCommand, SaysThatNobodyAnswers) {
  const test::Outcome outcome = test::run_landfix({"top", "--address", "127.0.0.1:1"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.error, HasSubstr("127.0.0.1:1: no daemon answers"));
  EXPECT_EQ(test::run_landfix({"top", "--address", "nowhere"}).code, 1);
}

TEST(LatencyCommand, AsksTheRunningDaemon) {
  MetricsServer server("127.0.0.1:0");
  server.publish(some_status());
  const test::Outcome live = test::run_landfix({"latency", "--live", "--address", local(server)});
  EXPECT_EQ(live.code, 0) << live.error;
  EXPECT_THAT(live.out, HasSubstr("\ntotal "));
  EXPECT_THAT(live.out, HasSubstr("MET    p50 1, p99.9 2"));
  EXPECT_EQ(test::run_landfix({"latency", "--live", "a.hgrm"}).code, 2);
}

TEST(HttpRequest, IsTakenWithOrWithoutCarriageReturns) {
  const auto verdict = [](std::string_view text) { return platform::parse_http_request(text).verdict; };
  EXPECT_EQ(verdict("GET / HTTP/1.1\r\n"), HttpVerdict::incomplete);
  EXPECT_EQ(verdict("GET / HTTP/1.1\r\n\r\n"), HttpVerdict::get);
  EXPECT_EQ(verdict("GET / HTTP/1.0\n\n"), HttpVerdict::get);
  EXPECT_EQ(verdict("GET / HTTP/2\n\n"), HttpVerdict::malformed);
  EXPECT_EQ(verdict("GET http://x/ HTTP/1.1\n\n"), HttpVerdict::malformed);
  EXPECT_EQ(verdict("\n\n"), HttpVerdict::malformed);
  EXPECT_EQ(platform::parse_http_request("GET /metrics?a=b HTTP/1.1\n\n").path, "/metrics");
}

}  // namespace
}  // namespace landfix::tools
