#include "pipeline/types/tracked_object.hpp"

namespace houghstream {

const char* to_string(TrackState state) {
  switch (state) {
    case TrackState::kInvalid: return "invalid";
    case TrackState::kVisible: return "visible";
    case TrackState::kUnrecognised: return "unrecognised";
    case TrackState::kHidden: return "hidden";
    case TrackState::kOutOfView: return "out of view";
    case TrackState::kGone: return "gone";
  }
  return "unknown state";
}

}  // namespace houghstream
