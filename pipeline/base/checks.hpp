#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace houghstream {

/// Reports bad input from outside: a file, a message, an argument. `what()` is one line that names the source, the
/// value found and what was expected. Mains print it and return 1; stream processes count it and continue.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws InputError with a formatted line.
template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw InputError(fmt::format(format, std::forward<Args>(args)...));
}

/// Throws InputError with a formatted line unless `ok`.
template <typename... Args>
void require(bool ok, fmt::format_string<Args...> format, Args&&... args) {
  if (!ok) fail(format, std::forward<Args>(args)...);
}

}  // namespace houghstream
