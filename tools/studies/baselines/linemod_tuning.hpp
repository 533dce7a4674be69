#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/types/training_view.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"
#include "tools/studies/baselines/linemod_settings.hpp"

namespace houghstream {

/// Holds training data divided into views to teach and images to choose settings on.
struct ComposedExamples {
  std::vector<TrainingView> taught;   ///< three views in four of each class
  std::vector<RgbdFrame> frames;      ///< the others, put into the background views
  std::vector<EvaluatedFrame> truth;  ///< ground truth of the frames; no detections yet
  std::set<std::string> class_names;
};

/// Composes `images` of up to four views each at these distances (metres), lit and partly occluded as
/// make_validation_frame() does; the same for the same views. Throws InputError without background or with less than
/// four views of each class.
ComposedExamples compose_examples(const std::vector<TrainingView>& views, float min_distance, float max_distance,
                                  int images);

/// Holds the result of one choice of settings on composed images.
struct LinemodTrial {
  LinemodTemplateSettings templates;
  LinemodSelection selection;
  int template_count = 0;
  double auc = 0.0;           ///< mean over the classes, see evaluate_class()
  double best_score = 0.0;    ///< score of the operating point with the best F1
  double best_f1 = 0.0;       ///< harmonic mean of precision and recall there, over all classes
  double match_ms = 0.0;      ///< median a frame
  double selection_ms = 0.0;  ///< median a frame
};

/// Tries a grid of settings on `images` composed of one view in four over the background views; templates are made of
/// the other three, so that no image shows what a template was made of. `report` gets each trial as it is done.
/// The match threshold is that of `base_selection`: what it costs and loses shows by tuning again with another.
void tune_linemod(const std::vector<TrainingView>& views, const LinemodTemplateSettings& base,
                  const LinemodSelection& base_selection, int images,
                  const std::function<void(const LinemodTrial&)>& report);

}  // namespace houghstream
