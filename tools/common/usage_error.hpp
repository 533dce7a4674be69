#pragma once

#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream {

/// Reports words of the command line that do not go together, or one that is missing. run_tool() ends with status 2
/// for it, as for an option that is unknown.
struct UsageError : InputError {
  using InputError::InputError;
};

/// Throws UsageError with a formatted line unless `ok`.
template <typename... Args>
void require_usage(bool ok, fmt::format_string<Args...> format, Args&&... args) {
  if (!ok) throw UsageError(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace houghstream
