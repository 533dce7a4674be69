#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pose/reconstruction/model/take_model.hpp"

namespace houghstream::teach {

/// Result of a showing: the takes, and the model of all of them.
struct ShowResult {
  std::string name;
  std::vector<reconstruction::Take> takes;
  std::vector<std::vector<reconstruction::MaskedKeyframe>> views;  ///< views of each take
  Mesh mesh;
  double seen_surface = 0.0;  ///< share of the closed surface that some view shows
  bool second_fits = true;    ///< the second take, where there was one
  double deviation_m = 0.0;
  double free_space_violation = 0.0;     ///< reconstruction::free_space_violation()
  std::optional<double> silhouette_iou;  ///< median over the views, with masks that were given
  double seconds = 0.0;                  ///< seconds until the model was there
};

/// Returns the fraction of vertices that were observed.
double covered_fraction(const std::vector<bool>& seen);

/// Assessment of whether a model is worth teaching.
struct ModelAssessment {
  bool good = true;
  std::vector<std::string> reasons;  ///< why not, a line each
};

/// Assesses the merged takes and the model.
ModelAssessment assess_model(const ShowResult& shown);

/// Returns the second of the take at which a frame was taken.
double second_of(const reconstruction::Take& take, int frame);

/// Counts the frames of the take in which the camera's place is known.
int tracked_frames(const reconstruction::Take& take);

/// Returns the directions from which some take shows the object.
reconstruction::ViewCoverage seen_by_all(const ShowResult& shown);

/// Returns by how many degrees a turn missed its beginning.
double degrees_of(const reconstruction::LoopClosureError& loop_error);

/// Describes the verdict and its figures, in a few lines.
std::string describe(const ShowResult& shown, const ModelAssessment& assessment);

}  // namespace houghstream::teach
