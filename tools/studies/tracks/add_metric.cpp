#include "tools/studies/tracks/add_metric.hpp"

#include "pose/model/angles.hpp"
#include "pose/motion/twist.hpp"

namespace houghstream::studies {
namespace {

constexpr double kReachM = 0.1;  // a published object farther away is of none of its class
constexpr double kDiameters = 0.1;
constexpr double kSure = 0.9;
constexpr double kMinVisible = 1.0 / 3.0;  // fraction of what is measured by its medians

double mean_distance(const AddModel& model, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3f T_a = a.cast<float>();
  const Eigen::Isometry3f T_b = b.cast<float>();
  double sum = 0.0;
  for (const Eigen::Vector3f& point : model.points) sum += static_cast<double>((T_a * point - T_b * point).norm());
  return sum / static_cast<double>(model.points.size());
}

/// Counts the results of a class.
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

OrderedJson add_metrics(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                        const ClassSymmetries& symmetries, const std::map<std::string, AddModel>& models) {
  std::map<std::string, AddCount> counts;
  int sure = 0;
  int wrong = 0;
  for (const PublishedFrame& frame : published) {
    const std::vector<TrueInstance>& truth = sequence.frames[frame.index];
    const std::vector<int> given = matches(truth, frame.objects, symmetries, kReachM);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const auto model = models.find(truth[i].class_name);
      if (!truth[i].T_world_object || model == models.end()) continue;
      AddCount& count = counts[truth[i].class_name];
      ++count.frames;
      if (given[i] < 0) continue;
      const auto place = static_cast<std::size_t>(given[i]);
      const PublishedObject& object = frame.objects[place];
      const double apart_m =
          mean_distance(model->second, as_the_truth(object, truth[i], symmetries), *truth[i].T_world_object);
      const bool is_correct = apart_m < kDiameters * model->second.diameter_m;
      count.right += is_correct ? 1 : 0;
      if (truth[i].visible >= kMinVisible)
        note_errors(model->second, as_the_truth(object, truth[i], symmetries), *truth[i].T_world_object, count);
      if (frame.qualities.empty() || !(frame.qualities[place] > kSure)) continue;
      ++sure;
      wrong += is_correct ? 0 : 1;
    }
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
