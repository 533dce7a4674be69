#include <pcl/features/fpfh.h>
#include <pcl/registration/sample_consensus_prerejective.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>

#include "pipeline/base/checks.hpp"
#include "pose/baseline/register_pcl.hpp"
#include "tools/studies/pose/surface_baseline.hpp"

namespace houghstream {
namespace {

using Features = pcl::PointCloud<pcl::FPFHSignature33>;

struct DescribedSurface {
  SurfaceCloud::Ptr points;
  Features::Ptr features;  ///< features, one per point
};

/// Points whose histogram is undefined (no neighbours) are left out: PCL's search aborts on NaN.
DescribedSurface describe(const SurfaceCloud::Ptr& cloud, double radius_m) {
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
  estimation.setRadiusSearch(radius_m);
  Features all;
  estimation.compute(all);
  DescribedSurface out{SurfaceCloud::Ptr(new SurfaceCloud), Features::Ptr(new Features)};
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    if (!Eigen::Map<const Eigen::Array<float, 33, 1>>(all[i].histogram).allFinite()) continue;
    out.points->push_back((*cloud)[i]);
    out.features->push_back(all[i]);
  }
  return out;
}

void check_settings(const PrerejectiveSettings& s) {
  require(s.spacing >= 0.01 && s.spacing <= 0.5, "fpfh: spacing {}, expected 0.01 to 0.5 diameters", s.spacing);
  require(s.feature_radius > s.spacing && s.feature_radius <= 2.0,
          "fpfh: feature radius {}, expected more than the spacing, at most 2 diameters", s.feature_radius);
  require(s.runs >= 1 && s.iterations >= 1 && s.samples >= 3 && s.similar_features >= 1,
          "fpfh: {} runs of {} iterations, {} samples, {} similar features, expected at least 1, 1, 3, 1", s.runs,
          s.iterations, s.samples, s.similar_features);
  require(s.similarity >= 0.0F && s.similarity < 1.0F, "fpfh: similarity {}, expected 0 to below 1", s.similarity);
  require(s.inlier_fraction > 0.0F && s.inlier_fraction <= 1.0F, "fpfh: inlier share {}, expected above 0, at most 1",
          s.inlier_fraction);
}

class PrerejectiveRival final : public SurfaceRival {
 public:
  PrerejectiveRival(const std::map<std::string, Mesh>& meshes, const PoseSettings& pose,
                    const PrerejectiveSettings& settings)
      : SurfaceRival(meshes, pose, settings.surface), settings_(settings) {
    for (const auto& [name, model] : models()) {
      described_.emplace(name, describe(model_surface(model, spacing_m(model)), feature_radius_m(model)));
    }
  }

 private:
  using Alignment = pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33>;

  std::vector<Eigen::Isometry3d> propose(const std::string& name, const SeenSurface& surface) const override {
    const ObjectModel& model = models().at(name);
    const DescribedSurface& taught = described_.at(name);
    const DescribedSurface measured = describe(thinned(*surface.cloud, spacing_m(model)), feature_radius_m(model));
    const auto minimum = static_cast<std::size_t>(std::max(settings_.samples, settings_.similar_features));
    if (taught.points->size() < minimum || measured.points->size() < minimum) return {};
    Alignment alignment;
    configure(alignment, taught, measured, 2.0 * model.radius);
    const std::vector<Eigen::Vector3f> points = region_points(surface.frame, surface.region, settings_.icp_points);
    std::vector<Eigen::Isometry3d> poses;
    for (int run = 0; run < settings_.runs; ++run) {
      if (const auto start = align(alignment, static_cast<unsigned>(run + 1))) {
        if (const auto pose = refine(*start, model, points)) poses.push_back(*pose);
      }
    }
    return poses;
  }

  double spacing_m(const ObjectModel& model) const { return settings_.spacing * 2.0 * model.radius; }
  double feature_radius_m(const ObjectModel& model) const { return settings_.feature_radius * 2.0 * model.radius; }

  void configure(Alignment& alignment, const DescribedSurface& taught, const DescribedSurface& measured,
                 double diameter_m) const {
    alignment.setInputSource(taught.points);
    alignment.setSourceFeatures(taught.features);
    alignment.setInputTarget(measured.points);
    alignment.setTargetFeatures(measured.features);
    alignment.setMaximumIterations(settings_.iterations);
    alignment.setNumberOfSamples(settings_.samples);
    alignment.setCorrespondenceRandomness(settings_.similar_features);
    alignment.setSimilarityThreshold(settings_.similarity);
    alignment.setMaxCorrespondenceDistance(settings_.inlier_distance * diameter_m);
    alignment.setInlierFraction(settings_.inlier_fraction);
  }

  static std::optional<Eigen::Isometry3d> align(Alignment& alignment, unsigned seed) {
    static std::mutex one_at_a_time;
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    std::srand(seed);
    SurfaceCloud aligned;
    alignment.align(aligned);
    if (!alignment.hasConverged()) return std::nullopt;
    return rigid_motion(alignment.getFinalTransformation().cast<double>());
  }

  std::optional<Eigen::Isometry3d> refine(const Eigen::Isometry3d& start, const ObjectModel& model,
                                          const std::vector<Eigen::Vector3f>& points_camera) const {
    RegistrationStage stage;
    stage.iterations = settings_.icp_iterations;
    stage.points = settings_.icp_points;
    stage.max_correspondence_start_m = settings_.icp_start_m;
    stage.max_correspondence_end_m = settings_.icp_end_m;
    const RegistrationResult result =
        register_points_pcl(points_camera, model, start, stage, pose_settings().registration);
    if (result.inliers == 0) return std::nullopt;
    return result.T_camera_object;
  }

  PrerejectiveSettings settings_;
  std::map<std::string, DescribedSurface> described_;
};

}  // namespace

std::unique_ptr<BaselineEstimator> make_prerejective_baseline(const std::map<std::string, Mesh>& models,
                                                              const PoseSettings& pose,
                                                              const PrerejectiveSettings& settings) {
  check_settings(settings);
  return std::make_unique<PrerejectiveRival>(models, pose, settings);
}

}  // namespace houghstream
