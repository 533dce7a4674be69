#include "detector/training/augmentation/composites.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/forest/off_axis_slope.hpp"
#include "detector/training/augmentation/dehazing.hpp"

namespace houghstream::training {
namespace {

constexpr double kBaselineM = 0.075;  // projector to camera, PrimeSense and Kinect

/// Draws a turned rectangle or ellipse around a point of the object's outline box.
cv::Mat random_shape(const cv::Rect& object_px, cv::Size size, Random& random) {
  const double side = std::sqrt(static_cast<double>(object_px.area()));
  const cv::Point2f centre(static_cast<float>(object_px.x + random.uniform(-0.3, 1.3) * object_px.width),
                           static_cast<float>(object_px.y + random.uniform(0.0, 1.4) * object_px.height));
  const cv::RotatedRect shape(centre,
                              cv::Size2f(static_cast<float>(side * random.uniform(0.4, 1.6)),
                                         static_cast<float>(side * random.uniform(0.4, 1.6))),
                              static_cast<float>(random.uniform() < 0.6 ? 0.0 : random.uniform(-90.0, 90.0)));
  cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
  if (random.uniform() < 0.5) {
    cv::ellipse(mask, shape, cv::Scalar(255), cv::FILLED);
  } else {
    std::array<cv::Point2f, 4> corners;
    shape.points(corners.data());
    std::vector<cv::Point> polygon(corners.begin(), corners.end());
    cv::fillConvexPoly(mask, polygon, cv::Scalar(255));
  }
  return mask;
}

/// Removes depth where the occluder hides the projector, to the right of the camera: to the left of each occluded run.
void cast_shadow(const cv::Mat& occluder, double occluder_depth, RgbdFrame& frame) {
  for (int y = 0; y < occluder.rows; ++y) {
    auto* depth = frame.depth.ptr<float>(y);
    const auto* hides = occluder.ptr<std::uint8_t>(y);
    for (int x = 1; x < occluder.cols; ++x) {
      if (hides[x] == 0 || hides[x - 1] != 0) continue;
      for (int s = x - 1; s >= 0; --s) {
        const double width = frame.camera.fx * kBaselineM * (1.0 / occluder_depth - 1.0 / depth[s]);
        if (std::isfinite(depth[s]) && width < x - s) break;
        depth[s] = std::numeric_limits<float>::quiet_NaN();
        if (x - s > 40) break;
      }
    }
  }
}

}  // namespace

void add_occluder(const RgbdFrame& room, double object_distance, Composite& composite, Random& random) {
  constexpr int kTries = 8;
  const cv::Rect object_px = cv::boundingRect(composite.mask);
  const int whole = cv::countNonZero(composite.mask);
  cv::Mat shape;
  for (int i = 0; i < kTries; ++i) {
    shape = random_shape(object_px, composite.mask.size(), random);
    const int left = whole - cv::countNonZero(shape & composite.mask);
    if (left <= 0.9 * whole && left >= 0.2 * whole) break;
    shape.release();
  }
  if (shape.empty()) return;

  const cv::Point from(random.between(0, room.colour.cols - shape.cols),
                       random.between(0, room.colour.rows - shape.rows));
  const double depth = std::max(0.3, object_distance - random.uniform(0.04, 0.35));
  const double slope_x = random.uniform(-0.5, 0.5) * depth / composite.frame.camera.fx;
  const double sigma = axial_noise(depth);
  cast_shadow(shape, depth, composite.frame);
  composite.occluder = shape;
  for (int y = 0; y < shape.rows; ++y) {
    for (int x = 0; x < shape.cols; ++x) {
      if (shape.at<std::uint8_t>(y, x) == 0) continue;
      composite.frame.colour.at<cv::Vec3b>(y, x) = room.colour.at<cv::Vec3b>(from.y + y, from.x + x);
      composite.frame.depth.at<float>(y, x) =
          static_cast<float>(depth + slope_x * (x - object_px.x) + sigma * random.normal());
      composite.mask.at<std::uint8_t>(y, x) = 0;
    }
  }
}

namespace {

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
}

struct Patchwork {
  cv::Mat colour;
  cv::Mat depth;
  cv::Mat mask;
  cv::Rect box_px;  // box of the object in the view
};

Patchwork resized_object(const TrainingView& view, double scale, double sharpness) {
  Patchwork part;
  part.box_px = cv::boundingRect(view.mask);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(part.box_px.width * scale))),
                      std::max(1, static_cast<int>(std::lround(part.box_px.height * scale))));
  cv::resize(apply_unsharp_mask(view.frame.colour(part.box_px), sharpness), part.colour, size, 0, 0,
             scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::resize(view.frame.depth(part.box_px), part.depth, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(view.mask(part.box_px), part.mask, size, 0, 0, cv::INTER_NEAREST);
  return part;
}

/// Returns the change of depth that moves the view to its place in `out`.
DepthChange depth_change(const TrainingView& view, double distance, const Composite& out) {
  const Eigen::Vector3d centre = view.T_camera_object.translation();
  const Eigen::Vector2d view_px = view.frame.camera.project(centre);
  DepthChange change;
  change.shift = static_cast<float>(distance - centre.z());
  change.centre_px = out.origin_px + out.scale * cv::Point2d(view_px.x(), view_px.y());
  const cv::Point2d& px = change.centre_px;
  const OffAxisSlope there = off_axis_slope(out.frame.camera.backproject(px.x, px.y, distance).cast<float>());
  const OffAxisSlope slope = off_axis_slope(centre.cast<float>());
  change.tilt =
      out.frame.camera.metres_per_px(distance) * cv::Point2d(there.right - slope.right, there.down - slope.down);
  const double extra_sq = std::pow(axial_noise(distance), 2) - std::pow(axial_noise(centre.z()), 2);
  change.extra_sigma = std::sqrt(std::max(0.0, extra_sq));
  return change;
}

void paste(const Patchwork& part, cv::Point at, Composite& out, Random& random) {
  const DepthChange& change = out.depth_change;
  for (int y = 0; y < part.mask.rows; ++y) {
    for (int x = 0; x < part.mask.cols; ++x) {
      if (part.mask.at<std::uint8_t>(y, x) == 0) continue;
      const cv::Point to(at.x + x, at.y + y);
      out.frame.colour.at<cv::Vec3b>(to) = part.colour.at<cv::Vec3b>(y, x);
      const auto noise = static_cast<float>(change.extra_sigma > 0 ? change.extra_sigma * random.normal() : 0.0);
      out.frame.depth.at<float>(to) = part.depth.at<float>(y, x) + change.at(to) + noise;
      out.mask.at<std::uint8_t>(to) = 255;
    }
  }
}

/// Puts the plane on which the object stands under it, as far as a table might reach: in the colours of a part of the
/// room, behind what is nearer.
void put_on_support(const TrainingView& view, const RgbdFrame& room, Composite& out, Random& random) {
  const double reach_m = random.uniform(0.15, 0.6);
  const Eigen::Vector3d centre = view.T_camera_object.translation();
  const cv::Size size = out.mask.size();
  const cv::Point from(random.between(0, room.colour.cols - size.width),
                       random.between(0, room.colour.rows - size.height));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (out.mask.at<std::uint8_t>(y, x) != 0) continue;
      const cv::Point2d view_px = (cv::Point2d(x, y) - out.origin_px) / out.scale;
      const Eigen::Vector3d ray = view.frame.camera.backproject(view_px.x, view_px.y, 1.0);
      const double towards = -view.support->normal().dot(ray);
      if (towards <= 0.0) continue;  // beyond the horizon
      const double z = view.support->offset() / towards;
      if (!(z > 0.0 && (z * ray - centre).norm() < reach_m)) continue;
      const float depth = static_cast<float>(z) + out.depth_change.at({static_cast<double>(x), static_cast<double>(y)});
      float& behind = out.frame.depth.at<float>(y, x);
      if (behind < depth) continue;
      behind = depth + static_cast<float>(axial_noise(static_cast<double>(depth)) * random.normal());
      out.frame.colour.at<cv::Vec3b>(y, x) = room.colour.at<cv::Vec3b>(from.y + y, from.x + x);
    }
  }
}

