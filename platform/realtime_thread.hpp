// A thread whose stack is all there before it begins: of a stated size, touched, locked where that is
// allowed, with a page below it that catches an overflow.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <semaphore>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pthread.h>

#include "platform/realtime.hpp"

namespace landfix::platform {

#ifdef __SANITIZE_THREAD__  // which keeps near 1 MB of its own on every stack
inline constexpr std::size_t kRealtimeStack_bytes = std::size_t{4} << 20;
#else
inline constexpr std::size_t kRealtimeStack_bytes = std::size_t{256} * 1024;
#endif

struct RealtimeThreadSettings {
  std::string name;  ///< at most 15 characters; seen in `top -H`
  ThreadSchedule schedule{};
  std::size_t stack_bytes = kRealtimeStack_bytes;  ///< whole pages
  bool flushes_denormals = false;
};

class RealtimeThread {
 public:
  /// Runs `function` once everything is set up, or as much of it as is allowed. The function has to return
  /// when it is told to, by whatever it looks at: the destructor waits for it. Throws std::runtime_error
  /// where there is no memory or no thread to be had.
  template <class Function>
  requires std::is_nothrow_invocable_v<Function&> RealtimeThread(const RealtimeThreadSettings& settings,
                                                                 Function function)
      : RealtimeThread(settings, std::function<void()>(std::move(function))) {}
  ~RealtimeThread();
  RealtimeThread(const RealtimeThread&) = delete;
  RealtimeThread& operator=(const RealtimeThread&) = delete;

  /// What of the settings it does without, a sentence each.
  [[nodiscard]] const std::vector<std::string>& missing() const noexcept { return missing_; }
  [[nodiscard]] std::size_t stack_bytes() const noexcept { return stack_.get_deleter().stack_bytes; }

 private:
  struct UnmapStack {
    std::size_t stack_bytes = 0;
    void operator()(std::byte* guard_page) const noexcept;
  };
  using Stack = std::unique_ptr<std::byte, UnmapStack>;

  RealtimeThread(const RealtimeThreadSettings& settings, std::function<void()> function);
  static Stack map_stack(std::size_t stack_bytes);
  static void* run(void* thread);

  std::function<void()> function_;
  bool flushes_denormals_;
  Stack stack_;  ///< begins with the guard page
  std::vector<std::string> missing_;
  std::binary_semaphore is_set_up_{0};
  pthread_t id_{};
};

}  // namespace landfix::platform
