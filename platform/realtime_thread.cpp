#include "platform/realtime_thread.hpp"

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace landfix::platform {
namespace {

std::size_t page_bytes() { return static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)); }

[[noreturn]] void fail(const char* what, int error) {
  throw std::runtime_error(fmt::format("{}: {}", what, std::strerror(error)));
}

/// The attributes of a thread with the given stack.
class Attributes {
 public:
  explicit Attributes(std::byte* stack, std::size_t stack_bytes) {
    ::pthread_attr_init(&attributes_);
    error_ = ::pthread_attr_setstack(&attributes_, stack, stack_bytes);
  }
  ~Attributes() { ::pthread_attr_destroy(&attributes_); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;

  [[nodiscard]] int error() const noexcept { return error_; }
  [[nodiscard]] const pthread_attr_t* get() const noexcept { return &attributes_; }

 private:
  pthread_attr_t attributes_{};
  int error_;
};

}  // namespace

void RealtimeThread::UnmapStack::operator()(std::byte* guard_page) const noexcept {
  ::munmap(guard_page, page_bytes() + stack_bytes);
}

RealtimeThread::Stack RealtimeThread::map_stack(std::size_t stack_bytes) {
  const std::size_t guard_bytes = page_bytes();
  stack_bytes = (stack_bytes + guard_bytes - 1) / guard_bytes * guard_bytes;
  void* const memory = ::mmap(nullptr, guard_bytes + stack_bytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
  if (memory == MAP_FAILED) fail("no memory for a thread's stack", errno);
  Stack stack(static_cast<std::byte*>(memory), UnmapStack{stack_bytes});
  if (::mprotect(memory, guard_bytes, PROT_NONE) != 0) fail("no guard page below a thread's stack", errno);
  std::memset(stack.get() + guard_bytes, 0, stack_bytes);
  // lock_memory() says it where this is not allowed.
  (void)::mlock(stack.get() + guard_bytes, stack_bytes);
  return stack;
}

RealtimeThread::RealtimeThread(const RealtimeThreadSettings& settings, std::function<void()> function)
    : function_(std::move(function)),
      flushes_denormals_(settings.flushes_denormals),
      stack_(map_stack(settings.stack_bytes)) {
  const Attributes attributes(stack_.get() + page_bytes(), stack_bytes());
  if (attributes.error() != 0) fail("unusable size of a thread's stack", attributes.error());
  const int error = ::pthread_create(&id_, attributes.get(), run, this);
  if (error != 0) fail("cannot start a thread", error);
  ::pthread_setname_np(id_, settings.name.c_str());
  for (Missing missing : {set_priority(id_, settings.name, settings.schedule.priority),
                          set_core(id_, settings.name, settings.schedule.core)}) {
    if (missing) missing_.push_back(*std::move(missing));
  }
  is_set_up_.release();
}

RealtimeThread::~RealtimeThread() { ::pthread_join(id_, nullptr); }

void* RealtimeThread::run(void* thread) {
  RealtimeThread& self = *static_cast<RealtimeThread*>(thread);
  use_precise_timers();
  if (self.flushes_denormals_) flush_denormals();
  self.is_set_up_.acquire();
  self.function_();
  return nullptr;
}

}  // namespace landfix::platform
