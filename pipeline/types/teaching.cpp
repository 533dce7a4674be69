#include "pipeline/types/teaching.hpp"

#include <algorithm>

namespace houghstream {

const char* to_string(TeachingState state) {
  switch (state) {
    case TeachingState::kInvalid: return "invalid";
    case TeachingState::kChoosing: return "choosing";
    case TeachingState::kTracking: return "tracking";
    case TeachingState::kLost: return "lost";
    case TeachingState::kFusing: return "fusing";
    case TeachingState::kTraining: return "training";
    case TeachingState::kDone: return "done";
    case TeachingState::kFailed: return "failed";
  }
  return "unknown state";
}

int count_covered(const Teaching& teaching) {
  return static_cast<int>(std::count_if(teaching.directions.begin(), teaching.directions.end(),
                                        [](const ViewDirection& direction) { return direction.seen; }));
}

}  // namespace houghstream
