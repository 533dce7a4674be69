#include "pipeline/base/thread_priority.hpp"

#include <unistd.h>

#include "pipeline/base/log_line.hpp"

namespace houghstream {

void yield_to_results(const std::string& work) {
  constexpr int kPolite = 15;
  if (nice(kPolite) == -1) log_warning("the priority of {} cannot be lowered", work);
}

}  // namespace houghstream
