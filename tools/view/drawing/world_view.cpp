#include "tools/view/drawing/world_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/view/drawing/overlay.hpp"

namespace houghstream::view {
namespace {

constexpr std::size_t kTrail = 150;  // places
constexpr double kNearM = 0.05;
constexpr int kDisc = 7;  // pixels; radius of an object from above
constexpr double kOfThisTimeS = 0.3;
constexpr std::size_t kCameras = 64;  // a sender of rubbish may make up channels without end

double deviation_of(const TrackedObject& object) {
  return std::sqrt(std::max(0.0, object.covariance.topLeftCorner<3, 3>().trace() / 3.0));
}

bool is_seen(const TrackedObject& object) {
  return object.state == TrackState::kVisible;
}

std::string label_of(const TrackedObject& object) {
  std::string text = fmt::format("#{} {} {:.2f}", object.track_id, object.class_name, object.probability);
  if (!is_seen(object)) text += fmt::format(" ({})", to_string(object.state));
  if (object.moving) text += fmt::format(" {:.2f} m/s", object.velocity.head<3>().norm());
  return text;
}

/// Maps metres of the world to pixels of the image from above.
struct MapScale {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double px_per_m = 300.0;
  cv::Size size;

  /// Positions far outside are drawn no farther out than this: OpenCV steps row by row from the beginning of a shape,
  /// and the largest positions exceed whole numbers of pixels.
  static constexpr double kFarPx = 1e4;

