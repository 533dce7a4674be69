#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "tools/evaluate/metrics/detection_metrics.hpp"

namespace houghstream {

using Points = std::vector<Eigen::Vector3f>;

// A pose is correct where its strict error is below a tenth of the diameter: texture counts. Where ADD-S alone is, the
// pose is correct up to what the shape cannot tell: a box turned front for back.

constexpr double kCorrectBelow = 0.1;  ///< error of a correct pose, diameters (Hinterstoisser et al. 2012)

/// Returns ADD (Hinterstoisser et al. 2012): mean distance in metres of the model's points under the two poses.
double add_error(const Points& model, const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth);

/// Returns ADD-S (Hinterstoisser et al. 2012): mean distance in metres from each point under the true pose to the
/// nearest point under the estimated one; blind to symmetries.
double add_s_error(const Points& model, const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth);

/// Model of a class for pose errors.
struct PoseModel {
  Points points;          ///< on the surface, object frame, metres
  double diameter = 0.0;  ///< metres
  /// The motions after which a pose is the same, as the dataset lists them, expanded; the identity is among them.
  std::vector<Eigen::Isometry3d> symmetries = {Eigen::Isometry3d::Identity()};

  bool is_symmetric() const { return symmetries.size() > 1; }
};

/// Makes a model of evenly spread points instead of the mesh's vertices, which crowd where a mesh is finely cut.
/// `symmetries` are those of models_info.json, not those of the shape: texture tells poses apart that the shape does
/// not.
PoseModel make_pose_model(const Mesh& mesh, const Symmetries& symmetries);

/// Returns the error by which a pose is correct or not, metres: MSSD (Hodan et al. 2020) over the model's points where
/// the dataset lists symmetries of the object, else ADD.
double strict_error(const PoseModel& model, const Eigen::Isometry3d& T_estimated,
                    const Eigen::Isometry3d& T_ground_truth);
bool is_correct(const PoseModel& model, const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth);
/// Returns whether a pose is correct by ADD-S.
bool is_correct_up_to_shape(const PoseModel& model, const Eigen::Isometry3d& T_estimated,
                            const Eigen::Isometry3d& T_ground_truth);

/// A true detection and the pose that was published for it.
struct JudgedPose {
  std::size_t frame = 0;
  std::string class_name;
  double visible_fraction = 0.0;
  PoseStatus status = PoseStatus::kInvalid;
  double strict = std::numeric_limits<double>::quiet_NaN();  ///< strict_error(), metres; NaN without a pose
  double add = std::numeric_limits<double>::quiet_NaN();     ///< metres; NaN without a pose
  double add_s = std::numeric_limits<double>::quiet_NaN();   ///< metres; NaN without a pose
  float score = 0.0F;                                        ///< score of the detection
  float quality = 0.0F;                                      ///< quality of the pose, also of one that was withheld
  bool reported = true;                                      ///< false: a candidate without a published pose
  std::string scene;
  int image_id = 0;
};

/// Returns the poses of all true detections of a class; in a frame for which no poses were published, none has one.
/// Objects whose truth has no pose are left out.
std::vector<JudgedPose> match_poses(const std::vector<EvaluatedFrame>& frames, const ClassResult& detections,
                                    const PoseModel& model);

/// Predicted probabilities that a pose is correct, and correct up to its shape.
struct PosePrediction : Prediction {
  bool is_correct_up_to_shape = false;
  double confidence_up_to_shape = 0.0;  ///< ObjectPose::shape_quality
};

/// Returns the poses of a class with their quality, those of true and of false detections: true where the detection is
/// and the pose is correct. Those of ignored detections, and of objects whose truth has no pose, are left out.
std::vector<PosePrediction> pose_predictions(const std::vector<EvaluatedFrame>& frames, const ClassResult& detections,
                                             const PoseModel& model);

/// Returns the fraction of the true detections of objects at least `min_visible` visible whose pose is correct; a
/// detection without a pose has none. NaN where there is no such detection.
double strict_recall(const std::vector<JudgedPose>& poses, double diameter, double min_visible);

/// Returns the recall of poses that are correct by ADD-S (up to the ambiguity of the shape), as strict_recall() does.
double add_s_recall(const std::vector<JudgedPose>& poses, double diameter, double min_visible);

/// Returns the recall of poses that are correct by ADD(-S): ADD, but ADD-S for symmetric objects (Hinterstoisser et al.
/// 2012).
double add_or_add_s_recall(const std::vector<JudgedPose>& poses, const PoseModel& model, double min_visible);

}  // namespace houghstream
