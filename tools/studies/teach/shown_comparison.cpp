#include "tools/studies/teach/shown_comparison.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "pose/model/mesh_bvh.hpp"
#include "tools/studies/recorded/mesh_alignment.hpp"

namespace houghstream::studies {
namespace {

constexpr int kPoints = 6000;
constexpr std::uint64_t kSeed = 1;
constexpr double kMissing_m = 0.005;
constexpr double kDegrees = 180.0 / M_PI;

double quantile(std::vector<double> values, double fraction) {
  const auto rank = static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank];
}

Spread spread_of(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.95)};
}

/// Returns the motion between two poses; `middle` is given in the frame that both map from.
PoseGap gap_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Eigen::Vector3d& middle) {
  return {(a * middle - b * middle).norm(),
          Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()))};
}

/// A length that counts turns too: what they move at a tenth of a metre.
double size_of(const PoseGap& gap) {
  return gap.shift_m + 0.1 * gap.angle_rad;
}

Eigen::Isometry3d mean_of(const std::vector<Eigen::Isometry3d>& poses, const Eigen::Vector3d& middle) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (const Eigen::Isometry3d& pose : poses) {
    sum += pose.linear();
    place += pose * middle / static_cast<double>(poses.size());
  }
  // The rotation is the nearest to the sum (chordal mean).
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  mean.linear() = svd.matrixU() * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
  mean.translation() = place - mean.linear() * middle;
  return mean;
}

/// The mean of those that are near the one in their middle, so that lost frames do not count.
Eigen::Isometry3d robust_mean(const std::vector<Eigen::Isometry3d>& poses, const Eigen::Vector3d& middle) {
  std::vector<double> best;
  double minimum = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& candidate : poses) {
    std::vector<double> sizes;
    sizes.reserve(poses.size());
    for (const Eigen::Isometry3d& pose : poses) sizes.push_back(size_of(gap_between(candidate, pose, middle)));
    const double median = quantile(sizes, 0.5);
    if (median < minimum) {
      minimum = median;
      best = sizes;
    }
  }
  std::vector<Eigen::Isometry3d> near;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (best[i] <= 3.0 * minimum) near.push_back(poses[i]);
  }
  return mean_of(near, middle);
}

/// Returns the taught frame in the ground-truth one for each pose; poses of frames without ground truth are left out.
std::vector<Eigen::Isometry3d> ground_truth_from_taught(const TrueTakes& takes, const std::vector<ShownPose>& poses) {
  std::vector<Eigen::Isometry3d> out;
  for (const ShownPose& pose : poses) {
    if (pose.frame >= takes.scenes[pose.scene].images().size()) continue;
    const GroundTruthObject* object = ground_truth_object(takes, pose.scene, pose.frame);
    if (object != nullptr) out.push_back(object->T_camera_object.inverse() * pose.T_camera_taught);
  }
  return out;
}

std::vector<double> distances(const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3d& T_mesh_points,
                              const Mesh& mesh) {
  const MeshBvh tree(mesh);
  std::vector<double> out;
  out.reserve(points.size());
  for (const Eigen::Vector3f& point : points)
    out.push_back(tree.nearest((T_mesh_points * point.cast<double>()).cast<float>()).distance);
  return out;
}

/// Returns points of the ground-truth surface that some frames observed, without self-occlusion.
std::vector<Eigen::Vector3f> seen_points(const TrueTakes& takes, const std::vector<Eigen::Vector3f>& points) {
  constexpr std::size_t kFrames = 40;  // frames of each scene
  constexpr double kBehind_m = 0.003;
  std::vector<bool> seen(points.size(), false);
  for (std::size_t s = 0; s < takes.scenes.size(); ++s) {
    const std::size_t step = std::max<std::size_t>(1, takes.scenes[s].images().size() / kFrames);
    for (std::size_t f = 0; f < takes.scenes[s].images().size(); f += step) {
      const GroundTruthObject* object = ground_truth_object(takes, s, f);
      if (object == nullptr) continue;
      const Camera& camera = takes.scenes[s].images()[f].camera;
      const cv::Rect all(0, 0, camera.width, camera.height);
      const cv::Mat depth = render_depth(takes.mesh, object->T_camera_object, camera, all);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3d point = object->T_camera_object * points[i].cast<double>();
        const Eigen::Vector2d pixel = camera.project(point);
        const cv::Point at(cvRound(pixel.x()), cvRound(pixel.y()));
        if (all.contains(at) && point.z() < depth.at<float>(at) + kBehind_m) seen[i] = true;
      }
    }
  }
  std::vector<Eigen::Vector3f> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (seen[i]) out.push_back(points[i]);
  }
  return out;
}

