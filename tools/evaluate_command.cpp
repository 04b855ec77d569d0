// landfix evaluate: how far an estimated trajectory is from a reference.
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "platform/evaluation.hpp"
#include "platform/trajectory.hpp"
#include "tools/command.hpp"
#include "tools/evaluation_report.hpp"
#include "tools/landfix_commands.hpp"

namespace landfix::tools {
namespace {

using platform::Alignment;

struct EvaluateArguments {
  std::string reference;
  std::string estimate;
  std::string align = "none";
  double delta_s = 1.0;
  bool json = false;
};

Alignment alignment(const std::string& name) {
  if (name == "first") return Alignment::first;
  return name == "se3" ? Alignment::se3 : Alignment::none;
}

void evaluate(const EvaluateArguments& arguments) {
  const auto reference = platform::read_tum(arguments.reference);
  const auto estimate = platform::read_tum(arguments.estimate);
  const auto delta_ns = static_cast<std::int64_t>(std::llround(arguments.delta_s * 1e9));
  const platform::Evaluation evaluation = platform::evaluate(
      reference, estimate, {.alignment = alignment(arguments.align), .delta_ns = delta_ns});
  fmt::print("{}", arguments.json ? to_json(evaluation).dump(2) + "\n" : to_table(evaluation));
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App& command = *app.add_subcommand("evaluate", "errors of a trajectory against a reference");
  command.add_option("--reference", arguments->reference, "true trajectory (TUM)")
      ->required()
      ->type_name("A.tum");
  command.add_option("--estimate", arguments->estimate, "trajectory to judge (TUM)")
      ->required()
      ->type_name("B.tum");
  command
      .add_option("--align", arguments->align,
                  "move the estimate first: none, first pose, or se3 least squares")
      ->check(CLI::IsMember({"none", "first", "se3"}).description(""))
      ->type_name("none|first|se3")
      ->capture_default_str();
  command.add_option("--delta", arguments->delta_s, "interval of the relative errors [s]")
      ->check(in_range(1e-3, 1e6))
      ->type_name("S")
      ->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { evaluate(*arguments); });
}

}  // namespace landfix::tools
