#include "tools/study/study_run.hpp"

#include <chrono>
#include <exception>
#include <map>
#include <thread>
#include <utility>

#include "tools/study/case_store.hpp"

namespace landfix::tools::study {
namespace {

using Working = std::map<std::size_t, CaseProcess>;  ///< by the number of the case

/// Waits until one is done, and takes it out.
[[nodiscard]] std::pair<std::size_t, CaseResult> next_result(Working& working,
                                                             const StudyProgress& progress) {
  constexpr std::chrono::milliseconds kNap(200);
  for (;; std::this_thread::sleep_for(kNap)) {
    std::vector<std::string> names;
    for (auto& [number, process] : working) {
      names.push_back(process.one().name());
      auto result = process.poll();
      if (!result) continue;
      const std::size_t done = number;
      working.erase(done);
      return {done, std::move(*result)};
    }
    progress.on_wait(names);
  }
}

}  // namespace

std::vector<CaseResult> run_cases(std::span<const Case> cases, const std::filesystem::path& folder,
                                  std::size_t at_once, const StudyProgress& progress) {
  std::vector<CaseResult> results(cases.size());
  Working working;
  const auto take = [&](std::size_t number, CaseResult result) {
    results[number] = std::move(result);
    progress.on_result(results[number]);
  };
  const auto take_next = [&] {
    auto [number, result] = next_result(working, progress);
    take(number, std::move(result));
  };
  for (std::size_t number = 0; number < cases.size(); ++number) {
    const Case& one = cases[number];
    if (auto known = load_figures(one, folder / one.name())) {
      take(number, {.one = one, .figures = std::move(known), .is_old = true});
      continue;
    }
    if (working.size() == at_once) take_next();
    try {
      working.emplace(number, CaseProcess(one, folder / one.name()));
    } catch (const std::exception& error) {
      take(number, {.one = one, .error = error.what()});
    }
  }
  while (!working.empty()) take_next();
  return results;
}

}  // namespace landfix::tools::study
