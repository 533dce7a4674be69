#include "tools/studies/tracks/outline_metric.hpp"

#include <cmath>

#include "drivers/datasets/bop_dataset.hpp"
#include "pose/following/silhouette.hpp"

namespace houghstream::studies {
namespace {

constexpr double kOutlineReachM = 0.1;  // a published object farther away is of none of its class
constexpr double kOutlineVisible = 1.0 / 3.0;

}  // namespace

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

OrderedJson outline_metrics(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                            const ClassSymmetries& symmetries, const std::map<std::string, ObjectModel>& models) {
  const SequenceCamera& first = sequence.cameras.at(0);
  const Camera camera = BopScene(first.scene).images().at(0).camera;
  std::map<std::string, std::vector<double>> distances;
  for (const PublishedFrame& frame : published) {
    const std::vector<TrueInstance>& truth = sequence.frames[frame.index];
    const std::vector<int> given = matches(truth, frame.objects, symmetries, kOutlineReachM);
    const Eigen::Isometry3d T_camera_world = first.T_world_camera[frame.index].inverse();
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto model = models.find(truth[i].class_name);
      if (given[i] < 0 || model == models.end() || truth[i].visible < kOutlineVisible) continue;
      const Eigen::Isometry3d found =
          as_the_truth(frame.objects[static_cast<std::size_t>(given[i])], truth[i], symmetries);
      const double apart_px =
          outline_distance_px(model->second, camera, T_camera_world * *truth[i].T_world_object, T_camera_world * found);
      if (std::isfinite(apart_px)) distances[truth[i].class_name].push_back(apart_px);
    }
  }
  OrderedJson out = OrderedJson::object();
  for (const auto& [name, values] : distances) out[name] = quantile(values, 0.5);
  return out;
}

}  // namespace houghstream::studies
