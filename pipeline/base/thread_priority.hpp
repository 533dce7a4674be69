#pragma once

#include <string>

namespace houghstream {

/// Lowers the priority of what people look at below the stream's: on a busy machine it is late, results are not. On
/// Linux this holds for the calling thread and those that it starts later. A warning names the `work` whose priority
/// cannot be lowered.
void yield_to_results(const std::string& work);

}  // namespace houghstream
