#include "tools/studies/pose/pose_bench.hpp"

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pose/pose_estimator.hpp"
#include "tools/studies/baselines/frame_budget.hpp"

namespace houghstream {
namespace {

double thread_cpu_ms() {
  timespec now{};
  require(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now) == 0, "the clock of the thread's CPU time cannot be read");
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

PoseRun run_maker(const DetectedScene& detected, const PoseMaker& maker) {
  PoseRun run;
  run.scene = detected.name;
  run.frames = detected.frames;
  for (EvaluatedFrame& frame : run.frames) {
    TimedPoses made = maker(detected.scene.read_frame(frame.image), *frame.detections);
    frame.poses = std::move(made.poses);
    run.ms.push_back(std::move(made.ms));
  }
  return run;
}

PoseRun thin_run(const PoseRun& run, const std::vector<std::size_t>& selected) {
  PoseRun out{run.scene, {}, {}};
  for (const std::size_t i : selected) {
    out.frames.push_back(run.frames[i]);
    out.ms.push_back(run.ms[i]);
  }
  return out;
}

/// Frames with results of baselines.
struct RivalRuns {
  std::vector<std::size_t> frames;  ///< indices of the frames with detections, ascending
  std::map<std::string, PoseRun> by_baseline;
};

/// Runs frame by frame, all baselines in turn, while there is time.
RivalRuns run_baselines(const DetectedScene& detected, const BenchedMakers& makers, const BenchRules& rules) {
  const auto every = static_cast<std::size_t>(rules.baselines_every);
  const std::size_t count = (detected.frames.size() + every - 1) / every;
  std::map<std::string, std::map<std::size_t, TimedPoses>> made;
  const std::vector<std::size_t> visited = visit_within(rules.baselines_s, count, [&](std::size_t i) {
    const EvaluatedFrame& frame = detected.frames[i * every];
    const RgbdFrame image = detected.scene.read_frame(frame.image);
    for (const auto& [name, maker] : makers.baselines) made[name][i] = maker(image, *frame.detections);
  });
  RivalRuns out;
  for (const std::size_t i : visited) out.frames.push_back(i * every);
  for (auto& [name, results] : made) {
    PoseRun& run = out.by_baseline[name];
    run.scene = detected.name;
    for (auto& [i, poses] : results) {
      run.frames.push_back(detected.frames[i * every]);
      run.frames.back().poses = std::move(poses.poses);
      run.ms.push_back(std::move(poses.ms));
    }
  }
  return out;
}

}  // namespace

PoseMaker estimator_maker(const std::map<std::string, Mesh>& models, PoseSettings settings) {
  settings.threads = 1;
  const auto estimator = std::make_shared<const PoseEstimator>(models, settings);
  return [estimator](const RgbdFrame& frame, const Detections& detections) {
    const double start_ms = thread_cpu_ms();
    TimedPoses out{estimator->estimate(frame, detections), {}};
    const double frame_ms = thread_cpu_ms() - start_ms;
    const auto published = std::count_if(out.poses.poses.begin(), out.poses.poses.end(),
                                         [](const ObjectPose& pose) { return has_pose(pose.status); });
    out.ms.assign(out.poses.poses.size(), frame_ms / static_cast<double>(std::max<std::ptrdiff_t>(published, 1)));
    return out;
  };
}

PoseMaker baseline_maker(std::unique_ptr<BaselineEstimator> baseline) {
  const std::shared_ptr<const BaselineEstimator> shared = std::move(baseline);
  return [shared](const RgbdFrame& frame, const Detections& detections) {
    TimedPoses out;
    out.poses.frame = frame.id;
    for (const Detection& detection : detections.detections) {
      ObjectPose& pose = out.poses.poses.emplace_back();
      pose.class_id = detection.class_id;
      pose.class_name = detection.class_name;
      pose.detection_score = detection.score;
      pose.detection_index = static_cast<int>(out.ms.size());
      pose.residual = std::numeric_limits<float>::quiet_NaN();
      const double start_ms = thread_cpu_ms();
      pose.T_camera_object = shared->estimate(frame, detection);
      out.ms.push_back(thread_cpu_ms() - start_ms);
      pose.status = pose.T_camera_object ? PoseStatus::kValid : PoseStatus::kNotConverged;
    }
    return out;
  };
}

void VariantResult::add(const PoseRun& run, const BopScene& scene, const SceneModels& models, int threads) {
  const std::vector<PoseTrial> judged = match_run(run, models.scored);
  trials.insert(trials.end(), judged.begin(), judged.end());
  for (const auto& [name, frames] : measure_poses(run.frames, scene, models.bop, threads))
    errors.insert(errors.end(), frames.begin(), frames.end());
}

void bench_scene(const DetectedScene& detected, const SceneModels& models, const BenchedMakers& makers,
                 const BenchRules& rules, PoseBench& bench) {
  bench.frames += static_cast<int>(detected.frames.size());
  const RivalRuns baselines = makers.baselines.empty() ? RivalRuns{} : run_baselines(detected, makers, rules);
  bench.baseline_frames += static_cast<int>(baselines.frames.size());
  for (const auto& [name, maker] : makers.each_frame) {
    const PoseRun run = run_maker(detected, maker);
    bench.each_frame[name].add(run, detected.scene, models, rules.threads);
    if (!baselines.frames.empty())
      bench.on_baseline_frames[name].add(thin_run(run, baselines.frames), detected.scene, models, rules.threads);
  }
  for (const auto& [name, run] : baselines.by_baseline)
    bench.on_baseline_frames[name].add(run, detected.scene, models, rules.threads);
}

}  // namespace houghstream
