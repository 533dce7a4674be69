#include "tools/view/drawing/frame_view.hpp"

#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "tools/view/drawing/teaching_view.hpp"
#include "tools/view/drawing/turned_view.hpp"
#include "tools/view/drawing/view_panel.hpp"
#include "tools/view/drawing/world_view.hpp"

namespace houghstream::view {
cv::Mat colour_depth(const cv::Mat& depth, float near, float far) {
  const double per_metre = -255.0 / (far - near);
  cv::Mat warmth;
  depth.convertTo(warmth, CV_8U, per_metre, -per_metre * far);
  cv::Mat image;
  cv::applyColorMap(warmth, image, cv::COLORMAP_TURBO);
  const cv::Mat measured = depth == depth;  // false where there is none (NaN); != would be false there too
  image.setTo(cv::Scalar::all(0), ~measured);
  return image;
}

ViewedFrame without_weak(ViewedFrame viewed, float min_score) {
  std::vector<Detection> strong;
  std::vector<int> new_index(viewed.detections.detections.size(), -1);
  for (std::size_t i = 0; i < new_index.size(); ++i) {
    const Detection& detection = viewed.detections.detections[i];
    const ObjectPose* pose = viewed.poses ? find_pose(*viewed.poses, i) : nullptr;
    if (detection.score < min_score || !is_reported(detection, pose)) continue;
    new_index[i] = static_cast<int>(strong.size());
    strong.push_back(std::move(viewed.detections.detections[i]));
  }
  viewed.weak += new_index.size() - strong.size();
  viewed.detections.detections = std::move(strong);
  if (!viewed.poses) return viewed;
  std::vector<ObjectPose> poses;
  for (ObjectPose& pose : viewed.poses->poses) {
    const bool known = pose.detection_index >= 0 && pose.detection_index < static_cast<int>(new_index.size());
    if (known && new_index[static_cast<std::size_t>(pose.detection_index)] < 0) continue;
    if (known) pose.detection_index = new_index[static_cast<std::size_t>(pose.detection_index)];
    poses.push_back(std::move(pose));
  }
  viewed.poses->poses = std::move(poses);
  return viewed;
}

cv::Mat draw_over_colour(const ViewedFrame& viewed, const ClassModels& models, const FrameViewSettings& settings,
                         const StreamView& stream) {
  cv::Mat picture = draw_overlay(viewed.frame, viewed.detections, viewed.poses, models);
  if (!settings.box.empty()) cv::rectangle(picture, settings.box, {255, 255, 255}, 1, cv::LINE_AA);
  if (settings.at) cv::drawMarker(picture, *settings.at, {255, 255, 255}, cv::MARKER_CROSS, 15, 1, cv::LINE_AA);
  if (stream.state.teaching) draw_teaching(picture, *stream.state.teaching, viewed.frame);
  if (stream.state.world) draw_tracks(picture, *stream.state.world, viewed.frame);
  return picture;
}

cv::Mat draw_frame_view(const ViewedFrame& all, const ClassModels& models, const FrameViewSettings& settings,
                        const StreamView& stream) {
  const ViewedFrame viewed = without_weak(all, settings.min_score);
  cv::Mat picture = draw_over_colour(viewed, models, settings, stream);
  if (settings.show_world) {
    const WorldState world = stream.state.world.value_or(WorldState{});
    cv::hconcat(picture, draw_world_from_above(world, viewed.frame.colour.size()), picture);
  } else if (settings.show_3d) {
    cv::hconcat(picture, draw_turned_view(viewed.frame, viewed.poses, models), picture);
  } else if (settings.show_depth) {
    cv::hconcat(picture, colour_depth(viewed.frame.depth, settings.depth_near, settings.depth_far), picture);
  }
  cv::vconcat(picture, draw_panel(viewed, stream, settings, picture.cols), picture);
  cv::copyMakeBorder(picture, picture, 0, picture.rows % 2, 0, picture.cols % 2, cv::BORDER_REPLICATE);
  return picture;
}

}  // namespace houghstream::view
