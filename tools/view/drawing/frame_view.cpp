#include "tools/view/drawing/frame_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tools/view/drawing/rotated_view.hpp"
#include "tools/view/drawing/teaching_view.hpp"
#include "tools/view/drawing/world_view.hpp"

namespace houghstream::view {
namespace {

constexpr int kBlockWidth = 320;
constexpr int kRows = 6;
constexpr int kRowHeight = 18;
constexpr int kHeading = 24;
constexpr int kBlockHeight = kHeading + kRows * kRowHeight + 6;
constexpr int kKeysHeight = 28;
constexpr int kMargin = 8;
const cv::Scalar kKeysGround(60, 54, 50);
const cv::Scalar kMuted(190, 190, 190);
const cv::Scalar kBright(255, 255, 255);
const cv::Scalar kWarning(80, 170, 255);

// Draws one block of the panel, with its heading; text that does not fit is cut off at its right edge.
class Block {
 public:
  Block(cv::Mat& panel, const cv::Point& corner, const std::string& heading)
      : image_(panel(cv::Rect(corner, cv::Size(kBlockWidth, kBlockHeight)) & cv::Rect({}, panel.size()))) {
    draw_text(image_, heading, {kMargin, kHeading - 7}, kPanelText, kMuted);
  }

  void line(int row, const std::string& text, const cv::Scalar& colour = kBright, int indent = 0) {
    draw_text(image_, text, {kMargin + indent, kHeading + (row + 1) * kRowHeight - 5}, kPanelText, colour);
  }

  void square(int row, const cv::Scalar& colour) {
    cv::rectangle(image_, cv::Rect(kMargin, kHeading + row * kRowHeight + 4, 10, 10), colour, cv::FILLED);
  }

  cv::Rect area() const { return {kMargin, kHeading, kBlockWidth - 2 * kMargin, kRows * kRowHeight}; }
  cv::Mat& image() { return image_; }

 private:
  cv::Mat image_;
};

std::string process_line(const ProcessState& process) {
  if (process.ended) return process.name + " ended";
  std::string text = fmt::format("{} {:.1f} Hz, {} skipped", process.name, process.rate_hz, process.skipped);
  if (process.lost > 0) text += fmt::format(", {} lost", process.lost);
  if (process.refused > 0) text += fmt::format(", {} refused", process.refused);
  return text;
}

std::string colours_line(const ChromaMap& map) {
  return fmt::format("colours x {:.2f}, white a {:+.0f} b {:+.0f}, +-{:.0f}", map.saturation(), map.white().x(),
                     map.white().y(), map.sigma());
}

void draw_stream(Block block, const StreamState& state, const std::string& camera, std::int64_t lost) {
  block.line(0, rates_line(state.frames_hz, lost), lost > 0 ? kWarning : kBright);
  int row = 1;
  const auto colours = state.colours.find(camera);
  if (colours != state.colours.end()) block.line(row++, colours_line(colours->second), kMuted);
  for (const ProcessState& process : state.processes) {
    if (row >= kRows) return;
    const bool wrong = process.lost > 0 || process.refused > 0;
    block.line(row++, process_line(process), process.ended ? kMuted : wrong ? kWarning : kBright);
  }
}

std::string object_line(const Detection& detection, const ObjectPose* pose) {
  std::string text = fmt::format("{} {:.2f}", detection.class_name, detection.score);
  if (pose == nullptr) return text;
  if (!pose->T_camera_object) return text + fmt::format(", {}", to_string(pose->status));
  return text + fmt::format(", {:.2f} m, quality {:.2f}", pose->T_camera_object->translation().z(), pose->quality);
}

const ObjectPose* pose_of(const ViewedFrame& viewed, std::size_t detection) {
  return viewed.poses ? find_pose(*viewed.poses, detection) : nullptr;
}

void draw_objects(Block block, const ViewedFrame& viewed) {
  const std::vector<Detection>& detections = viewed.detections.detections;
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const int row = static_cast<int>(i);
    if (row == kRows - 1 && detections.size() > kRows) {
      block.line(row, fmt::format("and {} more", detections.size() - i), kMuted);
      return;
    }
    block.square(row, class_colour(detections[i].class_id));
    block.line(row, object_line(detections[i], pose_of(viewed, i)), kBright, 16);
  }
}

void draw_keys(cv::Mat image, const FrameViewSettings& settings, bool several_cameras) {
  image.setTo(kKeysGround);
  const int baseline = kKeysHeight - 9;
  draw_text(image,
            fmt::format("q end   space pause   d depth   3 3-D   w world   s save   + - score from {:.2f}{}{}",
                        settings.min_score, several_cameras ? "   c camera" : "",
                        settings.can_teach ? "   t teach (mouse: click or box)" : ""),
            {kMargin, baseline}, 0.45);
  if (settings.paused) draw_text(image, "paused", {std::max(image.cols - 70, 0), baseline}, 0.5, kWarning);
}

}  // namespace

