#pragma once

#include <map>
#include <string>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "tools/studies/pose/pose_makers.hpp"
#include "tools/studies/pose/pose_trials.hpp"

namespace houghstream {

/// The makers of poses by name; those of `rivals` are slow and try few frames.
struct BenchedMakers {
  std::map<std::string, PoseMaker> each_frame;
  std::map<std::string, PoseMaker> rivals;
};

/// What each variant made of frames: pooled over scenes by add().
struct VariantResult {
  std::vector<PoseTrial> trials;
  std::vector<FrameErrors> errors;  ///< by BOP's measures, of all classes

  void add(const PoseRun& run, const BopScene& scene, const SceneModels& models, int threads);
};

/// By variant; `on_rival_frames` holds the rivals, and the others on the rivals' frames only, so that they compare.
struct PoseBench {
  int frames = 0;
  int rival_frames = 0;
  std::map<std::string, VariantResult> each_frame;
  std::map<std::string, VariantResult> on_rival_frames;
};

/// A scene's name and its frames with detections.
struct DetectedScene {
  std::string name;
  const BopScene& scene;
  std::vector<EvaluatedFrame> frames;
};

/// How a scene is benched.
struct BenchRules {
  int rivals_every = 10;  ///< the rivals look at frames 0, N, 2N, ... of those that were detected in
  double rivals_s = 0.0;  ///< of those, at as many as can be done in this time, spread over the scene; 0: at all
  int threads = 1;        ///< for measuring errors; the makers run on one
};

/// Has every maker give poses to all detections, rivals to those of their frames, and adds what came of it. All rivals
/// look at the same frames.
void bench_scene(const DetectedScene& detected, const SceneModels& models, const BenchedMakers& makers,
                 const BenchRules& rules, PoseBench& bench);

}  // namespace houghstream
