#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/files/json_file.hpp"
#include "pose/verification/quality.hpp"
#include "tools/teach/mesh/quality_examples.hpp"

namespace houghstream::quality {

/// Fits bias, weights and mean terms of the examples, with the numbers in use as a prior of the weight of ten poses:
/// where nearly all detected objects are present, the examples hardly show the depth of missing ones. `min_quality` is
/// the default's. Throws InputError unless some are correct and some are incorrect.
QualitySettings fit_quality(const std::vector<Example>& examples);

/// A pose with the quality that a fit gives it.
struct CheckedPose {
  float quality = 0.0F;
  bool is_correct = false;  ///< up to the symmetries of the shape, which is what the fit learns
};

/// Returns the examples with their qualities by these settings, in their order.
std::vector<CheckedPose> check_by(const QualitySettings& settings, const std::vector<Example>& examples);

/// Checks every `parts`-th scene, in the order of the examples, by a fit of the others, until all are checked. Throws
/// InputError where there are fewer scenes than parts, and as fit_quality().
std::vector<CheckedPose> check_by_scene(const std::vector<Example>& examples, int parts);

/// Poses that are published from a quality on.
struct Published {
  int poses = 0;
  int correct = 0;
  double correct_fraction() const;  ///< NaN without poses
};
Published published_from(const std::vector<CheckedPose>& checked, float minimum);

/// Returns the minimum of 0.05, 0.1, ... 0.95 from which at least this fraction of the poses is correct; nothing where
/// none is.
std::optional<float> min_quality(const std::vector<CheckedPose>& checked, double correct_fraction);

/// Holds the result of hs-study quality.
struct Learnt {
  int scenes = 0;
  int examples = 0;
  int correct = 0;
  QualitySettings settings;
  std::vector<CheckedPose> checked;  ///< each by a fit that has not seen its scene
  Published in_use;                  ///< published poses by the settings in use, from their `min_quality` on
};

/// Minimum number of scenes with poses for learn_quality().
inline constexpr int kMinScenes = 4;

/// Runs fit_quality(), and determines its `min_quality` by four parts of the scenes. Throws InputError as those, and
/// where no quality is enough for 98 %.
Learnt learn_quality(const std::vector<Example>& examples);

/// Returns the initialisers of QualitySettings' members in C++.
std::string to_initialisers(const QualitySettings& settings);

/// Returns {"scenes", "examples", "right", "bias", "weights": {TERM: }, "typical": {TERM: }, "least", "in_use":
/// {"poses", "right", "correct_fraction"}, "published": [{"from", "poses", "right", "correct_fraction"}]}; the last is
/// of scenes that the fit has not seen.
OrderedJson to_json(const Learnt& learnt);

}  // namespace houghstream::quality
