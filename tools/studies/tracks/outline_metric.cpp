#include "tools/studies/tracks/outline_metric.hpp"

#include <cmath>

#include "drivers/datasets/bop_dataset.hpp"
#include "pose/following/silhouette.hpp"

namespace houghstream::studies {

double outline_distance_px(const ObjectModel& model, const Camera& camera, const Eigen::Isometry3d& truth,
                           const Eigen::Isometry3d& found) {
  constexpr int kPoints = 100;
  const Silhouette silhouette = make_silhouette(model, truth, kPoints);
  double sum = 0.0;
  int count = 0;
  for (const SilhouettePoint& at : silhouette.points) {
    const Eigen::Vector3d here = truth * at.point.cast<double>();
    const Eigen::Vector3d there = found * at.point.cast<double>();
    const Eigen::Vector2d normal = (truth.linear() * at.normal.cast<double>()).head<2>();
    if (!(here.z() > 0.0) || !(there.z() > 0.0) || !(normal.norm() > 0.0)) continue;
    sum += std::abs((camera.project(there) - camera.project(here)).dot(normal.normalized()));
    ++count;
  }
  return sum / count;  // 0/0 is NaN
}

OrderedJson outline_metrics(const SequenceFile& sequence, const std::vector<MatchedPose>& poses,
                            const std::map<std::string, ObjectModel>& models) {
  const SequenceCamera& first = sequence.cameras.at(0);
  const Camera camera = BopScene(first.scene).images().at(0).camera;
  std::map<std::string, std::vector<double>> distances;
  for (const MatchedPose& pose : poses) {
    const auto model = models.find(pose.truth->class_name);
    if (!pose.T_world_object || model == models.end() || !pose.is_clearly_visible()) continue;
    const Eigen::Isometry3d T_camera_world = first.T_world_camera[pose.frame->index].inverse();
    const double apart_px = outline_distance_px(model->second, camera, T_camera_world * *pose.truth->T_world_object,
                                                T_camera_world * *pose.T_world_object);
    if (std::isfinite(apart_px)) distances[pose.truth->class_name].push_back(apart_px);
  }
  OrderedJson out = OrderedJson::object();
  for (const auto& [name, values] : distances) out[name] = quantile(values, 0.5);
  return out;
}

}  // namespace houghstream::studies
