#pragma once

#include <optional>
#include <vector>

#include "detector/training/augmentation/augmentation_settings.hpp"
#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// A room into which training views were put, to see what the finished forest makes of it.
struct ValidationFrame {
  struct Object {
    int class_id = 0;
    std::optional<std::uint32_t> view;  ///< index of the training view, if it is one
    cv::Rect box_visible_px;
    double visible_fraction = 0.0;
  };
  RgbdFrame frame;
  std::vector<Object> objects;                  ///< objects that are at all visible
  std::vector<std::uint32_t> distractor_views;  ///< training views of which altered copies stand there too: not objects
};

/// Numbers of objects that are composed into a background.
struct ComposedThings {
  int objects = 0;  ///< number of objects, at most 255
  /// Number of things of either sort: an object's shape and pattern in other colours, and in another size.
  int near_duplicates = 0;
  /// Number of things of either sort: an object's colours and pattern in another width, and its shape with those of
  /// another object.
  int hard_negatives = 0;
};

/// Composes random views on one background, each as in a composite: other distance, light, half of them partly hidden,
/// in front of a background without objects. Depth has the errors of sensor_errors.hpp.
ValidationFrame make_validation_frame(const std::vector<const TrainingView*>& objects, const RgbdFrame& background,
                                      const ComposedThings& things, const AugmentationSettings& settings,
                                      Random& random);

}  // namespace houghstream::training