void compare_meshes(const TrueTakes& takes, const Mesh& taught, ShownComparison& comparison) {
  const Eigen::Isometry3d& T_true_taught = comparison.T_true_taught;
  comparison.taught_to_true =
      spread_of(distances(sample_surface(taught, kPoints, kSeed).points, T_true_taught, takes.mesh));
  const std::vector<Eigen::Vector3f> points = sample_surface(takes.mesh, kPoints, kSeed).points;
  const std::vector<Eigen::Vector3f> seen = seen_points(takes, points);
  comparison.seen_surface = static_cast<double>(seen.size()) / static_cast<double>(points.size());
  if (seen.empty()) return;
  const std::vector<double> away = distances(seen, T_true_taught.inverse(), taught);
  comparison.seen_to_taught = spread_of(away);
  const auto missing = std::count_if(away.begin(), away.end(), [](double it) { return it > kMissing_m; });
  comparison.missing_fraction = static_cast<double>(missing) / static_cast<double>(away.size());
}

void compare_poses(const std::vector<Eigen::Isometry3d>& poses, const Eigen::Vector3d& middle,
                   ShownComparison& comparison) {
  comparison.tracked = static_cast<int>(poses.size());
  comparison.drift = gap_between(poses.front(), poses.back(), middle);
  std::vector<double> shifts;
  std::vector<double> rotations;
  for (const Eigen::Isometry3d& pose : poses) {
    const PoseGap gap = gap_between(pose, comparison.T_true_taught, middle);
    shifts.push_back(gap.shift_m);
    rotations.push_back(gap.angle_rad);
  }
  comparison.tracking_shift = spread_of(shifts);
  comparison.tracking_angle_rad = spread_of(rotations).maximum;
}

void compare_views(const TrueTakes& takes, const std::vector<KeptView>& views, const Eigen::Vector3d& middle,
                   ShownComparison& comparison) {
  comparison.views = static_cast<int>(views.size());
  comparison.min_mask_iou = 1.0;
  std::vector<ShownPose> second;
  for (const KeptView& view : views) {
    comparison.mask_iou += view.mask_iou / static_cast<double>(views.size());
    comparison.min_mask_iou = std::min(comparison.min_mask_iou, view.mask_iou);
    if (view.pose.scene == 1) second.push_back(view.pose);
  }
  const std::vector<Eigen::Isometry3d> poses = ground_truth_from_taught(takes, second);
  if (!poses.empty()) comparison.second = gap_between(robust_mean(poses, middle), comparison.T_true_taught, middle);
}

}  // namespace

ShownComparison compare_shown(const TrueTakes& takes, const std::filesystem::path& kept, const Mesh& taught) {
  const std::vector<KeptView> views = read_kept_views(kept / "views", takes);
  require(!views.empty(), "{}: no view whose picture is in the takes, expected keyframes", (kept / "views").string());
  const std::filesystem::path poses_file = kept / "camera_poses.csv";
  const std::vector<Eigen::Isometry3d> poses = ground_truth_from_taught(takes, read_camera_poses(poses_file));
  require(!poses.empty(), "{}: no tracked frame, expected some", poses_file.string());
  const Eigen::Vector3d middle = mesh_bounds(taught).center().cast<double>();
  ShownComparison comparison;
  comparison.T_true_taught = robust_mean(poses, middle);
  compare_poses(poses, middle, comparison);
  compare_views(takes, views, middle, comparison);
  comparison.T_true_taught = refined_alignment(taught, takes.mesh, comparison.T_true_taught);
  compare_meshes(takes, taught, comparison);
  return comparison;
}

OrderedJson to_json(const ShownComparison& comparison) {
  OrderedJson json;
  json["mesh_mm_median"] = 1e3 * comparison.taught_to_true.median;
  json["mesh_mm_95"] = 1e3 * comparison.taught_to_true.maximum;
  json["seen_mm_median"] = 1e3 * comparison.seen_to_taught.median;
  json["seen_mm_95"] = 1e3 * comparison.seen_to_taught.maximum;
  json["missing_share"] = comparison.missing_fraction;
  json["seen_surface"] = comparison.seen_surface;
  json["drift_mm"] = 1e3 * comparison.drift.shift_m;
  json["drift_deg"] = kDegrees * comparison.drift.angle_rad;
  json["tracking_mm_median"] = 1e3 * comparison.tracking_shift.median;
  json["tracking_mm_95"] = 1e3 * comparison.tracking_shift.maximum;
  json["tracking_deg_95"] = kDegrees * comparison.tracking_angle_rad;
  json["tracked"] = comparison.tracked;
  json["second_mm"] = comparison.second ? OrderedJson(1e3 * comparison.second->shift_m) : OrderedJson();
  json["second_deg"] = comparison.second ? OrderedJson(kDegrees * comparison.second->angle_rad) : OrderedJson();
  json["mask_iou"] = comparison.mask_iou;
  json["least_mask_iou"] = comparison.min_mask_iou;
  json["views"] = comparison.views;
  OrderedJson rows = OrderedJson::array();
  for (int i = 0; i < 12; ++i) rows.push_back(comparison.T_true_taught.matrix()(i / 4, i % 4));
  json["T_true_taught"] = rows;
  return json;
}

}  // namespace houghstream::studies
