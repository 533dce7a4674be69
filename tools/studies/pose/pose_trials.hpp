#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/geometry/symmetry.hpp"
#include "pipeline/types/object_pose.hpp"
#include "tools/evaluate/metrics/average_recall.hpp"
#include "tools/evaluate/metrics/pose_metrics.hpp"

namespace houghstream {

/// Holds the result of one detection's pose compared with the ground truth; unknown numbers are NaN.
struct PoseTrial {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::string scene;
  std::size_t image = 0;  ///< position in the scene's images
  std::string class_name;
  int class_id = 0;
  float score = 0.0F;  ///< score of the detection
  cv::Rect2f box_px;   ///< box of the detection
  MatchOutcome outcome = MatchOutcome::kFalsePositive;
  bool symmetric = false;              ///< the object looks the same in other poses
  double visible_fraction = kUnknown;  ///< fraction of the object; known for true detections
  double distance_m = kUnknown;        ///< distance of the object along the optical axis; known for true detections
  double ms = kUnknown;                ///< CPU time of the pose, or of finding none (TimedPoses)
  PoseStatus status = PoseStatus::kInvalid;
  float quality = 0.0F;                              ///< ObjectPose::quality; 0 for the baselines
  std::optional<Eigen::Isometry3d> T_camera_object;  ///< metres; present exactly when status is kValid

  // Errors of the pose, unknown without one and without an object to compare it with: that of a true detection, for
  // others the object of the class of smallest ADD-S.
  double strict = kUnknown;  ///< strict_error(): MSSD, or ADD of an object without symmetries; in diameters
  double add = kUnknown;     ///< error in diameters
  double add_s = kUnknown;   ///< error in diameters
  double shift_m = kUnknown;
  double angle_deg = kUnknown;  ///< the smallest over the object's symmetries

  /// Returns whether the pose of a true detection is correct.
  bool is_correct() const { return outcome == MatchOutcome::kTruePositive && strict < kCorrectBelow; }
  bool is_correct_up_to_shape() const { return outcome == MatchOutcome::kTruePositive && add_s < kCorrectBelow; }
};

/// Models for the comparison of a class' poses with the ground truth.
struct ScoredModel {
  PoseModel surface;
  Symmetries symmetries;
};

/// The models of a scene by class name, metres.
struct SceneModels {
  std::map<std::string, Mesh> meshes;
  std::map<std::string, BopModel> bop;
  std::map<std::string, ScoredModel> scored;
};

/// Loads the models of the listed classes. Throws InputError for a folder that is no models/ of a BOP dataset, or that
/// has none of them.
SceneModels load_scene_models(const std::filesystem::path& models, const std::set<std::string>& classes);

/// Frames of a scene with detections and poses, one pose for each detection in their order.
struct PoseRun {
  std::string scene;
  std::vector<EvaluatedFrame> frames;
  std::vector<std::vector<double>> ms;  ///< times by frame and detection
};

/// Matches all detections that count, of the classes with a model; those of objects whose ground truth has no pose are
/// left out. They are ordered by class, then strongest first, so that the order is the same for all estimators.
std::vector<PoseTrial> match_run(const PoseRun& run, const std::map<std::string, ScoredModel>& models);

}  // namespace houghstream