  cv::Point at(const Eigen::Vector3d& place) const {
    const Eigen::Vector2d away = px_per_m * (place.head<2>() - middle);
    return {static_cast<int>(std::lround(std::clamp(0.5 * size.width + away.x(), -kFarPx, kFarPx))),
            static_cast<int>(std::lround(std::clamp(0.5 * size.height - away.y(), -kFarPx, kFarPx)))};
  }
};

MapScale scale_of(const WorldState& world, const cv::Size& size) {
  constexpr double kMinM = 0.4;  // half of what is shown, at least
  Eigen::AlignedBox2d extent;
  for (const TrackedObject& object : world.last.objects) extent.extend(object.T_world_object.translation().head<2>());
  for (const auto& [channel, T] : world.T_world_camera) extent.extend(T.translation().head<2>());
  if (extent.isEmpty()) extent.extend(Eigen::Vector2d::Zero());
  const Eigen::Vector2d half = (0.6 * extent.sizes()).cwiseMax(kMinM);
  return {extent.center(), std::min(0.5 * size.width / half.x(), 0.5 * size.height / half.y()), size};
}

void draw_grid(cv::Mat& image, const MapScale& scale) {
  constexpr double kStepM = 0.1;
  constexpr double kMaxLines = 200.0;
  const Eigen::Vector2d half(0.5 * scale.size.width / scale.px_per_m, 0.5 * scale.size.height / scale.px_per_m);
  const cv::Scalar grey(52, 52, 52);
  for (int axis = 0; axis < 2; ++axis) {
    const double first = std::floor((scale.middle[axis] - half[axis]) / kStepM);
    const double last = std::ceil((scale.middle[axis] + half[axis]) / kStepM);
    if (last - first >= kMaxLines) continue;
    const int lines = static_cast<int>(last - first);
    for (int i = 0; i <= lines; ++i) {
      Eigen::Vector3d place = Eigen::Vector3d::Zero();
      place[axis] = kStepM * (first + i);
      const cv::Point p = scale.at(place);
      const cv::Scalar colour = first + i == 0.0 ? cv::Scalar(90, 90, 90) : grey;
      if (axis == 0)
        cv::line(image, {p.x, 0}, {p.x, image.rows}, colour);
      else
        cv::line(image, {0, p.y}, {image.cols, p.y}, colour);
    }
  }
}

void draw_camera(cv::Mat& image, const MapScale& scale, const std::string& channel, const Eigen::Isometry3d& T) {
  const double reach_m = 24.0 / scale.px_per_m;
  const cv::Point eye = scale.at(T.translation());
  const auto corner = [&](double side) {
    Eigen::Vector3d ray = T.linear() * Eigen::Vector3d(side, 0.0, 1.0);
    ray.z() = 0.0;
    return scale.at(T.translation() + reach_m * ray.normalized());
  };
  const std::vector<cv::Point> wedge = {eye, corner(-0.5), corner(0.5)};
  cv::polylines(image, wedge, true, {200, 200, 200}, 1, cv::LINE_AA);
  draw_text(image, channel, eye + cv::Point(6, 14), 0.38, {190, 190, 190});
}

void draw_object(cv::Mat& image, const MapScale& scale, const TrackedObject& object) {
  const cv::Scalar colour = class_colour(object.class_id);
  const cv::Point place = scale.at(object.T_world_object.translation());
  const int sure = static_cast<int>(std::lround(std::min(2.0 * deviation_of(object) * scale.px_per_m, 1e4)));
  const int max_ring = std::min(image.cols, image.rows) / 4;
  cv::circle(image, place, kDisc, colour, is_seen(object) ? cv::FILLED : 1, cv::LINE_AA);
  if (sure > kDisc && sure <= max_ring) cv::circle(image, place, sure, colour, 1, cv::LINE_AA);
}

Label map_label_of(const MapScale& scale, const TrackedObject& object) {
  const cv::Point place = scale.at(object.T_world_object.translation());
  return {label_of(object), cv::Rect(place.x - kDisc, place.y - kDisc, 2 * kDisc, 2 * kDisc),
          class_colour(object.class_id), object.class_id};
}

// Draws a ring of two standard deviations of the position and returns the object's label. A ring wider than a quarter
// of the image would only hide it: the label names the deviation in its place.
Label draw_ring(cv::Mat& image, const cv::Point& centre, const TrackedObject& object, double metres_per_px) {
  constexpr double kMinPx = 4.0;
  const double max_px = std::max(kMinPx, std::min(image.cols, image.rows) / 8.0);
  const double radius_m = 2.0 * deviation_of(object);
  const cv::Scalar colour = class_colour(object.class_id);
  Label label{label_of(object), cv::Rect(centre, cv::Size(1, 1)), colour, object.class_id};
  const bool is_wide = !(radius_m / metres_per_px <= max_px);
  const int radius = static_cast<int>(is_wide ? kMinPx : std::max(radius_m / metres_per_px, kMinPx));
  if (is_wide)
    label.text += fmt::format(", +-{:.2g} m", radius_m);
  else
    cv::circle(image, centre, radius, colour, is_seen(object) ? 2 : 1, cv::LINE_AA);
  label.thing = cv::Rect(centre.x - radius, centre.y - radius, 2 * radius + 1, 2 * radius + 1);
  return label;
}

// Draws the meaning of the rings at the lower left, and returns its pixels.
cv::Rect draw_ring_legend(cv::Mat& image) {
  constexpr int kHeight = 18;  // pixels
  constexpr int kRadius = 5;
  const std::string text = "position within 2 sigma";
  const cv::Point centre(10, image.rows - kHeight / 2);
  cv::circle(image, centre, kRadius, {255, 255, 255}, 1, cv::LINE_AA);
  draw_text(image, text, centre + cv::Point(kRadius + 4, 4), 0.38);
  const int width = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.38, 1, nullptr).width + 2 * (10 + kRadius);
  return cv::Rect(0, image.rows - kHeight, width, kHeight) & cv::Rect({}, image.size());
}

}  // namespace

