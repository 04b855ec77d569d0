// What is told of one match, by `landfix align` and `landfix locate`.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "ndt/matcher.hpp"

namespace landfix::tools {

/// `fitness_score`: see ndt/fitness.hpp.
[[nodiscard]] nlohmann::json match_to_json(const ndt::MatchResult& result, double fitness_score,
                                           double match_ms);
/// Some lines.
[[nodiscard]] std::string match_to_text(const ndt::MatchResult& result, double fitness_score,
                                        double match_ms);

}  // namespace landfix::tools
