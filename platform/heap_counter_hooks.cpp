// The library landfix_heap_counter: the functions of the heap, and the lock of a mutex, which count and hand
// on to those of glibc. Not <cstdlib>: clang-tidy would hold its reserved parameter names against ours.
#include <cerrno>
#include <cstddef>

#include <dlfcn.h>
#include <pthread.h>

#include "platform/heap_counter.hpp"

#if defined(__has_feature)
#define LANDFIX_HAS_FEATURE(feature) __has_feature(feature)
#else
#define LANDFIX_HAS_FEATURE(feature) 0
#endif

// The sanitizers bring a heap of their own.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && \
    !LANDFIX_HAS_FEATURE(address_sanitizer) && !LANDFIX_HAS_FEATURE(thread_sanitizer) &&     \
    !LANDFIX_HAS_FEATURE(memory_sanitizer)

using landfix::platform::HeapCounter;

namespace {
[[maybe_unused]] const bool is_available = (HeapCounter::make_available(), true);
}  // namespace

// glibc exports these names for exactly this use.
// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)
extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);

void* malloc(std::size_t size) noexcept {
  HeapCounter::count();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  HeapCounter::count();
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
  HeapCounter::count();
  return __libc_realloc(memory, size);
}

void free(void* memory) noexcept {
  if (memory != nullptr) HeapCounter::count();
  __libc_free(memory);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  HeapCounter::count();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  HeapCounter::count();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  HeapCounter::count();
  void* const result = __libc_memalign(alignment, size);
  if (result == nullptr) return ENOMEM;
  *memory = result;
  return 0;
}

/// glibc's, which it exports under this name alone.
static int (*const lock_of_glibc)(pthread_mutex_t*) =
    reinterpret_cast<int (*)(pthread_mutex_t*)>(::dlsym(RTLD_NEXT, "pthread_mutex_lock"));

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  HeapCounter::count_lock();
  if (lock_of_glibc != nullptr) return lock_of_glibc(mutex);
  // Before main, while other static objects are made; there are no other threads yet.
  return ::pthread_mutex_trylock(mutex);
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)

#endif
