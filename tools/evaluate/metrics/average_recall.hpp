#pragma once

#include <map>
#include <string>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "tools/evaluate/metrics/bop_errors.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"

// Average recall as in the task of the BOP challenge since 2019, 6D localisation (Hodan et al. 2020): what is in each
// image is known, and each thing is to be given its pose. Unlike the ADD-S of true detections, it counts what the
// detector missed.

namespace houghstream {

/// Less visible objects are no targets, where nothing else says which are.
constexpr double kTargetVisibility = 0.1;

/// Makes models of the meshes of a models folder by class name (load_class_models()), with their entries of its
/// models_info.json.
std::map<std::string, BopModel> make_bop_models(const std::map<std::string, Mesh>& meshes, const BopModels& models);

/// The poses of one class in one frame against its targets there.
struct FrameErrors {
  int targets = 0;
  /// Errors by pose, strongest first, no more than targets; then by target.
  std::vector<std::vector<BopErrors>> errors;
};

/// Frames that have targets, by class with a model, in their order. A frame without poses has none that are correct.
/// Objects whose truth has no pose are no targets. Reads the scene's depth.
using ClassErrors = std::map<std::string, std::vector<FrameErrors>>;
ClassErrors measure_poses(const std::vector<EvaluatedFrame>& frames, const BopScene& scene,
                          const std::map<std::string, BopModel>& models, int threads);

/// Fractions of the targets that have a correct pose, each the mean over its thresholds; NaN without targets.
struct AverageRecall {
  int targets = 0;
  double vsd = 0.0;   ///< recall of errors below 0.05 to 0.5, for each tau of 0.05 to 0.5 diameters
  double mssd = 0.0;  ///< recall of errors below 0.05 to 0.5 diameters
  double mspd = 0.0;  ///< recall of errors below 5 to 50 pixels of an image 640 wide
  double mean = 0.0;  ///< AR, the mean of the three
};

/// Returns the average recall. At each threshold the strongest pose takes the target for which its error is smallest
/// and below it, then the next one among those left. All frames count by their targets, whichever class they are of.
AverageRecall average_recall(const std::vector<FrameErrors>& frames);

/// A scene's figures.
struct LocalisationScores {
  std::map<std::string, AverageRecall> by_class;
  AverageRecall all;  ///< recall over the targets of all classes, each counting once
};
LocalisationScores localisation_scores(const ClassErrors& errors);

}  // namespace houghstream
