#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pose/pose_settings.hpp"
#include "tools/studies/pose/pose_baselines.hpp"
#include "tools/studies/pose/pose_trials.hpp"

namespace houghstream {

/// The poses of a frame's detections, in their order, and the CPU time that each took, milliseconds: of the calling
/// thread, which other load of the machine lengthens little.
struct TimedPoses {
  ObjectPoses poses;
  std::vector<double> ms;
};

/// Gives the poses of a frame's detections, or the reasons why there are none, on the calling thread.
using PoseMaker = std::function<TimedPoses(const RgbdFrame&, const Detections&)>;

/// Makes poses with PoseEstimator on one thread, of all detections of a frame together, as hs-pose does: some are
/// judged by others. Each has the frame's time over its published poses, so that what is found to be none is paid for
/// too. Models by class name, metres.
PoseMaker estimator_maker(const std::map<std::string, Mesh>& models, PoseSettings settings);

/// Makes poses with a baseline, of one detection after another; a pose that it finds is published, else the status is
/// kNotConverged.
PoseMaker baseline_maker(std::unique_ptr<BaselineEstimator> baseline);

/// The makers of poses by name; those of `baselines` are slow and try few frames.
struct BenchedMakers {
  std::map<std::string, PoseMaker> each_frame;
  std::map<std::string, PoseMaker> baselines;
};

/// Results of each variant, pooled over scenes by add().
struct VariantResult {
  std::vector<PoseTrial> trials;
  std::vector<FrameErrors> errors;  ///< BOP's errors, all classes

  void add(const PoseRun& run, const BopScene& scene, const SceneModels& models, int threads);
};

/// Holds the results by variant; `on_baseline_frames` holds the baselines, and the others on the baselines' frames
/// only, so that they compare.
struct PoseBench {
  int frames = 0;
  int baseline_frames = 0;
  std::map<std::string, VariantResult> each_frame;
  std::map<std::string, VariantResult> on_baseline_frames;
};

/// A scene's name and its frames with detections.
struct DetectedScene {
  std::string name;
  const BopScene& scene;
  std::vector<EvaluatedFrame> frames;
};

/// Settings of a scene's benchmark.
struct BenchRules {
  int baselines_every = 10;  ///< the baselines process frames 0, N, 2N, ... of those with detections
  double baselines_s = 0.0;  ///< time for the baselines, whose frames are spread over the scene; 0: no limit
  int threads = 1;           ///< threads that measure errors; the makers run on one
};

/// Makes every maker estimate poses of all detections, baselines those of their frames, and adds the results. All
/// baselines process the same frames.
void bench_scene(const DetectedScene& detected, const SceneModels& models, const BenchedMakers& makers,
                 const BenchRules& rules, PoseBench& bench);

}  // namespace houghstream
