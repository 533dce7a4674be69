#include "pose/seen/region.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

/// Returns whole pixels of the box, enlarged and cut to the image. A box with absurd numbers gives an empty one.
cv::Rect enlarged(const cv::Rect2f& box, double by, const cv::Size& image) {
  const auto clip = [](double v, int limit) { return v > 0.0 ? static_cast<int>(std::min<double>(v, limit)) : 0; };
  const int left = clip(std::floor(box.x - by * box.width), image.width);
  const int top = clip(std::floor(box.y - by * box.height), image.height);
  const int right = clip(std::ceil(box.x + (1.0 + by) * box.width), image.width);
  const int bottom = clip(std::ceil(box.y + (1.0 + by) * box.height), image.height);
  return {left, top, std::max(0, right - left), std::max(0, bottom - top)};
}

bool in_range(const DepthRegion& region, float z) {
  return z >= region.nearest && z <= region.farthest;  // false for NaN
}

cv::Mat clipped_pixels(const cv::Mat& colour) {
  constexpr int kWithin = 249;  // JPEG and sharpening leave what is clipped a little below 255
  cv::Mat clipped(colour.size(), CV_8UC1);
  for (int y = 0; y < colour.rows; ++y) {
    const auto* pixels = colour.ptr<cv::Vec3b>(y);
    auto* out = clipped.ptr<std::uint8_t>(y);
    for (int x = 0; x < colour.cols; ++x) {
      const cv::Vec3b& pixel = pixels[x];
      out[x] = std::max({pixel[0], pixel[1], pixel[2]}) > kWithin ? 255 : 0;
    }
  }
  cv::dilate(clipped, clipped, cv::Mat());
  return clipped;
}

}  // namespace

DepthRegion find_region(const RgbdFrame& frame, const Detection& detection, const ObjectModel& model,
                        const RegionSettings& settings) {
  DepthRegion region;
  region.box_px = enlarged(detection.box_px, settings.enlarge, frame.depth.size());
  // The model's farthest point from where the detection is.
  const float reach =
      (model.centre - model.vote_centre).norm() + model.radius + static_cast<float>(settings.gate_margin_m);
  region.nearest = std::max(0.0F, detection.centre_camera.z() - reach);
  region.farthest = detection.centre_camera.z() + reach;
  for (int y = region.box_px.y; y < region.box_px.br().y; ++y) {
    const float* depth = frame.depth.ptr<float>(y);
    for (int x = region.box_px.x; x < region.box_px.br().x; ++x) region.points += in_range(region, depth[x]) ? 1 : 0;
  }
  return region;
}

std::vector<Eigen::Vector3f> region_points(const RgbdFrame& frame, const DepthRegion& region, int maximum) {
  std::vector<Eigen::Vector3f> points;
  const int stride =
      std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(region.points) / maximum))));
  for (int y = region.box_px.y; y < region.box_px.br().y; y += stride) {
    const float* depth = frame.depth.ptr<float>(y);
    for (int x = region.box_px.x; x < region.box_px.br().x; x += stride) {
      if (in_range(region, depth[x])) points.push_back(frame.camera.backproject(x, y, depth[x]).cast<float>());
    }
  }
  return points;
}

LabRegion lab_region(const RgbdFrame& frame, const cv::Rect& part_px, const AffineBrightness& tone) {
  LabRegion region{{}, part_px.tl(), clipped_pixels(frame.colour(part_px))};
  cv::blur(frame.colour(part_px), region.lab, cv::Size(3, 3));
  if (tone.changes()) apply_affine_brightness(tone, region.lab, region.lab);
  cv::cvtColor(region.lab, region.lab, cv::COLOR_BGR2Lab);
  return region;
}

FrameContext make_frame_context(const RgbdFrame& frame, const RegionSettings& settings, const DepthNoise& noise) {
  return {frame, noise, fit_affine_brightness(frame.colour, settings.tone)};
}

ObjectObservation observe_object(const FrameContext& context, const Detection& detection, const ObjectModel& model,
                                 const RegionSettings& settings) {
  const DepthRegion region = find_region(context.frame, detection, model, settings);
  ObjectObservation object{context.frame, model};
  object.centre_camera = detection.centre_camera;
  object.noise = context.noise;
  object.region = region;
  if (region.points >= settings.min_points) object.colours = lab_region(context.frame, region.box_px, context.tone);
  return object;
}

double distance_from_detected(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object) {
  return (T_camera_object * observation.model.vote_centre.cast<double>() - observation.centre_camera.cast<double>())
      .norm();
}

}  // namespace houghstream
