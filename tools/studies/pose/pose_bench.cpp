#include "tools/studies/pose/pose_bench.hpp"

namespace houghstream {
namespace {

PoseRun run_maker(const DetectedScene& detected, const PoseMaker& maker, int every) {
  PoseRun run;
  run.scene = detected.name;
  run.frames = every_nth(detected.frames, every);
  for (EvaluatedFrame& frame : run.frames) {
    TimedPoses made = make_poses(maker, detected.scene.read_frame(frame.image), *frame.detections);
    frame.poses = std::move(made.poses);
    run.ms.push_back(std::move(made.ms));
  }
  return run;
}

PoseRun thin_run(const PoseRun& run, int every) {
  PoseRun out{run.scene, every_nth(run.frames, every), {}};
  for (std::size_t i = 0; i < run.ms.size(); i += static_cast<std::size_t>(every)) out.ms.push_back(run.ms[i]);
  return out;
}

}  // namespace

void VariantResult::add(const PoseRun& run, const BopScene& scene, const SceneModels& models, int threads) {
  const std::vector<PoseTrial> judged = judge_run(run, models.scored);
  trials.insert(trials.end(), judged.begin(), judged.end());
  for (const auto& [name, frames] : measure_poses(run.frames, scene, models.bop, threads))
    errors.insert(errors.end(), frames.begin(), frames.end());
}

void bench_scene(const DetectedScene& detected, const SceneModels& models, const BenchedMakers& makers,
                 const BenchRules& rules, PoseBench& bench) {
  bench.frames += static_cast<int>(detected.frames.size());
  for (const auto& [name, maker] : makers.each_frame) {
    const PoseRun run = run_maker(detected, maker, 1);
    bench.each_frame[name].add(run, detected.scene, models, rules.threads);
    if (!makers.rivals.empty())
      bench.on_rival_frames[name].add(thin_run(run, rules.rivals_every), detected.scene, models, rules.threads);
  }
  for (const auto& [name, maker] : makers.rivals) {
    bench.on_rival_frames[name].add(run_maker(detected, maker, rules.rivals_every), detected.scene, models,
                                    rules.threads);
  }
  if (!makers.rivals.empty())
    bench.rival_frames += static_cast<int>(every_nth(detected.frames, rules.rivals_every).size());
}

}  // namespace houghstream
