// Commands that a test runs in the guest, and those that listen while it goes on.
#pragma once

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace landfix::test {

/// Throws the test out where the command fails.
inline void run(const std::string& command) {
  const int status = std::system(command.c_str());
  if (status != 0) throw std::runtime_error(command + " failed with status " + std::to_string(status));
}

/// A shell command in the background, ended with the test.
class Background {
 public:
  explicit Background(const std::string& command) : process_(::fork()) {
    if (process_ != 0) return;
    ::execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
    ::_exit(127);
  }
  ~Background() { stop(); }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Whether it has ended by itself.
  [[nodiscard]] bool has_ended() {
    if (process_ > 0 && ::waitpid(process_, &status_, WNOHANG) == process_) process_ = -1;
    return process_ <= 0;
  }
  /// As of a shell; -1 where a signal ended it.
  [[nodiscard]] int exit_code() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }

  void stop() {
    if (process_ <= 0) return;
    ::kill(process_, SIGINT);
    ::waitpid(process_, &status_, 0);
    process_ = -1;
  }

 private:
  pid_t process_;
  int status_ = 0;
};

}  // namespace landfix::test
