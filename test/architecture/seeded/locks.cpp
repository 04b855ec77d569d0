// The gate must see a lock.
#include <mutex>

namespace landfix::test {

void locks(std::mutex& mutex) { const std::lock_guard<std::mutex> guard(mutex); }

}  // namespace landfix::test