/// Draws a part of the background that could lie behind something at this distance: little of it is nearer.
cv::Rect place_behind(const RgbdFrame& background, cv::Size size, double distance, Random& random) {
  constexpr int kTries = 12;
  constexpr int kStep = 8;
  cv::Rect best;
  int best_nearer = size.area();
  for (int i = 0; i < kTries && best_nearer * kStep * kStep > size.area() / 20; ++i) {
    const cv::Rect place(random.between(0, background.colour.cols - size.width),
                         random.between(0, background.colour.rows - size.height), size.width, size.height);
    int nearer = 0;
    for (int y = place.y; y < place.br().y; y += kStep) {
      for (int x = place.x; x < place.br().x; x += kStep) {
        nearer += background.depth.at<float>(y, x) < distance - 0.02 ? 1 : 0;
      }
    }
    if (nearer >= best_nearer) continue;
    best = place;
    best_nearer = nearer;
  }
  return best;
}

}  // namespace

double axial_noise(double z) {
  return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
}

void jitter_lighting(cv::Mat& colour, double strength, double darkest_stops, double brightest_stops, Random& random) {
  if (strength == 0.0) return;
  const double gain = std::exp2(strength * random.uniform(darkest_stops, brightest_stops));
  const double gamma = std::exp2(strength * random.uniform(-0.25, 0.25));
  const double haze = strength * std::max(0.0, random.uniform(-20.0, 20.0));
  const double noise = strength * random.uniform(0.0, 4.0);
  std::array<std::array<double, 256>, 3> table{};
  for (auto& channel : table) {
    const double cast = std::exp2(strength * random.uniform(-0.12, 0.12));
    for (std::size_t v = 0; v < channel.size(); ++v) {
      const double toned = 255.0 * std::pow(static_cast<double>(v) / 255.0, gamma) * gain * cast;
      channel[v] = haze + toned * (255.0 - haze) / 255.0;
    }
  }
  for (int y = 0; y < colour.rows; ++y) {
    for (int x = 0; x < colour.cols; ++x) {
      cv::Vec3b& pixel = colour.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) {
        const double value = table[static_cast<std::size_t>(c)][pixel[c]];
        pixel[c] = to_byte(value + noise * (random.uniform(-1.7, 1.7)));
      }
    }
  }
}

