// Many cases, several at once; what is done already is not done again.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tools/study/case_process.hpp"
#include "tools/study/figures.hpp"

namespace landfix::tools::study {

struct StudyProgress {
  std::function<void(const CaseResult&)> on_result;
  std::function<void(std::span<const std::string>)> on_wait;  ///< the names of those at work, now and then
};

/// Each in a folder of its name below `folder`. The names must differ. `at_once`: processes, at least 1.
[[nodiscard]] std::vector<CaseResult> run_cases(std::span<const Case> cases,
                                                const std::filesystem::path& folder, std::size_t at_once,
                                                const StudyProgress& progress);

}  // namespace landfix::tools::study
