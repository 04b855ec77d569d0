// What the reader is told when the kernel refuses something of a file.
#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace landfix::platform {

/// "PATH: cannot DOING: " and the reason in errno, as std::runtime_error.
[[noreturn]] inline void fail(const std::filesystem::path& path, std::string_view doing) {
  throw std::runtime_error(fmt::format("{}: cannot {}: {}", path.string(), doing, std::strerror(errno)));
}

}  // namespace landfix::platform
