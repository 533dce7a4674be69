#include <algorithm>
#include <array>
#include <opencv2/surface_matching.hpp>
#include <opencv2/surface_matching/icp.hpp>

#include "pipeline/base/checks.hpp"
#include "pose/baseline/register_pcl.hpp"
#include "tools/studies/pose/surface_baseline.hpp"

namespace houghstream {
namespace {

namespace ppf = cv::ppf_match_3d;

/// OpenCV thins a cloud by a grid of this fraction of its extent along each axis, which squeezes flat clouds; it is so
/// fine that the result of thinned() stays.
constexpr double kFineStep = 0.02;

/// Returns one row x, y, z, nx, ny, nz per point, in the form that cv::ppf_match_3d takes.
cv::Mat rows_of(const SurfaceCloud& cloud) {
  cv::Mat rows(static_cast<int>(cloud.size()), 6, CV_32FC1);
  for (int i = 0; i < rows.rows; ++i) {
    const pcl::PointNormal& p = cloud[static_cast<std::size_t>(i)];
    const std::array<float, 6> row = {p.x, p.y, p.z, p.normal_x, p.normal_y, p.normal_z};
    std::copy(row.begin(), row.end(), rows.ptr<float>(i));
  }
  return rows;
}

Eigen::Isometry3d rigid(const cv::Matx44d& matrix) {
  return rigid_motion(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix.val));
}

void check_settings(const PpfSettings& s) {
  require(s.spacing >= 0.01 && s.spacing <= 0.5, "ppf: spacing {}, expected 0.01 to 0.5 diameters", s.spacing);
  require(s.distance_step >= 0.01 && s.distance_step <= 0.5, "ppf: distance step {}, expected 0.01 to 0.5 diameters",
          s.distance_step);
  require(s.angles >= 4 && s.angles <= 360, "ppf: {} angles, expected 4 to 360", s.angles);
  require(s.reference_fraction > 0.0 && s.reference_fraction <= 1.0,
          "ppf: reference share {}, expected above 0, at most 1", s.reference_fraction);
  require(s.kept >= 1 && s.icp_iterations >= 1 && s.icp_levels >= 1,
          "ppf: {} poses, {} iterations of ICP in {} levels, expected at least 1 of each", s.kept, s.icp_iterations,
          s.icp_levels);
}

class PpfRival final : public SurfaceRival {
 public:
  PpfRival(const std::map<std::string, Mesh>& meshes, const PoseSettings& pose, const PpfSettings& settings)
      : SurfaceRival(meshes, pose, settings.surface), settings_(settings) {
    for (const auto& [name, model] : models()) {
      auto detector =
          std::make_unique<ppf::PPF3DDetector>(settings.distance_step, settings.distance_step, settings.angles);
      detector->setSearchParams(settings.cluster_m, settings.cluster_rad);
      detector->trainModel(rows_of(*model_surface(model, spacing_m(model))));
      detectors_.emplace(name, std::move(detector));
    }
  }

 private:
  std::vector<Eigen::Isometry3d> propose(const std::string& name, const SeenSurface& surface) const override {
    constexpr std::size_t kMinPoints = 12;  // twice the unknowns
    if (surface.cloud->size() < kMinPoints) return {};
    const cv::Mat measured = rows_of(*surface.cloud);
    std::vector<ppf::Pose3DPtr> found;
    const cv::Mat thin = rows_of(*thinned(*surface.cloud, spacing_m(models().at(name))));
    detectors_.at(name)->match(thin, found, settings_.reference_fraction, kFineStep);
    ppf::ICP icp(settings_.icp_iterations, settings_.icp_tolerance, settings_.icp_rejection, settings_.icp_levels);
    std::vector<Eigen::Isometry3d> poses;
    for (const ppf::Pose3DPtr& pose : found) {
      const Eigen::Isometry3d start = rigid(pose->pose);
      if (!start.matrix().allFinite() || !surface.reaches(start)) continue;
      std::vector<ppf::Pose3DPtr> refined = {pose->clone()};
      icp.registerModelToScene(rows_of(view_surface(nearest_view(models().at(name), start))), measured, refined);
      poses.push_back(rigid(refined.front()->pose));
      if (static_cast<int>(poses.size()) == settings_.kept) break;
    }
    return poses;
  }

  double spacing_m(const ObjectModel& model) const { return settings_.spacing * 2.0 * model.radius; }

  PpfSettings settings_;
  std::map<std::string, std::unique_ptr<ppf::PPF3DDetector>> detectors_;
};

}  // namespace

std::unique_ptr<BaselineEstimator> make_ppf_baseline(const std::map<std::string, Mesh>& models,
                                                     const PoseSettings& pose, const PpfSettings& settings) {
  check_settings(settings);
  return std::make_unique<PpfRival>(models, pose, settings);
}

}  // namespace houghstream
