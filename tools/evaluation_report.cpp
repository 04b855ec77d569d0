#include "tools/evaluation_report.hpp"

#include <array>
#include <cmath>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace landfix::tools {
namespace {

using platform::ErrorStatistics;
using platform::Evaluation;

struct Row {
  std::string_view key;
  std::string_view title;
  ErrorStatistics Evaluation::*statistics;
};

// The keys are what other programs rely on.
constexpr std::array kRows{
    Row{"ate_m", "position [m]", &Evaluation::ate_m},
    Row{"ate_deg", "rotation [deg]", &Evaluation::ate_deg},
    Row{"heading_deg", "heading [deg]", &Evaluation::heading_deg},
    Row{"roll_deg", "roll [deg]", &Evaluation::roll_deg},
    Row{"pitch_deg", "pitch [deg]", &Evaluation::pitch_deg},
    Row{"elevation_m", "elevation [m]", &Evaluation::elevation_m},
    Row{"rpe_m", "relative position [m]", &Evaluation::rpe_m},
    Row{"rpe_deg", "relative rotation [deg]", &Evaluation::rpe_deg},
};

std::string cell(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4f}", value); }

}  // namespace

nlohmann::ordered_json to_json(const Evaluation& evaluation) {
  nlohmann::ordered_json json{{"pairs", evaluation.pairs}, {"unmatched", evaluation.unmatched}};
  for (const Row& row : kRows) {
    const ErrorStatistics& errors = evaluation.*row.statistics;
    json[row.key] = {
        {"rmse", errors.rmse}, {"mean", errors.mean}, {"median", errors.median}, {"max", errors.max}};
  }
  json["rpe_pairs"] = evaluation.rpe_pairs;
  return json;
}

std::string to_table(const Evaluation& evaluation) {
  std::string table = fmt::format("{} poses compared, {} outside of the reference's time\n", evaluation.pairs,
                                  evaluation.unmatched);
  table += fmt::format("{:<24}{:>10}{:>10}{:>10}{:>10}\n", "error", "rmse", "mean", "median", "max");
  for (const Row& row : kRows) {
    const ErrorStatistics& errors = evaluation.*row.statistics;
    table += fmt::format("{:<24}{:>10}{:>10}{:>10}{:>10}\n", row.title, cell(errors.rmse), cell(errors.mean),
                         cell(errors.median), cell(errors.max));
  }
  return table;
}

}  // namespace landfix::tools