void WorldState::add(const WorldObjects& world) {
  if (world.world_number != last.world_number || world.world != last.world) {
    T_world_camera.clear();
    trails.clear();
    boxes.clear();
  }
  last = world;
  if (T_world_camera.size() < kCameras || T_world_camera.count(world.frame.channel) > 0)
    T_world_camera[world.frame.channel] = world.T_world_camera;
  std::map<std::int64_t, std::deque<Eigen::Vector3d>> kept;
  for (const TrackedObject& object : world.objects) {
    std::deque<Eigen::Vector3d>& trail = kept[object.track_id];
    if (const auto known = trails.find(object.track_id); known != trails.end()) trail = std::move(known->second);
    trail.push_back(object.T_world_object.translation());
    if (trail.size() > kTrail) trail.pop_front();
  }
  trails = std::move(kept);
}

void WorldState::add(const ObjectPlacements& placed) {
  if (placed.frame != last.frame || placed.world != last.world || placed.world_number != last.world_number) return;
  boxes.clear();
  for (const ObjectPlacement& object : placed.objects) boxes[object.track_id] = object;
}

TrackLabels draw_tracks(cv::Mat& image, const WorldState& world, const RgbdFrame& frame) {
  TrackLabels drawn;
  const auto camera = world.T_world_camera.find(frame.id.channel);
  const double apart_s = std::abs(seconds_between(world.last.frame.utime, frame.id.utime));
  if (camera == world.T_world_camera.end() || apart_s > kOfThisTimeS) return drawn;
  const Eigen::Isometry3d T_camera_world = camera->second.inverse();
  const auto pixel_of = [&](const Eigen::Vector3d& place) -> std::optional<cv::Point> {
    const Eigen::Vector3d point = T_camera_world * place;
    if (point.z() < kNearM) return std::nullopt;
    const Eigen::Vector2d pixel = frame.camera.project(point).cwiseMax(-1e4).cwiseMin(1e4);
    return cv::Point(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  };
  for (const TrackedObject& object : world.last.objects) {
    const cv::Scalar colour = class_colour(object.class_id);
    std::optional<cv::Point> before;
    for (const Eigen::Vector3d& place : world.trails.at(object.track_id)) {
      const std::optional<cv::Point> here = pixel_of(place);
      if (before && here) cv::line(image, *before, *here, colour, 1, cv::LINE_AA);
      before = here;
    }
    const std::optional<cv::Point> centre = pixel_of(object.T_world_object.translation());
    if (!centre || object.state == TrackState::kGone) continue;
    const double depth = (T_camera_world * object.T_world_object.translation()).z();
    drawn.labels.push_back(draw_ring(image, *centre, object, frame.camera.metres_per_px(depth)));
  }
  if (!drawn.labels.empty()) drawn.occupied.push_back(draw_ring_legend(image));
  return drawn;
}

cv::Mat draw_world_from_above(const WorldState& world, const cv::Size& size) {
  cv::Mat image(size, CV_8UC3, cv::Scalar(30, 30, 30));
  const MapScale scale = scale_of(world, size);
  draw_grid(image, scale);
  for (const auto& [channel, T] : world.T_world_camera) draw_camera(image, scale, channel, T);
  std::vector<Label> labels;
  for (const TrackedObject& object : world.last.objects) {
    std::vector<cv::Point> way;
    for (const Eigen::Vector3d& place : world.trails.at(object.track_id)) way.push_back(scale.at(place));
    cv::polylines(image, way, false, class_colour(object.class_id), 1, cv::LINE_AA);
    if (object.state == TrackState::kGone) continue;
    draw_object(image, scale, object);
    labels.push_back(map_label_of(scale, object));
  }
  constexpr int kCaption = 22;  // pixels
  draw_labels(image, labels, {cv::Rect(0, 0, size.width, kCaption) & cv::Rect({}, size)});
  const auto there = std::count_if(world.last.objects.begin(), world.last.objects.end(),
                                   [](const TrackedObject& object) { return object.state != TrackState::kGone; });
  draw_text(image, fmt::format("{} from above, grid 10 cm, {} objects", world.last.world, there), {8, 16});
  return image;
}

}  // namespace houghstream::view
