#pragma once

#include <optional>

#include "drivers/files/json_file.hpp"
#include "tools/studies/teach/kept_takes.hpp"

namespace houghstream::studies {

/// A motion by which two poses differ.
struct PoseGap {
  double shift_m = 0.0;  ///< shift of the object's middle
  double angle_rad = 0.0;
};

/// Medians and 95 % points of distances, metres.
struct Spread {
  double median = 0.0;
  double maximum = 0.0;
};

/// Result of comparing the reconstruction of a shown object with the ground truth.
struct ShownComparison {
  /// Pose of the taught model's frame in that of the ground-truth mesh: the mean over the poses of the first take's
  /// frames, then registered by shape.
  Eigen::Isometry3d T_true_taught = Eigen::Isometry3d::Identity();
  Spread taught_to_true;            ///< distances from points on the taught surface to the ground truth
  Spread seen_to_taught;            ///< distances from ground-truth points that the takes saw to the taught surface
  double missing_fraction = 0.0;    ///< fraction of these points farther than 5 mm
  double seen_surface = 0.0;        ///< share of the true surface that the takes saw
  PoseGap drift;                    ///< difference between the first and the last tracked frame of the first take
  Spread tracking_shift;            ///< distances of the tracked frames from their average
  double tracking_angle_rad = 0.0;  ///< the 95 % point
  int tracked = 0;                  ///< frames of the first take
  std::optional<PoseGap> second;    ///< difference of the second take's views from the first's; none without them
  double mask_iou = 0.0;            ///< mean over the kept views
  double min_mask_iou = 0.0;
  int views = 0;
};

/// Compares KEPT (of hs-teach show --keep) with the ground truth. Throws InputError where KEPT holds no poses or no
/// views.
ShownComparison compare_shown(const TrueTakes& takes, const std::filesystem::path& kept, const Mesh& taught);

/// Returns figures in millimetres and degrees.
OrderedJson to_json(const ShownComparison& comparison);

}  // namespace houghstream::studies
