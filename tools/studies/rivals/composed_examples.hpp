#pragma once

#include <set>
#include <string>
#include <vector>

#include "pipeline/types/training_view.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"

namespace houghstream {

/// Training data parted into what to teach and pictures to choose settings on.
struct ComposedExamples {
  std::vector<TrainingView> taught;   ///< three views in four of each class
  std::vector<RgbdFrame> frames;      ///< the others, put into the background views
  std::vector<EvaluatedFrame> truth;  ///< of the frames; no detections yet
  std::set<std::string> class_names;
};

/// `pictures` of up to four views each at these distances (metres), lit and partly hidden as make_validation_frame()
/// does; the same for the same views. Throws InputError without background or with less than four views of each class.
ComposedExamples compose_examples(const std::vector<TrainingView>& views, float min_distance, float max_distance,
                                  int pictures);

}  // namespace houghstream
