// The study as one page for a browser, with the pictures of its sweeps beside it.
#pragma once

#include <span>
#include <string>

#include "tools/study/study_run.hpp"

namespace landfix::tools::study {

struct StudyPage {
  std::span<const CaseResult> results;
  double seconds = 0.0;  ///< that this run took
  std::string command;
  std::string version;
};

/// Pictures are those that the cases left below the page's folder.
[[nodiscard]] std::string to_html(const StudyPage& page);

}  // namespace landfix::tools::study
