#include "tools/render/sequence_jobs.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/render/ordered_frames.hpp"
#include "tools/render/world/sequences/sequence.hpp"

namespace houghstream::render {

using namespace world;

namespace {

std::vector<SequencePlan> selected_plans(const SequencesJob& job) {
  std::vector<SequencePlan> all = sequence_plans();
  if (job.names == std::vector<std::string>{"all"}) return all;
  std::vector<SequencePlan> selected;
  for (const std::string& name : job.names) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const SequencePlan& plan) { return plan.name == name; });
    std::vector<std::string> known(all.size());
    std::transform(all.begin(), all.end(), known.begin(), [](const SequencePlan& plan) { return plan.name; });
    require(found != all.end(), "sequence \"{}\": expected all or one of {}", name, fmt::join(known, ", "));
    selected.push_back(*found);
  }
  return selected;
}

OrderedJson pose_entry(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d& t = T.translation();
  return {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()};
}

/// The share that is seen of each instance; a frame's objects are those of which enough is seen, in no other order.
OrderedJson visible_entry(const SequenceGroundTruth& truth, int camera, const std::vector<GroundTruthObject>& seen) {
  constexpr double kSamePlaceM = 1e-6;
  OrderedJson out = OrderedJson::array();
  for (const auto& T_world_object : truth.T_world_object) {
    double visible = 0.0;
    for (const GroundTruthObject& object : seen) {
      if (!T_world_object) break;
      const Eigen::Isometry3d T = truth.T_camera_world[static_cast<std::size_t>(camera)] * *T_world_object;
      if ((T.translation() - object.T_camera_object.translation()).norm() < kSamePlaceM)
        visible = object.visible_fraction;
    }
    out.push_back(visible);
  }
  return out;
}

OrderedJson empty_frames(const Sequence& sequence, int frames, double fps) {
  OrderedJson out = OrderedJson::array();
  for (int i = 0; i < frames; ++i) {
    const SequenceGroundTruth truth = sequence.truth(i / fps);
    OrderedJson objects = OrderedJson::array();
    for (const auto& T : truth.T_world_object) objects.push_back(T ? pose_entry(*T) : OrderedJson());
    out.push_back({{"utime", dataset_utime(0) + std::llround(i * 1e6 / fps)},
                   {"objects", objects},
                   {"cameras", OrderedJson::array()}});
  }
  return out;
}

void render_sequence(const RenderOptions& options, const SequencesJob& job, const SequencePlan& plan) {
  const Sequence sequence(plan, job.development ? DatasetSplit::kTraining : DatasetSplit::kTest);
  const int frames = static_cast<int>(std::lround(plan.seconds * job.fps));
  OrderedJson out{{"name", plan.name}, {"fps", job.fps}};
  for (std::size_t i = 0; i < plan.actors.size(); ++i)
    out["objects"].push_back({{"instance", i + 1},
                              {"object_id", plan.actors[i].object_id},
                              {"name", make_taught_object(plan.actors[i].object_id).name}});
  OrderedJson ground_truth_of_frames = empty_frames(sequence, frames, job.fps);
  for (int camera = 0; camera < sequence.cameras(); ++camera) {
    const std::string scene = fmt::format("{:06d}", camera + 1);
    out["cameras"].push_back({{"scene", scene}, {"channel", fmt::format("CAMERA_{}", camera + 1)}});
    BopWriter writer(fresh_scene(options, options.out / plan.name / scene));
    int index = 0;
    render_in_order(
        plan.name, options.threads, frames, [&](int i) { return sequence.render(camera, i / job.fps, i); },
        [&](const RenderedFrame& view) {
          const SequenceGroundTruth truth = sequence.truth(index / job.fps);
          const Eigen::Isometry3d T_world_camera = truth.T_camera_world[static_cast<std::size_t>(camera)].inverse();
          ground_truth_of_frames[static_cast<std::size_t>(index++)]["cameras"].push_back(
              {{"T_world_camera", pose_entry(T_world_camera)},
               {"visible", visible_entry(truth, camera, view.objects)}});
          writer.add(view.frame, view.objects, view.visible_masks);
        });
    writer.finish();
  }
  out["frames"] = ground_truth_of_frames;
  write_json(out, options.out / plan.name / "sequence.json");
}

}  // namespace

void render_sequences(const RenderOptions& options, const SequencesJob& job) {
  require(job.fps >= 1.0 && job.fps <= 120.0, "sequences: {} frames a second, expected 1 to 120", job.fps);
  const std::vector<SequencePlan> plans = selected_plans(job);
  std::set<int> ids;
  for (const SequencePlan& plan : plans) {
    for (const Actor& actor : plan.actors) ids.insert(actor.object_id);
  }
  std::vector<TaughtObject> objects;
  objects.reserve(ids.size());
  for (const int id : ids) objects.push_back(make_taught_object(id));
  for (const SequencePlan& plan : plans) fresh_scene(options, options.out / plan.name / "000001");  // each has this one
  write_models(options, objects);
  for (const SequencePlan& plan : plans) render_sequence(options, job, plan);
}

}  // namespace houghstream::render
