#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "pipeline/types/object_pose.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

/// Reports two cameras that see the same objects at different positions.
struct ExtrinsicInconsistency {
  std::string first;                                   ///< channel of a camera
  std::string second;                                  ///< channel of another camera
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();  ///< vector from the first camera's positions to the second's
  int samples = 0;
};

/// Compares where cameras see the same objects at about the same time, to find cameras whose extrinsics
/// contradict each other. It knows nothing of tracks, and compares the cameras' poses directly. Not thread-safe.
class ExtrinsicCheck {
 public:
  /// Minimum offset that is reported: twice the difference of good poses of a can or a mug from two sides.
  static constexpr double kReport_m = 0.012;

  /// Adds the poses of a frame, in the world. Objects with a model are compared by its centre, the others by their
  /// origin.
  void add(const ObjectPoses& poses, const Eigen::Isometry3d& T_world_camera, const TrackModels& models);

  /// Returns pairs of cameras whose median offset over the last samples is too large, by their names.
  std::vector<ExtrinsicInconsistency> inconsistencies() const;

  /// Returns all pairs that have enough samples, for a report.
  std::vector<ExtrinsicInconsistency> pairs() const;

 private:
  struct ObservedObject {
    std::string class_name;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  };
  struct View {
    std::int64_t utime = 0;
    std::vector<ObservedObject> objects;
  };
  std::map<std::string, View> last_;  // last view by channel
  std::map<std::pair<std::string, std::string>, std::deque<Eigen::Vector3d>> offsets_;
};

}  // namespace houghstream::tracks
