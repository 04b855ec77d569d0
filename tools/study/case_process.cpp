#include "tools/study/case_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/study/case_run.hpp"
#include "tools/study/case_store.hpp"

namespace landfix::tools::study {
namespace {

constexpr const char* kError = "error.txt";
constexpr const char* kLog = "log.txt";

/// In the child: its exit code. Nothing may get out of here, or the parent's work would be done twice.
[[nodiscard]] int work(const Case& one, const std::filesystem::path& folder) noexcept {
  try {
    try {
      store_figures(one, run_case(one, folder), folder);
      return 0;
    } catch (const std::exception& error) {
      std::ofstream(folder / kError) << error.what();
    }
  } catch (...) {
    return 2;  // and no room for the reason
  }
  return 1;
}

}  // namespace

CaseProcess::CaseProcess(Case one, std::filesystem::path folder)
    : one_(std::move(one)), folder_(std::move(folder)) {
  make_room(folder_);
  const pid_t parent = ::getpid();
  std::fflush(nullptr);  // or the child would write it once more
  pid_ = ::fork();
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), "cannot start a process");
  if (pid_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(1);
  // Progress and warnings of several would be one muddle.
  if (std::freopen((folder_ / kLog).c_str(), "w", stderr) == nullptr) ::_exit(1);
  ::_exit(work(one_, folder_));
}

CaseProcess::CaseProcess(CaseProcess&& other) noexcept
    : one_(std::move(other.one_)), folder_(std::move(other.folder_)), pid_(std::exchange(other.pid_, -1)) {}

CaseProcess& CaseProcess::operator=(CaseProcess&& other) noexcept {
  if (this == &other) return *this;
  stop();
  one_ = std::move(other.one_);
  folder_ = std::move(other.folder_);
  pid_ = std::exchange(other.pid_, -1);
  return *this;
}

CaseProcess::~CaseProcess() { stop(); }

void CaseProcess::stop() noexcept {
  if (pid_ < 0) return;
  ::kill(pid_, SIGTERM);
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

std::optional<CaseResult> CaseProcess::poll() {
  int status = 0;
  const pid_t ended = ::waitpid(pid_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return std::nullopt;
  // Where somebody ignores SIGCHLD nobody is told the status: what lies in the folder says it.
  pid_ = -1;
  return result_of(status);
}

CaseResult CaseProcess::result_of(int status) const {
  CaseResult result{.one = one_};
  if (WIFSIGNALED(status)) {
    result.error = fmt::format("stopped by signal {}{}", WTERMSIG(status),
                               WTERMSIG(status) == SIGKILL ? ", perhaps for want of memory" : "");
    return result;
  }
  result.figures = load_figures(one_, folder_);
  if (result.figures) return result;
  std::ifstream file(folder_ / kError);
  result.error.assign(std::istreambuf_iterator<char>(file), {});
  if (result.error.empty()) result.error = "it left no reason; is the disk full?";
  return result;
}

}  // namespace landfix::tools::study