std::string latency_heading(const std::optional<double>& detect_ms, const std::optional<double>& pose_ms) {
  if (!detect_ms) return pose_ms ? fmt::format("poses after {:.0f} ms", *pose_ms) : "no detections";
  const std::string detections = fmt::format("detections after {:.0f} ms, ", *detect_ms);
  return detections + (pose_ms ? fmt::format("poses {:.0f}", *pose_ms) : "no poses");
}

std::string camera_heading(const FrameId& frame, const std::vector<std::string>& cameras) {
  std::string time = fmt::format("frame {:.3f} s", static_cast<double>(frame.utime) * 1e-6);
  if (frame.channel.empty()) return time;
  const auto found = std::find(cameras.begin(), cameras.end(), frame.channel);
  if (cameras.size() < 2 || found == cameras.end()) return frame.channel + ", " + time;
  return fmt::format("{} ({} of {}), {}", frame.channel, found - cameras.begin() + 1, cameras.size(), time);
}

std::string rates_line(double frames_hz, std::int64_t lost) {
  return fmt::format("frames {:.1f} Hz, {}", frames_hz, lost < 0 ? "losses unknown" : fmt::format("{} lost", lost));
}

std::string objects_heading(const ViewedFrame& viewed, float min_score) {
  const std::size_t shown = viewed.detections.detections.size();
  if (min_score <= 0.0F) return fmt::format("{} objects: score, metres, quality of pose", shown);
  return fmt::format("{} of {} objects, from score {:.2f}", shown, shown + viewed.weak, min_score);
}

cv::Mat draw_panel(const ViewedFrame& viewed, const StreamView& stream, const FrameViewSettings& settings, int width) {
  constexpr int kBlocks = 4;
  const int columns = std::clamp(width / kBlockWidth, 1, kBlocks);
  const int blocks_height = (kBlocks + columns - 1) / columns * kBlockHeight;
  cv::Mat panel(blocks_height + (settings.show_keys ? kKeysHeight : 0), std::max(width, kBlockWidth), CV_8UC3,
                kPanelGround);
  const auto corner = [&](int block) {
    return cv::Point(block % columns * kBlockWidth, block / columns * kBlockHeight);
  };
  const std::string frame = camera_heading(viewed.frame.id, stream.cameras);
  draw_stream(Block(panel, corner(0), frame), stream.state, viewed.frame.id.channel, stream.frames_lost);
  draw_objects(Block(panel, corner(1), objects_heading(viewed, settings.min_score)), viewed);
  Block stages(panel, corner(2), "stages, ms");
  draw_stage_list(stages.image(), stages.area(), viewed.poses ? viewed.poses->stages : viewed.detections.stages, kRows);
  Block latency(panel, corner(3), latency_heading(viewed.detect_latency_ms, viewed.pose_latency_ms));
  draw_latency_chart(latency.image(), latency.area(), stream.history);
  if (settings.show_keys) draw_keys(panel.rowRange(blocks_height, panel.rows), settings, stream.cameras.size() > 1);
  return panel.colRange(0, width).clone();
}

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
  RgbdFrame frame = viewed.frame;
  TrackLabels tracks;
  if (stream.state.world && frame.colour.type() == CV_8UC3) {
    frame.colour = frame.colour.clone();
    tracks = draw_tracks(frame.colour, *stream.state.world, viewed.frame);
  }
  cv::Mat image = draw_overlay(frame, viewed.detections, viewed.poses, models, tracks);
  if (!settings.box.empty()) cv::rectangle(image, settings.box, {255, 255, 255}, 1, cv::LINE_AA);
  if (settings.at) cv::drawMarker(image, *settings.at, {255, 255, 255}, cv::MARKER_CROSS, 15, 1, cv::LINE_AA);
  if (stream.state.teaching) draw_teaching(image, *stream.state.teaching, viewed.frame);
  return image;
}

cv::Mat draw_frame_view(const ViewedFrame& all, const ClassModels& models, const FrameViewSettings& settings,
                        const StreamView& stream) {
  const ViewedFrame viewed = without_weak(all, settings.min_score);
  cv::Mat image = draw_over_colour(viewed, models, settings, stream);
  if (settings.show_world) {
    const WorldState world = stream.state.world.value_or(WorldState{});
    cv::hconcat(image, draw_world_from_above(world, viewed.frame.colour.size()), image);
  } else if (settings.show_3d) {
    cv::hconcat(image, draw_rotated_view(viewed.frame, viewed.poses, models), image);
  } else if (settings.show_depth) {
    cv::hconcat(image, colour_depth(viewed.frame.depth, settings.depth_near, settings.depth_far), image);
  }
  cv::vconcat(image, draw_panel(viewed, stream, settings, image.cols), image);
  cv::copyMakeBorder(image, image, 0, image.rows % 2, 0, image.cols % 2, cv::BORDER_REPLICATE);
  return image;
}

}  // namespace houghstream::view
