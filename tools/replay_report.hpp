// A replay as people read it and as programs do.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "platform/evaluation.hpp"
#include "tools/covariance_check.hpp"
#include "tools/replay_run.hpp"

namespace landfix::tools {

struct ReplayReport {
  const ReplayResult& result;
  std::optional<platform::Evaluation> evaluation;  ///< where the truth is known
  std::optional<CovarianceCheck> covariances;
};

[[nodiscard]] nlohmann::ordered_json to_json(const ReplayReport& report);
[[nodiscard]] std::string to_text(const ReplayReport& report);

}  // namespace landfix::tools
