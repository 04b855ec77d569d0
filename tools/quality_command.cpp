// landfix quality: how crisp a point map is.
#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "ndt/map_quality.hpp"
#include "platform/atomic_file.hpp"
#include "platform/pcd_writer.hpp"
#include "tools/command.hpp"
#include "tools/input_files.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/quality_run.hpp"
#include "tools/quality_svg.hpp"

namespace landfix::tools {
namespace {

struct QualityArguments {
  std::vector<std::string> clouds;
  std::string cloud;
  std::string picture;
  QualitySettings settings;
  bool json = false;
};

constexpr std::array kJudgedMembers = {
    platform::PcdMember{.name = "x", .offset = offsetof(JudgedPoint, x)},
    platform::PcdMember{.name = "y", .offset = offsetof(JudgedPoint, y)},
    platform::PcdMember{.name = "z", .offset = offsetof(JudgedPoint, z)},
    platform::PcdMember{.name = "entropy", .offset = offsetof(JudgedPoint, entropy)},
    platform::PcdMember{.name = "plane_variance", .offset = offsetof(JudgedPoint, plane_variance_m)},
};

void write_results(const QualityArguments& arguments, const QualityResult& result) {
  if (!arguments.cloud.empty())
    platform::write_pcd<JudgedPoint>(arguments.cloud, kJudgedMembers, result.points);
  if (!arguments.picture.empty()) platform::write_file(arguments.picture, quality_svg(result.points));
}

void measure_quality(QualityArguments arguments) {
  const auto began = std::chrono::steady_clock::now();
  arguments.settings.keep_points = !arguments.cloud.empty() || !arguments.picture.empty();
  QualityCloud cloud = load_quality_cloud(list_clouds_once(arguments.clouds), arguments.settings);
  if (cloud.points_m.empty()) throw std::runtime_error("no point in the clouds: there is nothing to measure");
  show_progress("ordering the points");
  const ndt::NeighbourTree tree(std::move(cloud.points_m));
  const QualityResult result = judge_map(tree, cloud.chosen, arguments.settings, [](double share) {
    show_progress(fmt::format("looking at the points: {:.0f} %", 100.0 * share));
  });
  show_progress("");
  write_results(arguments, result);

  const ndt::MapQuality& quality = result.quality;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (arguments.json) {
    const nlohmann::json object{{"points", quality.points},
                                {"mme", quality.mean_map_entropy()},
                                {"mpv", quality.mean_plane_variance_m()},
                                {"radius_m", arguments.settings.radius_m},
                                {"skipped", quality.skipped},
                                {"cloud_points", cloud.cloud_points},
                                {"seconds", seconds}};
    fmt::print("{}\n", object.dump(2));
    return;
  }
  fmt::print("mean map entropy     {:.6f}\nmean plane variance  {:.6f} m\n", quality.mean_map_entropy(),
             quality.mean_plane_variance_m());
  fmt::print("of {} points of {}, within {} m; {} skipped, with fewer than {} neighbours or all in a plane\n",
             quality.points, cloud.cloud_points, arguments.settings.radius_m, quality.skipped,
             ndt::QualityProbe::kLeastNeighbours);
}

}  // namespace

void add_quality_command(CLI::App& app) {
  const auto arguments = std::make_shared<QualityArguments>();
  QualitySettings& settings = arguments->settings;
  CLI::App& command = *app.add_subcommand(
      "quality", "how crisp a point map is: its mean map entropy and mean plane variance");
  command.add_option("--pcd", arguments->clouds, "point clouds, or folders of them")
      ->required()
      ->type_name("FILE|DIR");
  command.add_option("--radius", settings.radius_m, "of the neighbourhood of each point [m]")
      ->check(in_range(0.001, 1000.0))
      ->type_name("M")
      ->capture_default_str();
  command
      .add_option("--sample", settings.sample,
                  "look at so many points, among all of their neighbours; at every point without it")
      ->check(in_range(std::size_t{1}, std::size_t{1} << 32))
      ->type_name("N");
  command.add_option("--seed", settings.seed, "another sample")->type_name("N")->capture_default_str();
  command
      .add_option(
          "--cloud", arguments->cloud,
          "write the points that were looked at with their entropy and plane_variance, NaN where skipped")
      ->type_name("OUT.pcd");
  command.add_option("--picture", arguments->picture, "draw them from above, coloured by both")
      ->type_name("OUT.svg");
  add_json_option(command, arguments->json);
  command.callback([arguments] { measure_quality(*arguments); });
}

}  // namespace landfix::tools
