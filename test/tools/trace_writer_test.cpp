#include "tools/trace_writer.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/test_data.hpp"

namespace landfix::tools {
namespace {

using nlohmann::json;

constexpr std::int64_t kMs = 1'000'000;

/// A sweep each 100 ms, its match 1 ms long and its sending begun 0.1 ms later.
platform::SolvedSweep sweep_at(int i) {
  platform::SolvedSweep sweep;
  const std::int64_t end_ns = 50'000'000'000 + i * 100 * kMs;
  sweep.arrived_mono_ns = end_ns;
  sweep.result.fix.at.stamp_utc_ns = 1'700'000'000'000'000'000 + i * 100 * kMs;
  sweep.result.fix.state = ndt::State::tracking;
  sweep.result.fix.match.iterations = 10 + i % 5;
  sweep.result.points_filtered = 1000;
  // As in the pipeline, the packet that ends a sweep begins the next: this one's first is the last one's
  // last.
  sweep.result.times = {end_ns - 100 * kMs, end_ns + 50'000, end_ns + 200'000, end_ns + 200'000 + kMs};
  return sweep;
}

platform::SentSweep sent_at(int i) {
  const platform::SolvedSweep sweep = sweep_at(i);
  const std::int64_t began_ns = sweep.result.times.matched_ns + kMs / 10;
  return {sweep.result.fix.at.stamp_utc_ns, began_ns, began_ns + 20'000};
}

/// Names what is wrong with a trace; empty if it is as viewers take it.
std::string fault_of(const json& trace) {
  std::map<int, double> ended_us;
  std::map<std::string, double> counted_us;
  std::map<std::string, double> flow_us;
  for (const json& event : trace["traceEvents"]) {
    const std::string phase = event["ph"];
    if (event["pid"] != 1) return "no process: " + event.dump();
    if (phase == "M") continue;
    const double at_us = event["ts"];
    if (at_us < 0.0) return "before the beginning: " + event.dump();
    if (phase == "X") {
      double& end_us = ended_us[event["tid"].get<int>()];
      if (at_us < end_us - 1e-6) return "begins within another: " + event.dump();
      end_us = at_us + event["dur"].get<double>();
      if (event["dur"] <= 0.0) return "no length: " + event.dump();
    } else if (phase == "C") {
      double& last_us = counted_us[event["name"].get<std::string>()];
      if (at_us < last_us) return "goes back: " + event.dump();
      last_us = at_us;
    } else if (phase == "s" || phase == "t" || phase == "f") {
      const std::string id = event["id"];
      if ((phase == "s") != (flow_us.count(id) == 0)) return "an arrow without its begin: " + event.dump();
      if (at_us < flow_us[id]) return "an arrow that leads back: " + event.dump();
      flow_us[id] = at_us;
      const double end_us = ended_us[event["tid"].get<int>()];
      if (at_us >= end_us) return "an arrow outside of its span: " + event.dump();
    } else {
      return "unknown: " + event.dump();
    }
  }
  return "";
}

json read(const std::filesystem::path& path) { return json::parse(std::ifstream(path)); }

std::size_t count(const json& trace, const std::string& phase, const std::string& name) {
  std::size_t found = 0;
  for (const json& event : trace["traceEvents"]) {
    if (event["ph"] == phase && event["name"] == name) ++found;
  }
  return found;
}

TEST(TraceWriter, HasASpanOfEachStageAndAnArrowFromPacketsToFrames) {
  const test::TemporaryDirectory directory;
  TraceWriter writer(directory.path() / "trace.json");
  for (int i = 0; i < 50; ++i) {
    writer.add(sweep_at(i));
    writer.add(sent_at(i));
  }
  EXPECT_FALSE(std::filesystem::exists(directory.path() / "trace.json"));
  writer.commit();
  const json trace = read(directory.path() / "trace.json");
  EXPECT_EQ(fault_of(trace), "");
  for (const char* const name : {"packets", "last packet", "filter", "match", "publish"}) {
    EXPECT_EQ(count(trace, "X", name), 50U) << name;
  }
  for (const char* const phase : {"s", "t", "f"}) EXPECT_EQ(count(trace, phase, "pose"), 50U) << phase;
  for (const char* const name : {"state", "iterations", "points"}) EXPECT_EQ(count(trace, "C", name), 50U);
  std::set<std::string> threads;
  for (const json& event : trace["traceEvents"]) {
    if (event["name"] == "thread_name") threads.insert(event["args"]["name"]);
  }
  EXPECT_EQ(threads, (std::set<std::string>{"rx", "solve", "tx"}));
}

TEST(TraceWriter, SaysHowLongThingsTake) {
  const test::TemporaryDirectory directory;
  TraceWriter writer(directory.path() / "trace.json");
  writer.add(sweep_at(0));
  writer.commit();
  const json trace = read(directory.path() / "trace.json");
  ASSERT_EQ(count(trace, "X", "match"), 1U);
  for (const json& event : trace["traceEvents"]) {
    if (event["name"] != "match") continue;
    EXPECT_NEAR(event["dur"].get<double>(), 1000.0, 1e-9);
    EXPECT_NEAR(event["ts"].get<double>(), 100'200.0, 1e-9);
    EXPECT_EQ(event["args"]["iterations"], 10);
    EXPECT_EQ(event["args"]["state"], "TRACKING");
  }
}

TEST(TraceWriter, TakesMissingSkippedAndLateSweeps) {
  const test::TemporaryDirectory directory;
  TraceWriter writer(directory.path() / "trace.json");
  for (int i = 0; i < 20; ++i) {
    platform::SolvedSweep sweep = sweep_at(i);
    if (i % 5 == 0) {
      sweep.result.missing = true;
      sweep.result.times = {};
    }
    if (i % 5 == 1) {  // the match before it took too long: it was taken up late, and not matched
      sweep.result.skipped = true;
      sweep.result.times.last_packet_ns += 150 * kMs;
      sweep.result.times.filtered_ns = sweep.result.times.matched_ns =
          sweep.result.times.last_packet_ns + kMs;
    }
    writer.add(sweep);
    if (i % 3 != 0) writer.add(sent_at(i));
  }
  writer.commit();
  const json trace = read(directory.path() / "trace.json");
  const std::string fault = fault_of(trace);
  EXPECT_TRUE(fault.empty() || fault.starts_with("an arrow")) << fault;
  EXPECT_EQ(count(trace, "C", "state"), 20U);
  EXPECT_EQ(count(trace, "C", "iterations"), 16U);
}

TEST(TraceWriter, OfNothingIsATraceToo) {
  const test::TemporaryDirectory directory;
  TraceWriter writer(directory.path() / "trace.json");
  writer.commit();
  EXPECT_EQ(fault_of(read(directory.path() / "trace.json")), "");
}

}  // namespace
}  // namespace landfix::tools
