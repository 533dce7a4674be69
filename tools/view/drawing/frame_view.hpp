#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/view/drawing/latency_chart.hpp"
#include "tools/view/drawing/overlay.hpp"
#include "tools/view/drawing/stream_watch.hpp"

namespace houghstream::view {

/// Holds one frame with all its results from the bus.
struct ViewedFrame {
  RgbdFrame frame;
  Detections detections;
  std::optional<ObjectPoses> poses;         ///< nothing without a result of a pose process
  std::optional<double> detect_latency_ms;  ///< time from the arrival of the frame to that of its detections
  std::optional<double> pose_latency_ms;    ///< time from the arrival of the frame to that of its poses
  std::size_t weak = 0;                     ///< detections that were sent and are not among these
};

/// Settings of the image besides the overlay.
struct FrameViewSettings {
  float min_score = 0.0F;       ///< weaker detections and their poses are not drawn; 0: all that were sent
  bool show_depth = true;       ///< depth, colour-mapped, to the right
  bool show_world = false;      ///< show the world from above there instead, where hs-track publishes it
  bool show_3d = false;         ///< there the measured points, seen from elsewhere, instead (rotated_view.hpp)
  float depth_near = 0.4F;      ///< metres, red end of the colour map
  float depth_far = 3.5F;       ///< metres, blue end; beyond it stays blue
  bool show_keys = false;       ///< a line that names the window's keys
  bool paused = false;          ///< stated in that line
  bool can_teach = false;       ///< that line names the key for teaching
  cv::Rect box;                 ///< box drawn with the mouse, pixels of the colour image; empty = none
  std::optional<cv::Point> at;  ///< pixel clicked with the mouse
};

/// Holds what the panel below the images shows of the stream as a whole.
struct StreamView {
  StreamState state;
  std::int64_t frames_lost = 0;      ///< frames that never arrived here; -1 = unknown
  std::vector<std::string> cameras;  ///< channels that frames come on, in order
  LatencyHistory history;
};

/// Returns depth (CV_32FC1, metres) as BGR: near is warm, far is cold, no measurement is black.
cv::Mat colour_depth(const cv::Mat& depth, float near, float far);

/// Returns the frame without detections weaker than `min_score` or not reported, which are counted, and without their
/// poses.
ViewedFrame without_weak(ViewedFrame viewed, float min_score);

/// The colour image with all that is drawn over it. Throws InputError as draw_overlay does.
cv::Mat draw_over_colour(const ViewedFrame& viewed, const ClassModels& models, const FrameViewSettings& settings,
                         const StreamView& stream);

/// Draws the whole image, CV_8UC3: overlay, depth or 3-D beside it, and below them the panel. Its size is even in both
/// directions, as video encoders require. Throws InputError as draw_overlay does.
cv::Mat draw_frame_view(const ViewedFrame& all, const ClassModels& models, const FrameViewSettings& settings,
                        const StreamView& stream = {});

/// Returns the heading that names frame and camera: "LEFT_CAMERA (1 of 2), frame 1499876543.210 s".
std::string camera_heading(const FrameId& frame, const std::vector<std::string>& cameras);

/// Returns the heading of the latency chart: after how many milliseconds detections and poses came. What is followed
/// from frame to frame has poses without detections.
std::string latency_heading(const std::optional<double>& detect_ms, const std::optional<double>& pose_ms);

/// Returns the rate of frames and the number of those lost: "frames 30.0 Hz, 2 lost". A negative number is unknown.
std::string rates_line(double frames_hz, std::int64_t lost);

/// Returns the heading with the numbers of shown and received objects. The minimum score is hs-view's own; that of the
/// detector, below which it sends nothing, is not on the wire.
std::string objects_heading(const ViewedFrame& viewed, float min_score);

/// Draws four blocks of text and charts below the images: the stream's rates and losses, the objects of the frame, the
/// times of its stages, and the latency of the last frames. They stand side by side as far as `width` pixels allow, the
/// others below. With `settings.show_keys` a line that names the keys follows.
cv::Mat draw_panel(const ViewedFrame& viewed, const StreamView& stream, const FrameViewSettings& settings, int width);

}  // namespace houghstream::view
