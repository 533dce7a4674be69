#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "pose/reconstruction/map/keyframe_map.hpp"
#include "pose/reconstruction/selection/object_selection.hpp"

namespace houghstream::reconstruction {

/// Pixels that show the object, or a hand on it: CV_8UC1, 255 where the measured point lies above the table and within
/// the selected object's bounds. World: z up, origin at the object's foot.
cv::Mat object_pixels(const FrameLevel& level, const SelectedObject& object, const Eigen::Isometry3d& T_camera_world);

/// Returns points of the whole scene in a keyframe, for a moving camera; those of the table are marked.
/// Camera frame.
LevelPoints points_of_scene(const Keyframe& keyframe);

/// Returns points of the object alone, while it rotates before the camera: without a hand, which violates free space of
/// keyframes of `map`, or has the colour of skin where the object has not. `region_px` is the part of the keyframe's
/// frame in its levels. Camera frame.
LevelPoints points_of_object(const Keyframe& keyframe, const KeyframeMap& map, const SelectedObject& object,
                             const cv::Rect& region_px);

}  // namespace houghstream::reconstruction
