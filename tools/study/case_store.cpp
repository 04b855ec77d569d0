#include "tools/study/case_store.hpp"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "platform/atomic_file.hpp"
#include "tools/simulator/route.hpp"

namespace landfix::tools::study {
namespace {

constexpr const char* kResult = "result.json";
constexpr const char* kMark = "study-case";  ///< in every folder that a study has made

/// Of a route that is a file: its text, which may have been changed meanwhile.
[[nodiscard]] std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

[[nodiscard]] nlohmann::json identity_of(const Case& one) {
  return {{"route", one.route},        {"route_text", text_of(one.route)},
          {"sensor", one.sensor},      {"length_m", one.length_m},
          {"ablate", one.ablate},      {"tune", one.tune},
          {"version", LANDFIX_VERSION}};
}

}  // namespace

std::optional<CaseFigures> load_figures(const Case& one, const std::filesystem::path& folder) {
  const auto json = nlohmann::json::parse(text_of(folder / kResult), nullptr, false);
  if (!json.is_object() || json.value("case", nlohmann::json()) != identity_of(one)) return std::nullopt;
  if (one.keep && !json.value("kept", false)) return std::nullopt;
  try {
    return json.at("figures").get<CaseFigures>();
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;  // of a program whose figures were others: it is done anew
  }
}

void store_figures(const Case& one, const CaseFigures& figures, const std::filesystem::path& folder) {
  const nlohmann::json result{{"case", identity_of(one)}, {"kept", one.keep}, {"figures", figures}};
  platform::write_file(folder / kResult, result.dump());
}

void make_room(const std::filesystem::path& folder) {
  if (std::filesystem::exists(folder) && !std::filesystem::is_empty(folder) &&
      !std::filesystem::exists(folder / kMark)) {
    throw std::runtime_error(fmt::format(
        "{} is there already and no study has made it: move it, or give another --output", folder.string()));
  }
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  platform::write_file(folder / kMark, "A study works here, and may empty this folder.\n");
}

}  // namespace landfix::tools::study
