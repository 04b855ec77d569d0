// Runs a function in a process of its own: one that gives up rights, locks memory or dies.
#pragma once

#include <cstdlib>
#include <string>

#include <grp.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace landfix::test {

/// What the function returned in a child of this process, as text.
template <class Function>
[[nodiscard]] std::string in_child(Function function) {
  int ends[2];
  if (::pipe(ends) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string text = function();
    const ssize_t written = ::write(ends[1], text.data(), text.size());
    ::_exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t size = 0; (size = ::read(ends[0], buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(size));
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  return status == 0 ? text : text + " (the child failed)";
}

/// For a child: no priority, no locked memory, no other right, as an ordinary user.
inline void give_up_rights() {
  constexpr rlimit kNothing{0, 0};
  ::setrlimit(RLIMIT_RTPRIO, &kNothing);
  ::setrlimit(RLIMIT_MEMLOCK, &kNothing);
  constexpr uid_t kNobody = 65534;
  if (::geteuid() == 0 && (::setgroups(0, nullptr) != 0 || ::setresgid(kNobody, kNobody, kNobody) != 0 ||
                           ::setresuid(kNobody, kNobody, kNobody) != 0)) {
    ::_exit(2);
  }
}

}  // namespace landfix::test
