// The study's figures as tables: files for other programs.
#pragma once

#include <filesystem>
#include <span>

#include "tools/study/study_run.hpp"

namespace landfix::tools::study {

/// Writes mapping.csv, localization.csv, variations.csv (a row a case) and along.csv (a row a sweep).
void write_tables(std::span<const CaseResult> results, const std::filesystem::path& folder);

}  // namespace landfix::tools::study
