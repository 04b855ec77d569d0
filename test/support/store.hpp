// Fields of packets that tests write, in the order of this computer, which is little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace landfix::test {

inline void store(std::byte* at, std::uint64_t value, std::size_t bytes) { std::memcpy(at, &value, bytes); }

}  // namespace landfix::test
