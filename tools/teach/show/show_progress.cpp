#include "tools/teach/show/show_progress.hpp"

namespace houghstream::teach {

const char* name_of(ShowState state) {
  switch (state) {
    case ShowState::kChoosing: return "choosing";
    case ShowState::kTracking: return "tracking";
    case ShowState::kLost: return "lost";
    case ShowState::kFusing: return "fusing";
    case ShowState::kTraining: return "training";
    case ShowState::kDone: return "done";
    case ShowState::kFailed: break;
  }
  return "failed";
}

}  // namespace houghstream::teach
