// The message that something throws, to be held against what its user should read.
#pragma once

#include <stdexcept>
#include <string>

namespace landfix::test {

/// "no error" where `call` throws none; its result is dropped.
template <class Call>
[[nodiscard]] std::string error_of(Call call) {
  try {
    static_cast<void>(call());
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace landfix::test
