#include "tools/top_screen.hpp"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace landfix::tools {
namespace {

using nlohmann::json;

class Screen {
 public:
  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format(format, std::forward<Values>(values)...);
    text_ += '\n';
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

[[nodiscard]] std::string duration(double seconds) {
  const auto all = static_cast<std::int64_t>(seconds);
  return fmt::format("{}:{:02}:{:02}", all / 3600, all / 60 % 60, all % 60);
}

/// Of a counter, a second.
[[nodiscard]] double rate(const json& now, const json& before, const json::json_pointer& counter) {
  const double seconds = now.at("uptime_s").get<double>() - before.at("uptime_s").get<double>();
  const double count = now.at(counter).get<double>();
  if (seconds > 0.0) return (count - before.at(counter).get<double>()) / seconds;
  const double uptime_s = now.at("uptime_s").get<double>();
  return uptime_s > 0.0 ? count / uptime_s : 0.0;
}

void add_pose(Screen& screen, const json& now) {
  const json& pose = now.at("pose");
  const auto number = [&pose](std::size_t i) { return pose.at(i).get<double>(); };
  screen.line("pose      x {:.3f}  y {:.3f}  z {:.3f} m   roll {:.3f}  pitch {:.3f}  yaw {:.3f} deg",
              number(0), number(1), number(2), number(3), number(4), number(5));
  screen.line("sigma     along {:.3f}  across {:.3f} m  yaw {:.3f} deg   speed {:.2f} m/s",
              now.at("sigma_m").at("along").get<double>(), now.at("sigma_m").at("cross").get<double>(),
              now.at("sigma_yaw_deg").get<double>(), now.at("speed_mps").get<double>());
  screen.line("match     score {:.2f}  iterations {}  points {}", now.at("score").get<double>(),
              now.at("iterations").get<int>(), now.at("points").get<std::uint64_t>());
}

void add_flow(Screen& screen, const json& now, const json& before) {
  const auto count = [](const json& group, const char* key) { return group.at(key).get<std::uint64_t>(); };
  const json& packets = now.at("packets");
  const json& sweeps = now.at("sweeps");
  const json& can = now.at("can");
  screen.line(
      "packets   {:.0f}/s   {} in all; dropped: kernel {}, ring {}, truncated {}, rejected {}; lost {}",
      rate(now, before, json::json_pointer("/packets/total")), count(packets, "total"),
      count(packets, "dropped_kernel"), count(packets, "dropped_ring"), count(packets, "truncated"),
      count(packets, "rejected"), count(packets, "lost"));
  screen.line("sweeps    {:.1f}/s   {} in all; missing {}, skipped {}, stopped by the deadline {}",
              rate(now, before, json::json_pointer("/sweeps/total")), count(sweeps, "total"),
              count(sweeps, "missing"), count(sweeps, "skipped"), count(sweeps, "deadline_misses"));
  screen.line("can       {}   {:.0f} frames/s   {} in all; dropped: queue full {}, bus down {}",
              can.at("state").get<std::string_view>(), rate(now, before, json::json_pointer("/can/frames")),
              count(can, "frames"), count(can, "dropped_queue_full"), count(can, "dropped_bus_down"));
}

void add_stages(Screen& screen, const json& now) {
  screen.line("\n{:<16} {:>9} {:>9} {:>9} {:>9} {:>10}", "stage [ms]", "p50", "p99", "p99.9", "max", "count");
  for (const auto& [name, stage] : now.at("stage_ms").items()) {
    screen.line("{:<16} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>10}", name, stage.at("p50_ms").get<double>(),
                stage.at("p99_ms").get<double>(), stage.at("p999_ms").get<double>(),
                stage.at("max_ms").get<double>(), stage.at("count").get<std::uint64_t>());
  }
}

void add_threads(Screen& screen, const json& now) {
  screen.line("\n{:<16} {:>9} {:>12} {:>12}", "thread", "", "page faults", "heap calls");
  for (const json& thread : now.at("threads")) {
    const json& calls = thread.at("heap_calls");
    screen.line("{:<16} {:>9} {:>12} {:>12}", thread.at("name").get<std::string_view>(),
                thread.at("alive").get<bool>() ? "advances" : "STANDS",
                thread.at("page_faults").get<std::uint64_t>(), calls.is_null() ? "-" : calls.dump());
  }
}

}  // namespace

std::string top_screen(const json& now, const json& before) {
  Screen screen;
  screen.line("landfixd {}   {}   up {}   {:.1f} MiB", now.at("version").get<std::string_view>(),
              now.at("sensor").get<std::string_view>(), duration(now.at("uptime_s").get<double>()),
              now.at("rss_mib").get<double>());
  screen.line("\nstate     {}   stamps by the {} clock", now.at("state").get<std::string_view>(),
              now.at("time_source").get<std::string_view>());
  add_pose(screen, now);
  add_flow(screen, now, before);
  add_stages(screen, now);
  add_threads(screen, now);
  return screen.take();
}

}  // namespace landfix::tools
