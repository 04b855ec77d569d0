// The gate must see an exception, also where only the standard library throws it.
#include <array>
#include <cstddef>

namespace landfix::test {

int throws(const std::array<int, 3>& values, std::size_t index) { return values.at(index); }

}  // namespace landfix::test
