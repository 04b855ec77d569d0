// What has been found of a case, in its folder, so that it need not be found again.
#pragma once

#include <filesystem>
#include <optional>

#include "tools/study/figures.hpp"

namespace landfix::tools::study {

/// Nothing if it was another case, another version of the program or of the route, or if it is to be kept and
/// was not.
[[nodiscard]] std::optional<CaseFigures> load_figures(const Case& one, const std::filesystem::path& folder);
void store_figures(const Case& one, const CaseFigures& figures, const std::filesystem::path& folder);

/// An empty folder for the case. Throws std::runtime_error where there is one that no study has made: what
/// somebody else has put there is not to be lost.
void make_room(const std::filesystem::path& folder);

}  // namespace landfix::tools::study
