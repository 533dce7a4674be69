#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "tools/view/drawing/labels.hpp"

namespace houghstream::view {

/// Models by class name, metres, in the object frame of the poses. A class without one gets no outline.
using ClassModels = std::map<std::string, Mesh>;

inline constexpr float kNearPlane = 0.05F;  ///< metres; nothing nearer is drawn
inline constexpr double kPanelText = 0.42;  ///< scale of the text beside the image
inline const cv::Scalar kPanelGround(38, 34, 32);

/// Labels of the tracks that are drawn in an image.
struct TrackLabels {
  std::vector<Label> labels;       ///< of tracks
  std::vector<cv::Rect> occupied;  ///< pixels that no label covers: the legend
};

/// Returns the colour (BGR) in which a class is drawn everywhere: eight that are distinct for colour-blind eyes (Okabe
/// and Ito 2008), then again from the first.
cv::Scalar class_colour(int class_id);

/// Returns a copy of the frame's colour image with, for every detection, its box, name and score; with poses also the
/// outline of the model, the object's axes (x red, y green, z blue), or the reason why there is no pose. Throws
/// InputError when detections or poses are not of this frame, or a pose names no detection. An object has one label: a
/// detection of a track's class whose box holds the track's centre has the track's label instead of its own.
cv::Mat draw_overlay(const RgbdFrame& frame, const Detections& detections, const std::optional<ObjectPoses>& poses,
                     const ClassModels& models, const TrackLabels& tracks = {});

/// Poses without detections, as hs-pose --follow sends them, with a detection for each: the box of its model, or of ten
/// centimetres around its origin where there is no model. What has no pose has no box, and is left out.
struct BoxedPoses {
  Detections detections;
  ObjectPoses poses;
};
BoxedPoses boxed(const ObjectPoses& followed, const ClassModels& models, const Camera& camera);

/// Draws the outline of the pose's model, where there is one, and its axes; nothing where there is no pose.
void draw_pose(cv::Mat& image, const ObjectPose& pose, const ClassModels& models, const Camera& camera);

/// Text that stays readable on any background: light, with a dark rim. `origin_px` is the left end of its baseline.
void draw_text(cv::Mat& image, const std::string& text, cv::Point origin_px, double scale = 0.45,
               const cv::Scalar& colour = {255, 255, 255});

}  // namespace houghstream::view
