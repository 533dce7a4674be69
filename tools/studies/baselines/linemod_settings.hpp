#pragma once

namespace houghstream {

// The defaults were chosen by `hs-study linemod --tune` on rendered training data (4 objects of 108 views; 60 images
// composed over 60 rooms, of views that no template was made of). Mean AUC without and with the check of depth:
//   features 63, step 1.1, gradient 10: 0.474, 0.533 | 31 features: 0.392, 0.499 | step 1.3: 0.387, 0.381
//   step 1.15: 0.449, 0.532 | gradient 30: 0.425, 0.485
//   depth tolerance 0.06, 0.1, 0.15, 0.2: 0.531, 0.533, 0.528, 0.520
//   match threshold 70, 80, 85, 90: 0.475, 0.474, 0.473, 0.452 without; 0.537, 0.533, 0.525, 0.487 with the check;
//   339, 147, 91, 85 ms a frame. The best F1, 0.533 with the check, is at score 0.954 (0.476 at 0.970 without).

/// Settings of the templates. The distances should be those of the scenes, no more: the small templates of farther ones
/// fit almost anything.
struct LinemodTemplateSettings {
  int features = 63;            ///< per modality, 4 to 63 (the most that cv::linemod can add up in a byte)
  float weak_gradient = 10.0F;  ///< weaker colour gradients are ignored, grey levels (three-pixel Sobel)
  float min_distance = 0.35F;   ///< nearest distance taught, metres
  float max_distance = 2.6F;    ///< farthest distance taught, metres
  float distance_step = 1.1F;   ///< ratio of one taught distance to the previous one, above 1
  float focal_px = 0.0F;        ///< focal length of the scenes' camera; 0: that of the views
  int threads = 2;              ///< share the templates; any number finds the same
};

/// Settings of the reported detections.
struct LinemodSelection {
  /// Minimum similarity, percent. cv::linemod searches for (100 + match_threshold) / 2 percent in the half-size image
  /// first: with a threshold as high as the similarities one wants, it misses valid matches silently.
  float match_threshold = 80.0F;
  bool check_depth = false;      ///< is what is seen there as far away as the template?
  float depth_tolerance = 0.1F;  ///< maximum median difference, as a fraction of the distance
  float max_overlap = 0.5F;      ///< IoU from which the stronger of two detections of a class stays alone
  int max_per_class = 250;       ///< maximum, as in the paper's protocol (Haensch et al. 2017, Section 4)
};

}  // namespace houghstream
