#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pose/model/object_model.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// Gives the class and pose of an object.
struct PlacedObject {
  const std::string& class_name;
  const Eigen::Isometry3d& T_camera_object;
};

/// Refines detections to 6-DoF poses: candidates from the votes, registration to the measured depth, verification
/// against the rendered model.
///
/// Keeps nothing from frame to frame, so that estimate() may be called from several threads at once. A frame's stages
/// follow one another, each for all detections on PoseSettings::threads threads: what a stage found lies in the call's
/// own memory, and its time is what passed on the wall.
class PoseEstimator {
 public:
  /// Models by class name, in metres, in the object frame of the training views. What registration needs of them is
  /// made on `threads` threads, the same for any number. Throws InputError as make_object_model() does, and for
  /// settings out of their range.
  PoseEstimator(std::map<std::string, Mesh> models, PoseSettings settings, int threads = 1);
  /// Makes an estimator of models that were made before with settings.model.
  static PoseEstimator from_models(std::map<std::string, ObjectModel> models, PoseSettings settings);
  ~PoseEstimator();
  PoseEstimator(PoseEstimator&&) noexcept;

  /// Returns the models by class name.
  const std::map<std::string, ObjectModel>& models() const;
  const PoseSettings& settings() const;

  /// Returns one ObjectPose per detection, in their order; the times of the stages pose.region, pose.candidates,
  /// pose.registration, pose.choice, pose.verification and pose.print are appended to those of the detections. The
  /// detections must be of this frame (same name). Of two poses of one object (is_same_object) the less probable one is
  /// withheld (withhold_duplicate). Weak detections (Detection::reported is false) are estimated last: one whose
  /// surface a published pose explains is no object of its own, and is given up with the status kRefuted. Throws
  /// std::logic_error for another frame, and InputError for an invalid frame.
  ObjectPoses estimate(const RgbdFrame& frame, const Detections& detections) const;

  /// Estimates with the poses of an earlier frame as a warm start: they are candidates beside those of the votes, never
  /// the only ones, so that a wrong pose does not persist and a lost object is found again. Where the best candidate
  /// continues a sure pose (find_continued), its alternatives by shape are searched again after some frames only. A
  /// weak detection that was rejected there is rejected again without a search, for a while (find_rejected).
  /// `remembered` holds the camera's colours learnt from earlier frames (CameraColours::pairs). `known` holds poses of
  /// this frame that are known otherwise, followed ones for instance: what they explain is no weak detection's.
  ObjectPoses estimate(const RgbdFrame& frame, const Detections& detections, const ObjectPoses& earlier,
                       const std::vector<ChromaPair>& remembered = {}, const ObjectPoses& known = {}) const;

  /// Returns where a detection of the object would have its centre, camera frame, metres; its origin where the class
  /// has no model.
  Eigen::Vector3d vote_centre(const PlacedObject& object) const;

  /// Returns whether the centres of two objects are closer than PoseSettings::duplicate_distance_ratio times the
  /// smaller radius, so that one is a duplicate. False where a class has no model.
  bool is_duplicate(const PlacedObject& a, const PlacedObject& b) const;
  /// Returns whether two poses in a frame are of one object: of one class, whether they are duplicates; of two classes,
  /// whether they explain the same surface by more than PoseSettings::max_shared_surface. What lies in a bowl is not
  /// the bowl, though their centres may coincide.
  bool is_same_object(const RgbdFrame& frame, const PlacedObject& a, const PlacedObject& b) const;
  [[deprecated("takes PoseSettings::duplicate_distance_ratio now")]] bool is_duplicate(const PlacedObject& a,
                                                                                       const PlacedObject& b,
                                                                                       double max_distance_ratio) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Withholds the less probable pose of one object: it has none then. Its status is kLowScore where the other one is of
/// its class, and kRefuted where the surface is another class's.
void withhold_duplicate(const ObjectPose& other, ObjectPose& pose);

}  // namespace houghstream
