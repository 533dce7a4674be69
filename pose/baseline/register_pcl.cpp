#include "pose/baseline/register_pcl.hpp"

#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

/// PCL's point-to-plane step, which is NaN or leaps where the pairs leave a direction open (one flat face); PCL's
/// search aborts the process on NaN. Such a step is refused, which ends the iterations.
class GuardedEstimation
    : public pcl::registration::TransformationEstimationPointToPlaneLLS<pcl::PointNormal, pcl::PointNormal> {
 public:
  explicit GuardedEstimation(double max_step_m) : max_step_m_(max_step_m) {}

  void estimateRigidTransformation(const Cloud& source, const Cloud& target, const pcl::Correspondences& pairs,
                                   Matrix4& step) const override {
    TransformationEstimationPointToPlaneLLS::estimateRigidTransformation(source, target, pairs, step);
    const bool sane = step.allFinite() && step.topRightCorner<3, 1>().norm() < max_step_m_;
    if (!sane) step.setIdentity();
  }

 private:
  double max_step_m_;
};

void push(Cloud& cloud, const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  pcl::PointNormal out;
  out.getVector3fMap() = point;
  out.getNormalVector3fMap() = normal;
  cloud.push_back(out);
}

Cloud::Ptr measured_cloud(const std::vector<Eigen::Vector3f>& points_camera, const Eigen::Isometry3d& T_object_camera) {
  Cloud::Ptr cloud(new Cloud);
  const Eigen::Isometry3f T = T_object_camera.cast<float>();
  for (const Eigen::Vector3f& point : points_camera) {
    push(*cloud, T * point, T.linear() * -point.normalized());  // PCL asks for a normal and does not use it
  }
  return cloud;
}

Cloud::Ptr model_cloud(const ModelView& view) {
  Cloud::Ptr cloud(new Cloud);
  for (std::size_t i = 0; i < view.points.size(); ++i) push(*cloud, view.points[i], view.normals[i]);
  return cloud;
}

void set_evidence(const Cloud& aligned, const ModelView& view, double distance,
                  pcl::search::KdTree<pcl::PointNormal>& tree, RegistrationResult& result) {
  double squares = 0.0;
  pcl::Indices index(1);
  std::vector<float> distance_sq(1);
  for (const pcl::PointNormal& point : aligned) {
    if (tree.nearestKSearch(point, 1, index, distance_sq) != 1 || distance_sq[0] > distance * distance) continue;
    const auto i = static_cast<std::size_t>(index[0]);
    const float across = (point.getVector3fMap() - view.points[i]).dot(view.normals[i]);
    ++result.inliers;
    squares += across * across;
  }
  result.inlier_fraction = static_cast<float>(result.inliers) / static_cast<float>(aligned.size());
  result.residual = static_cast<float>(std::sqrt(squares / result.inliers));  // 0/0 is NaN
}

}  // namespace

Eigen::Isometry3d rigid_motion(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  T.translation() = matrix.topRightCorner<3, 1>();
  return T;
}

RegistrationResult register_points_pcl(const std::vector<Eigen::Vector3f>& points_camera, const ObjectModel& model,
                                       const Eigen::Isometry3d& T_camera_object, const RegistrationStage& stage,
                                       const RegistrationSettings& settings) {
  constexpr std::size_t kMinPoints = 12;  // twice the unknowns
  RegistrationResult result;
  result.T_camera_object = T_camera_object;
  if (points_camera.size() < kMinPoints) return result;
  const ModelView& view = nearest_view(model, T_camera_object);
  const Cloud::Ptr source = measured_cloud(points_camera, T_camera_object.inverse());
  const Cloud::Ptr target = model_cloud(view);
  const pcl::search::KdTree<pcl::PointNormal>::Ptr tree(new pcl::search::KdTree<pcl::PointNormal>);
  tree->setInputCloud(target);

  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setTransformationEstimation(pcl::make_shared<GuardedEstimation>(model.radius));
  icp.setInputSource(source);
  icp.setSearchMethodTarget(tree, true);
  icp.setInputTarget(target);
  icp.setMaximumIterations(stage.iterations);
  icp.setTransformationEpsilon(settings.converged_m * settings.converged_m);
  Cloud aligned = *source;
  // PCL keeps one distance: run it wide, then narrow from there.
  for (const double distance : {stage.max_correspondence_start_m, stage.max_correspondence_end_m}) {
    icp.setMaxCorrespondenceDistance(distance);
    const Eigen::Matrix4f guess = result.iterations == 0 ? Eigen::Matrix4f::Identity() : icp.getFinalTransformation();
    icp.align(aligned, guess);
    result.converged = icp.hasConverged();
    if (!result.converged) return result;
    result.iterations += icp.nr_iterations_;
  }
  set_evidence(aligned, view, stage.max_correspondence_end_m, *tree, result);
  // The measured points moved by M in the object frame, so the object moves the other way in the camera frame.
  result.T_camera_object = T_camera_object * rigid_motion(icp.getFinalTransformation().cast<double>()).inverse();
  return result;
}

RegistrationResult register_pcl(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                const RegistrationStage& stage, const RegistrationSettings& settings) {
  return register_points_pcl(region_points(observation.frame, observation.region, stage.points), observation.model,
                             T_camera_object, stage, settings);
}

}  // namespace houghstream
