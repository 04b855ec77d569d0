// The routes of config/routes, as the build put them into the program.
#pragma once

#include <span>
#include <string_view>

namespace landfix::tools::simulator {

struct EmbeddedRoute {
  std::string_view name;
  std::string_view toml;
};

extern const std::span<const EmbeddedRoute> kEmbeddedRoutes;

}  // namespace landfix::tools::simulator
