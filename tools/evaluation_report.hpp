// An evaluation as people read it and as programs do.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "platform/evaluation.hpp"

namespace landfix::tools {

/// NaN, where there was nothing to measure, becomes null.
[[nodiscard]] nlohmann::ordered_json to_json(const platform::Evaluation& evaluation);

/// A table of several lines, each with its end.
[[nodiscard]] std::string to_table(const platform::Evaluation& evaluation);

}  // namespace landfix::tools
