#include "tools/evaluate/metrics/pose_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pose/model/symmetry.hpp"
#include "tools/evaluate/metrics/bop_errors.hpp"

namespace houghstream {
namespace {

Points transformed(const Points& points, const Eigen::Isometry3d& T) {
  const Eigen::Isometry3f T_float = T.cast<float>();
  Points out;
  out.reserve(points.size());
  for (const Eigen::Vector3f& point : points) out.emplace_back(T_float * point);
  return out;
}

double recall(const std::vector<JudgedPose>& poses, double JudgedPose::*error, double diameter, double min_visible) {
  int counted = 0;
  int good = 0;
  for (const JudgedPose& pose : poses) {
    if (pose.visible_fraction < min_visible) continue;
    ++counted;
    good += pose.*error < kCorrectBelow * diameter ? 1 : 0;  // false for NaN
  }
  return counted > 0 ? static_cast<double>(good) / counted : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double add_error(const Points& model, const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth) {
  const Points estimated = transformed(model, T_estimated);
  const Points truth = transformed(model, T_ground_truth);
  double sum = 0.0;
  for (std::size_t i = 0; i < model.size(); ++i) sum += static_cast<double>((estimated[i] - truth[i]).norm());
  return sum / static_cast<double>(model.size());
}

double add_s_error(const Points& model, const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth) {
  const Points estimated = transformed(model, T_estimated);
  double sum = 0.0;
  for (const Eigen::Vector3f& point : transformed(model, T_ground_truth)) {
    float nearest_sq = std::numeric_limits<float>::infinity();
    for (const Eigen::Vector3f& other : estimated) nearest_sq = std::min(nearest_sq, (other - point).squaredNorm());
    sum += std::sqrt(static_cast<double>(nearest_sq));
  }
  return sum / static_cast<double>(model.size());
}

PoseModel make_pose_model(const Mesh& mesh, const Symmetries& symmetries) {
  constexpr int kPoints = 1000;
  constexpr std::uint64_t kSeed = 1;
  return {sample_surface(mesh, kPoints, kSeed).points, mesh_diameter(mesh), expand_symmetries(symmetries)};
}

double strict_error(const PoseModel& model, const Eigen::Isometry3d& T_estimated,
                    const Eigen::Isometry3d& T_ground_truth) {
  return model.is_symmetric() ? mssd_error(model.points, model.symmetries, T_estimated, T_ground_truth)
                              : add_error(model.points, T_estimated, T_ground_truth);
}

bool is_correct(const PoseModel& model, const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth) {
  return strict_error(model, T_estimated, T_ground_truth) < kCorrectBelow * model.diameter;
}

bool is_correct_up_to_shape(const PoseModel& model, const Eigen::Isometry3d& T_estimated,
                            const Eigen::Isometry3d& T_ground_truth) {
  return add_s_error(model.points, T_estimated, T_ground_truth) < kCorrectBelow * model.diameter;
}

std::vector<JudgedPose> match_poses(const std::vector<EvaluatedFrame>& frames, const ClassResult& detections,
                                    const PoseModel& model) {
  std::vector<JudgedPose> judged;
  for (const MatchedDetection& detection : detections.judged) {
    const EvaluatedFrame& frame = frames[detection.frame];
    if (detection.outcome != MatchOutcome::kTruePositive) continue;
    const GroundTruthObject& truth = frame.objects[detection.object].truth;
    if (!truth.has_pose) continue;
    JudgedPose row;
    row.frame = detection.frame;
    row.class_name = detections.class_name;
    row.visible_fraction = truth.visible_fraction;
    row.score = detection.score;
    row.reported = !detection.is_candidate || detection.has_pose;
    row.scene = frame.scene;
    row.image_id = frame.image_id;
    const ObjectPose* pose = frame.poses ? find_pose(*frame.poses, detection.index) : nullptr;
    if (pose != nullptr) {
      row.status = pose->status;
      row.quality = pose->quality;
    }
    if (pose != nullptr && pose->T_camera_object) {
      row.strict = strict_error(model, *pose->T_camera_object, truth.T_camera_object);
      row.add = add_error(model.points, *pose->T_camera_object, truth.T_camera_object);
      row.add_s = add_s_error(model.points, *pose->T_camera_object, truth.T_camera_object);
    }
    judged.push_back(row);
  }
  std::stable_sort(judged.begin(), judged.end(),
                   [](const JudgedPose& a, const JudgedPose& b) { return a.frame < b.frame; });
  return judged;
}

std::vector<PosePrediction> pose_predictions(const std::vector<EvaluatedFrame>& frames, const ClassResult& detections,
                                             const PoseModel& model) {
  std::vector<PosePrediction> statements;
  for (const MatchedDetection& detection : detections.judged) {
    const EvaluatedFrame& frame = frames[detection.frame];
    const ObjectPose* pose = frame.poses ? find_pose(*frame.poses, detection.index) : nullptr;
    if (detection.outcome == MatchOutcome::kIgnored || pose == nullptr || !pose->T_camera_object) continue;
    PosePrediction statement;
    statement.confidence = static_cast<double>(pose->quality);
    statement.confidence_up_to_shape = static_cast<double>(pose->shape_quality);
    if (detection.outcome == MatchOutcome::kTruePositive) {
      const GroundTruthObject& truth = frame.objects[detection.object].truth;
      if (!truth.has_pose) continue;
      statement.is_true = is_correct(model, *pose->T_camera_object, truth.T_camera_object);
      statement.is_correct_up_to_shape = is_correct_up_to_shape(model, *pose->T_camera_object, truth.T_camera_object);
    }
    statements.push_back(statement);
  }
  return statements;
}

double strict_recall(const std::vector<JudgedPose>& poses, double diameter, double min_visible) {
  return recall(poses, &JudgedPose::strict, diameter, min_visible);
}

double add_s_recall(const std::vector<JudgedPose>& poses, double diameter, double min_visible) {
  return recall(poses, &JudgedPose::add_s, diameter, min_visible);
}

double add_or_add_s_recall(const std::vector<JudgedPose>& poses, const PoseModel& model, double min_visible) {
  return recall(poses, model.is_symmetric() ? &JudgedPose::add_s : &JudgedPose::add, model.diameter, min_visible);
}

}  // namespace houghstream
