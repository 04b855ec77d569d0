#include "tools/daemon_check.hpp"

#include <nlohmann/json.hpp>

#include "platform/budget.hpp"
#include "tools/budget_report.hpp"
#include "tools/replay_setup.hpp"

namespace landfix::tools {

std::string check_daemon(const std::filesystem::path& config, bool json) {
  const ReplaySetup setup = prepare_replay({.config = config});
  if (setup.search) setup.search->prepare();
  const std::filesystem::path& map = setup.configuration.map.file;
  const platform::Budget budget =
      platform::budget_of(setup.configuration, setup.model, std::filesystem::file_size(map),
                          setup.search ? setup.search->memory_bytes() : 0);
  return json ? to_json(budget).dump(2) + "\n" : to_text(budget);
}

}  // namespace landfix::tools
