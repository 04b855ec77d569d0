#include "tools/html_report.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/evaluation.hpp"
#include "support/xml.hpp"
#include "tools/latency_chart.hpp"
#include "tools/strip_chart.hpp"

namespace landfix::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ndt::Pose true_pose(double time_s) {
  return ndt::make_pose({8.0 * time_s, 20.0 * std::sin(0.1 * time_s), 0.0}, {0.0, 0.0, 0.1});
}

ndt::State state_of(int sweep) {
  if (sweep == 0) return ndt::State::init;
  if (sweep >= 300 && sweep < 320) return ndt::State::degraded;
  if (sweep >= 500 && sweep < 510) return ndt::State::predicted;
  return sweep >= 510 && sweep < 520 ? ndt::State::lost : ndt::State::tracking;
}

/// A drive at 10 Hz with all that may happen on it.
ReplayResult drive(int sweeps) {
  ReplayResult result;
  result.durations.resize(platform::kStageCount);
  for (int i = 0; i < sweeps; ++i) {
    platform::SweepResult sweep;
    const double wave = std::sin(0.37 * i) * std::sin(0.011 * i);
    sweep.fix.state = state_of(i);
    sweep.fix.at = {1'700'000'000'000'000'000 + i * std::int64_t{100'000'000}, true_pose(0.1 * i)};
    sweep.fix.at.pose.translation().y() += 0.01 + 0.01 * wave;
    sweep.fix.covariance = 1e-4 * ndt::Matrix6::Identity();
    sweep.fix.match.nearest_voxel_likelihood = 0.8 + 0.1 * wave;
    sweep.fix.match.iterations = 12 + static_cast<int>(4.0 * wave);
    sweep.points_filtered = static_cast<std::size_t>(1000.0 + 200.0 * wave);
    sweep.missing = sweep.fix.state == ndt::State::predicted || sweep.fix.state == ndt::State::lost;
    sweep.complete = true;
    sweep.times = {1, 1'000'000, 1'100'000, 1'600'000 + static_cast<std::int64_t>(2e5 * wave)};
    result.tally.add(sweep);
    result.sweeps.push_back(sweep);
    for (const auto& [stage, median_ns] : {std::pair{platform::Stage::decode, 9e4},
                                           {platform::Stage::filter, 2e5},
                                           {platform::Stage::match, 5e5},
                                           {platform::Stage::publish, 4e3},
                                           {platform::Stage::total, 7e5}}) {
      result.durations[static_cast<std::size_t>(stage)].record(static_cast<std::int64_t>(
          median_ns * std::exp(0.5 * std::sin(1.7 * i) + (i % 97 == 0 ? 1.0 : 0.0))));
    }
  }
  result.heap_calls = 0;
  return result;
}

std::vector<ndt::StampedPose> truth_of(const ReplayResult& result) {
  std::vector<ndt::StampedPose> truth;
  for (std::size_t i = 0; i < result.sweeps.size(); ++i) {
    truth.push_back({result.sweeps[i].fix.at.stamp_utc_ns, true_pose(0.1 * static_cast<double>(i))});
  }
  return truth;
}

std::vector<Eigen::Vector3f> houses() {
  std::vector<Eigen::Vector3f> points_m;
  for (int i = 0; i < 60'000; ++i) {
    const auto at = static_cast<float>(i % 2000);
    points_m.emplace_back(0.4F * at, i % 2 == 0 ? 45.0F : -45.0F, 0.1F * static_cast<float>(i % 80));
  }
  return points_m;
}

std::string page_of(const ReplayResult& result, bool with_truth) {
  const auto truth = with_truth ? truth_of(result) : std::vector<ndt::StampedPose>();
  ReplayReport replay{.result = result, .evaluation = {}, .covariances = {}};
  if (with_truth) replay.evaluation = platform::evaluate(truth, result.trajectory());
  const auto points_m = houses();
  return to_html({.replay = replay,
                  .truth = truth,
                  .map_points_m = points_m,
                  .sensor = "vlp16",
                  .capture = "a <drive> & \"more\".pcap",
                  .map = "site.ndt",
                  .command = "landfix replay --config config.toml",
                  .version = "1.2.3"});
}

TEST(HtmlReport, ShowsTheWholeReplay) {
  const std::string page = page_of(drive(800), true);
  EXPECT_TRUE(test::is_well_formed(page.substr(page.find("<html"))));
  for (const char* const text :
       {"id=\"map\"", "id=\"trajectory\"", "id=\"states\"", "position error [cm]", "iterations",
        "Latencies by stage", ">total<", ">TRACKING<", "TRACKING 759", "LOST 10", "packets lost",
        "landfix 1.2.3", "landfix replay --config config.toml",
        "a &lt;drive&gt; &amp; &quot;more&quot;.pcap"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
  EXPECT_THAT(page, Not(HasSubstr("<drive>")));
}

TEST(HtmlReport, NeedsNoNetworkAndNoScript) {
  std::string page = page_of(drive(50), true);
  const std::string name_space = "http://www.w3.org/2000/svg";
  for (std::size_t at = 0; (at = page.find(name_space)) != std::string::npos;)
    page.erase(at, name_space.size());
  for (const char* const text : {"http:", "https:", "<script", "<link", "url(", "src=", "@import"}) {
    EXPECT_THAT(page, Not(HasSubstr(text)));
  }
}

TEST(HtmlReport, NeedsNoTruth) {
  const std::string page = page_of(drive(50), false);
  EXPECT_TRUE(test::is_well_formed(page.substr(page.find("<html"))));
  EXPECT_THAT(page, Not(HasSubstr("position error")));
  EXPECT_THAT(page, Not(HasSubstr("Error against")));
}

TEST(HtmlReport, ShowsADriveOfOneSweep) {
  const std::string page = page_of(drive(1), false);
  EXPECT_TRUE(test::is_well_formed(page.substr(page.find("<html"))));
  EXPECT_THAT(page, Not(HasSubstr("=\"nan")));
  EXPECT_THAT(page, Not(HasSubstr("inf\"")));
}

TEST(StripChart, StaysSmallHoweverLongTheDrive) {
  StripChart chart;
  chart.strips = {{"value", {}}};
  for (int i = 0; i < 200'000; ++i) {
    chart.times_s.push_back(0.1 * i);
    chart.states.push_back(ndt::State::tracking);
    chart.strips[0].values.push_back(std::sin(static_cast<double>(i)));
  }
  EXPECT_LT(strip_chart_svg(chart).size(), 100'000U);
}

TEST(StripChart, LeavesAGapWhereValuesAreMissing) {
  StripChart chart;
  chart.strips = {{"value", {}}};
  for (int i = 0; i < 100; ++i) {
    chart.times_s.push_back(0.1 * i);
    chart.states.push_back(i < 50 ? ndt::State::tracking : ndt::State::no_data);
    chart.strips[0].values.push_back(i > 40 && i < 60 ? std::nan("") : 1.0);
  }
  const std::string svg = strip_chart_svg(chart);
  EXPECT_TRUE(test::is_well_formed(svg));
  EXPECT_THAT(svg, HasSubstr("<title>NO_DATA</title>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(LatencyChart, OfNothingIsNothing) { EXPECT_EQ(latency_chart_svg({}), ""); }

}  // namespace
}  // namespace landfix::tools
