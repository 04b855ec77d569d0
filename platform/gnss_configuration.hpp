// The sections [gnss] and [[gnss.signal]] of the configuration.
#pragma once

#include "platform/gnss.hpp"
#include "platform/toml_section.hpp"

namespace landfix::platform {

/// Throws std::runtime_error with the place and what is wrong.
void read_gnss(TomlSection section, GnssSettings& gnss);

}  // namespace landfix::platform
