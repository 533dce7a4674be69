#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "detector/detector.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "pose/pose_estimator.hpp"
#include "pose/verification/quality_training.hpp"
#include "tools/evaluate/metrics/pose_metrics.hpp"

namespace houghstream::quality {

/// A pose that was found in a scene, judged by the truth.
struct Example : QualityExample {
  std::string scene;
  std::size_t frame = 0;   ///< index of the frame of the scene
  std::size_t object = 0;  ///< index into the frame's objects; only meaningful where the object is present
};

/// Terms of the quality of one pose, from which QualitySettings are learnt.
struct PoseTerms {
  QualityTerms own;
  std::optional<QualityTerms> with_swapped_texture = std::nullopt;  ///< see evidence_with_swapped_texture()
  /// TextureComparison::margin; nothing where there are no alternatives.
  std::optional<double> texture_margin = std::nullopt;
};

/// Frames of a scene with detections and poses, one pose for each detection in their order, and what each pose is
/// judged by: by frame and detection, nothing where there is no pose.
struct FoundPoses {
  std::string scene;
  std::vector<EvaluatedFrame> frames;
  std::vector<std::vector<std::optional<PoseTerms>>> terms;
};

/// Returns the poses of the classes with a model beside the ground truth. Those of detections that are neither true nor
/// false, and of objects whose truth has no pose, are left out.
std::vector<Example> label_examples(const FoundPoses& found, const std::map<std::string, PoseModel>& models);

/// Models by class name, metres, and for which point of each its detections' votes are (ObjectModel::vote_centre).
struct PosedModels {
  std::map<std::string, Mesh> meshes;
  std::map<std::string, Eigen::Vector3f> vote_centres;
  std::map<std::string, Symmetries> symmetries = {};  ///< ModelSettings::symmetries
  /// Symmetries of shapes; those of other classes are found in the meshes.
  std::map<std::string, ShapeSymmetry> shape_symmetries = {};
  BrightnessRange tone = {};  ///< see RegionSettings
};

/// Estimates poses without rejecting any, and returns the terms of each one's quality.
class UnfilteredPoseFinder {
 public:
  /// Makes a finder. `threads` is as PoseSettings::threads.
  UnfilteredPoseFinder(const PosedModels& models, int threads);

  /// Detects in frames 0, N, 2N, ... of a scene and finds the detections' poses.
  FoundPoses find(const std::string& name, const BopScene& scene, const Detector& detector, int every) const;

  /// Estimates the poses of `found.detections` into `found.poses`; returns the terms of their qualities. Thread-safe.
  std::vector<std::optional<PoseTerms>> find_in(const RgbdFrame& frame, EvaluatedFrame& found) const;

 private:
  std::vector<std::optional<PoseTerms>> terms_of(const RgbdFrame& frame, const Detections& detections,
                                                 const ObjectPoses& poses) const;

  PoseSettings settings_;
  PoseEstimator estimator_;
  std::map<std::string, ObjectModel> models_;
};

}  // namespace houghstream::quality
