// The gate must see that something is given back to the heap, also through C.
#include <cstdlib>

namespace landfix::test {

void frees(int* value) { std::free(value); }

}  // namespace landfix::test