void jitter_exposure(cv::Mat& colour, double strength, Random& random) {
  jitter_lighting(colour, strength, -1.4, 0.7, random);
}

std::optional<Composite> make_composite(const TrainingView& view, const RgbdFrame& background, double distance,
                                        const AugmentationSettings& settings, Random& random) {
  constexpr double kMaxSharpness = 1.5;
  constexpr int kMargin = 48;  // frame pixels around the object: patches at its edge see the room
  const double view_distance = view.T_camera_object.translation().z();
  Composite out;
  out.scale = view_distance / distance * background.camera.fx / view.frame.camera.fx;
  const bool sharpen = settings.sharpened_fraction > 0.0 && random.uniform() < settings.sharpened_fraction;
  const Patchwork part = resized_object(view, out.scale, sharpen ? kMaxSharpness * random.uniform() : 0.0);
  const cv::Size window(part.mask.cols + 2 * kMargin, part.mask.rows + 2 * kMargin);
  if (window.width > background.colour.cols || window.height > background.colour.rows) return std::nullopt;

  const cv::Rect place = place_behind(background, window, distance, random);
  out.frame.colour = background.colour(place).clone();
  out.frame.depth = background.depth(place).clone();
  out.frame.camera = background.camera.cropped(place.x, place.y, place.width, place.height);
  out.mask = cv::Mat::zeros(window, CV_8UC1);
  const double half_px = 0.5 * (out.scale - 1.0);  // resizing leaves the first pixel's edge where it is, not its centre
  out.origin_px =
      cv::Point2d(kMargin - part.box_px.x * out.scale + half_px, kMargin - part.box_px.y * out.scale + half_px);

  Patchwork lit = part;
  if (random.uniform() < settings.dehazed_fraction) remove_haze(lit.mask, lit.colour, random);
  jitter_lighting(lit.colour, settings.lighting_variation, -0.4, 0.4, random);
  out.depth_change = depth_change(view, distance, out);
  paste(lit, cv::Point(kMargin, kMargin), out, random);
  if (view.support && random.uniform() < settings.supported_fraction) put_on_support(view, background, out, random);
  out.whole_px = cv::countNonZero(out.mask);
  if (random.uniform() < settings.occluded_fraction) add_occluder(background, distance, out, random);
  jitter_exposure(out.frame.colour, settings.lighting_variation, random);
  return out;
}

}  // namespace houghstream::training
