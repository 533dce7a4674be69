#pragma once

#include <vector>

#include "detector/forest/forest_index.hpp"
#include "detector/training/profiles.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::toy {

/// Returns a background of coloured noise 1.6 m away, without an object.
RgbdFrame background(std::uint64_t seed);

/// Puts a 0.12 m wide relief tile with a pattern of its kind (0 or 1) into a frame, its centre `distance` away at pixel
/// (u, v), and returns its mask. It faces the camera: it lies across the ray to its middle.
cv::Mat put_tile(int kind, double u_px, double v_px, double distance, RgbdFrame& frame);

/// Puts a tile perpendicular to the optical axis, as a search without OffAxisSlope assumes everywhere, and returns its
/// mask.
cv::Mat put_upright_tile(int kind, double u_px, double v_px, double distance, RgbdFrame& frame);

/// Returns a few views of both kinds (classes 1 "stripes" and 2 "rings") and background frames.
std::vector<TrainingView> training_views();

/// Returns a forest trained on those views by quick_profile, once in a process.
const Forest& forest();

/// Returns its index for searches.
const ForestIndex& forest_index();

/// Returns the default profile with training settings that take a second.
Profile quick_profile();

}  // namespace houghstream::toy
