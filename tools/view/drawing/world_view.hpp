#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <opencv2/core.hpp>
#include <string>

#include "pipeline/types/camera.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/placed_objects.hpp"
#include "pipeline/types/tracked_object.hpp"
#include "tools/view/drawing/overlay.hpp"

namespace houghstream::view {

/// Holds the last message of hs-track, the boxes about its objects, and their earlier positions.
struct WorldState {
  WorldObjects last;
  std::map<std::string, Eigen::Isometry3d> T_world_camera;     ///< last, by channel (64 at most)
  std::map<std::int64_t, std::deque<Eigen::Vector3d>> trails;  ///< positions of the last seconds by track_id, metres

  std::map<std::int64_t, ObjectPlacement> boxes;  ///< last known ones by track_id; empty without models

  /// A new world has no past.
  void add(const WorldObjects& world);
  /// Adds the boxes of the same frame as `last`; others are ignored.
  void add(const ObjectPlacements& placed);
};

/// Draws over an image of a frame (CV_8UC3, BGR) the objects of the world in it: a ring of two standard deviations of
/// the position, unless it is wider than a quarter of the image, the path of the last seconds, and a legend. Rings of
/// objects that are not visible are thin. Returns the labels, which are not drawn: number, class, probability, state,
/// and the deviation where there is no ring. Draws and returns nothing for a frame of another time than the world.
TrackLabels draw_tracks(cv::Mat& image, const WorldState& world, const RgbdFrame& frame);

/// Draws the world from above, x to the right and y up, in that size (CV_8UC3): objects as discs with their numbers and
/// paths, cameras as wedges along their optical axes, and a grid of 10 cm.
cv::Mat draw_world_from_above(const WorldState& world, const cv::Size& size);

}  // namespace houghstream::view
