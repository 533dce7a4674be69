#include "tools/studies/tracks/add_metric.hpp"

#include "pose/model/angles.hpp"
#include "pose/motion/twist.hpp"

namespace houghstream::studies {
namespace {

constexpr double kDiameters = 0.1;
constexpr double kSure = 0.9;

double mean_distance(const AddModel& model, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3f T_a = a.cast<float>();
  const Eigen::Isometry3f T_b = b.cast<float>();
  double sum = 0.0;
  for (const Eigen::Vector3f& point : model.points) sum += static_cast<double>((T_a * point - T_b * point).norm());
  return sum / static_cast<double>(model.points.size());
}

/// Counts and errors of the results of a class.
struct AddCount {
  int frames = 0;  // in which an object is there
  int right = 0;
  std::vector<double> errors_mm;  // where it is published and visible enough
  std::vector<double> errors_deg;
};

Eigen::Vector3d mean_point(const AddModel& model) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& point : model.points) sum += point;
  return (sum / static_cast<float>(model.points.size())).cast<double>();
}

void note_errors(const AddModel& model, const Eigen::Isometry3d& found, const Eigen::Isometry3d& truth,
                 AddCount& count) {
  const Eigen::Vector3d middle = mean_point(model);
  count.errors_mm.push_back(1e3 * (found * middle - truth * middle).norm());
  count.errors_deg.push_back(rotation_vector(found.linear() * truth.linear().transpose()).norm() / kRadPerDeg);
}

}  // namespace

AddModel make_add_model(const Mesh& mesh) {
  constexpr int kPoints = 500;
  return {sample_surface(mesh, kPoints, 1).points, mesh_diameter(mesh)};
}

OrderedJson add_metrics(const std::vector<MatchedPose>& poses, const std::map<std::string, AddModel>& models) {
  std::map<std::string, AddCount> counts;
  int sure = 0;
  int wrong = 0;
  for (const MatchedPose& pose : poses) {
    const auto model = models.find(pose.truth->class_name);
    if (model == models.end()) continue;
    AddCount& count = counts[pose.truth->class_name];
    ++count.frames;
    if (!pose.T_world_object) continue;
    const Eigen::Isometry3d& truth = *pose.truth->T_world_object;
    const bool is_correct =
        mean_distance(model->second, *pose.T_world_object, truth) < kDiameters * model->second.diameter_m;
    count.right += is_correct ? 1 : 0;
    if (pose.is_clearly_visible()) note_errors(model->second, *pose.T_world_object, truth, count);
    if (!(pose.quality > kSure)) continue;
    ++sure;
    wrong += is_correct ? 0 : 1;
  }
  OrderedJson add = OrderedJson::object();
  OrderedJson errors = OrderedJson::object();
  for (const auto& [name, count] : counts) {
    add[name] = static_cast<double>(count.right) / count.frames;
    if (!count.errors_mm.empty())
      errors[name] = {{"mm", quantile(count.errors_mm, 0.5)}, {"deg", quantile(count.errors_deg, 0.5)}};
  }
  return {{"add", add}, {"median_error", errors}, {"wrong_above_0_9", {{"published", sure}, {"wrong", wrong}}}};
}

}  // namespace houghstream::studies
