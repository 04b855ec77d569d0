// A case in a process of its own: its memory is given back, its time is its own, and if it fails the others
// go on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <sys/types.h>

#include "tools/study/figures.hpp"

namespace landfix::tools::study {

struct CaseResult {
  Case one{};
  std::optional<CaseFigures> figures{};  ///< nothing: it failed
  std::string error{};                   ///< why
  bool is_old = false;                   ///< done in an earlier run
};

class CaseProcess {
 public:
  /// Throws std::runtime_error where it cannot begin.
  CaseProcess(Case one, std::filesystem::path folder);
  CaseProcess(CaseProcess&& other) noexcept;
  CaseProcess& operator=(CaseProcess&& other) noexcept;
  CaseProcess(const CaseProcess&) = delete;
  CaseProcess& operator=(const CaseProcess&) = delete;
  /// Stops what is not done.
  ~CaseProcess();

  [[nodiscard]] const Case& one() const noexcept { return one_; }
  /// What came of it, once it has ended.
  [[nodiscard]] std::optional<CaseResult> poll();

 private:
  void stop() noexcept;
  [[nodiscard]] CaseResult result_of(int status) const;

  Case one_;
  std::filesystem::path folder_;
  pid_t pid_ = -1;  ///< -1: none
};

}  // namespace landfix::tools::study
