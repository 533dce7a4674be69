#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// State of the teaching of an object from a camera. Values are those of teaching_t.
enum class TeachingState : std::int8_t {
  kInvalid = 0,
  kChoosing = 1,  ///< looks for the object that is meant
  kTracking = 2,  ///< follows it, and learns its shape
  kLost = 3,      ///< has lost it, and looks for it
  kFusing = 4,    ///< makes its model
  kTraining = 5,  ///< teaches the model to the store
  kDone = 6,      ///< the store knows it
  kFailed = 7,    ///< it was not taught; the message has the reason
};

/// Returns one word for people.
const char* to_string(TeachingState state);

/// A direction from which an object can be seen.
struct ViewDirection {
  Eigen::Vector3f direction = Eigen::Vector3f::UnitZ();  ///< unit vector in the object's frame, away from the object
  bool seen = false;
};

/// Progress of the teaching of an object that is shown to a camera.
struct Teaching {
  FrameId frame;  ///< last frame with box and pose; its channel is empty where it is not from the bus
  std::string name;
  TeachingState state = TeachingState::kInvalid;
  std::string message;            ///< event, or the next step of the user, one line
  std::optional<float> progress;  ///< fraction of the state's work that is done, 0 to 1; nothing = unknown
  int frames = 0;                 ///< processed frames
  int keyframes = 0;              ///< keyframes whose views will be taught
  std::optional<cv::Rect2f> box_px;
  std::optional<Eigen::Isometry3d> T_camera_object;
  std::vector<ViewDirection> directions;  ///< evenly over the sphere
};

/// Returns the number of directions that are covered.
int count_covered(const Teaching& teaching);

// The names of before, for one release.
using SeenDirection [[deprecated("is ViewDirection now")]] = ViewDirection;

}  // namespace houghstream
