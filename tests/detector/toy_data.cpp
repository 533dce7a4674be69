#include "tests/detector/toy_data.hpp"

#include <cmath>

#include "detector/forest/off_axis_slope.hpp"
#include "detector/training/forest_trainer.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream::toy {
namespace {

const Camera kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};
constexpr double kHalfSide = 0.06;  // metres

std::uint8_t byte(double value) {
  return static_cast<std::uint8_t>(std::min(255.0, std::max(0.0, value)));
}

cv::Vec3b tile_colour(int kind, double x, double y) {
  const double wave = kind == 0 ? std::sin(x * 220.0) : std::cos(std::hypot(x, y) * 200.0);
  return kind == 0 ? cv::Vec3b(40, byte(128 + 100 * wave), 200) : cv::Vec3b(byte(128 + 100 * wave), 60, 30);
}

double tile_relief(int kind, double x, double y) {
  return kind == 0 ? 0.015 * std::cos(x * 26.0) : 0.02 * std::cos(std::hypot(x, y) * 20.0);
}

}  // namespace

RgbdFrame background(std::uint64_t seed) {
  Random random(seed);
  RgbdFrame frame;
  frame.camera = kCamera;
  frame.colour.create(kCamera.height, kCamera.width, CV_8UC3);
  frame.depth.create(kCamera.height, kCamera.width, CV_32FC1);
  const double tilt = random.uniform(-0.3, 0.3);
  const cv::Vec3d base(random.uniform(60, 200), random.uniform(60, 200), random.uniform(60, 200));
  for (int y = 0; y < kCamera.height; ++y) {
    for (int x = 0; x < kCamera.width; ++x) {
      const double blotch = 30.0 * std::sin(x * 0.07 + static_cast<double>(seed)) * std::cos(y * 0.05);
      for (int c = 0; c < 3; ++c) frame.colour.at<cv::Vec3b>(y, x)[c] = byte(base[c] + blotch + random.uniform(-8, 8));
      frame.depth.at<float>(y, x) = static_cast<float>(1.6 + tilt * (x - 160) / 160.0 + random.uniform(-0.003, 0.003));
    }
  }
  return frame;
}

namespace {

struct TilePlace {
  double u_px;
  double v_px;
  double distance;
  OffAxisSlope tilt;
};

cv::Mat draw_tile(int kind, const TilePlace& place, RgbdFrame& frame) {
  cv::Mat mask = cv::Mat::zeros(frame.colour.size(), CV_8UC1);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const double tile_x = (x - place.u_px) * place.distance / kCamera.fx;
      const double tile_y = (y - place.v_px) * place.distance / kCamera.fy;
      if (std::fabs(tile_x) > kHalfSide || std::fabs(tile_y) > kHalfSide) continue;
      mask.at<std::uint8_t>(y, x) = 255;
      frame.colour.at<cv::Vec3b>(y, x) = tile_colour(kind, tile_x, tile_y);
      const double gained = place.tilt.right * tile_x + place.tilt.down * tile_y;
      frame.depth.at<float>(y, x) = static_cast<float>(place.distance + gained + tile_relief(kind, tile_x, tile_y));
    }
  }
  return mask;
}

}  // namespace

cv::Mat put_tile(int kind, double u_px, double v_px, double distance, RgbdFrame& frame) {
  const OffAxisSlope tilt = off_axis_slope(kCamera.backproject(u_px, v_px, distance).cast<float>());
  return draw_tile(kind, {u_px, v_px, distance, tilt}, frame);
}

cv::Mat put_upright_tile(int kind, double u_px, double v_px, double distance, RgbdFrame& frame) {
  return draw_tile(kind, {u_px, v_px, distance, {}}, frame);
}

std::vector<TrainingView> training_views() {
  std::vector<TrainingView> views;
  for (int i = 0; i < 24; ++i) {
    TrainingView view;
    view.class_id = 1 + i % 2;
    view.class_name = view.class_id == 1 ? "stripes" : "rings";
    view.frame = background(1000 + static_cast<std::uint64_t>(i));
    view.mask = put_tile(view.class_id - 1, 159.5, 119.5, 0.7, view.frame);
    view.T_camera_object.translation() = Eigen::Vector3d(0, 0, 0.7);
    view.source = "toy view " + std::to_string(i);
    views.push_back(view);
  }
  for (int i = 0; i < 10; ++i) {
    TrainingView empty;
    empty.frame = background(2000 + static_cast<std::uint64_t>(i));
    empty.source = "toy room " + std::to_string(i);
    views.push_back(empty);
  }
  return views;
}

const Forest& forest() {
  static const Forest forest = training::train_forest(training_views(), quick_profile(), [](const auto&) {});
  return forest;
}

const ForestIndex& forest_index() {
  static const ForestIndex index(forest());
  return index;
}

Profile quick_profile() {
  Profile profile = make_profile("realtime");
  training::TrainingSettings& settings = profile.training;
  settings.trees = 5;
  settings.max_depth = 14;
  settings.tests_per_node = 80;
  settings.patches_per_view = 150;
  settings.min_distance = 0.5F;
  settings.max_distance = 1.2F;
  settings.validation_frames = 24;
  return profile;
}

}  // namespace houghstream::toy
