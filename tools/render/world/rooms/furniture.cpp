#include "tools/render/world/rooms/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream::world {
namespace {

cv::Scalar paint(Random& random) {
  return hsv(random.uniform(0, 360), random.uniform(0.0, 0.5), random.uniform(0.15, 0.9));
}

cv::Mat wood_or_paint(Random& random) {
  return chance(random, 0.6) ? wood({512, 256}, random) : plain({512, 256}, paint(random), 0.06, random);
}

ThingPtr from_parts(const char* name, const std::vector<Part>& parts, float gloss, float glow = 0.0F) {
  return make_asset(name, compose(parts), gloss, glow);
}

}  // namespace

ThingPtr make_table(const Eigen::Vector2d& half, double height, const cv::Mat& top, Random& random) {
  constexpr double kThickness = 0.03;
  const cv::Mat frame = wood_or_paint(random);
  BoxFaces faces;
  faces.top = top;
  faces.front = frame;
  std::vector<Part> parts = {at(box({2 * half.x(), 2 * half.y(), kThickness}, faces), {0, 0, -0.5 * kThickness})};
  const double leg = height - kThickness;
  for (const double x : {-0.92, 0.92}) {
    for (const double y : {-0.88, 0.88}) {
      parts.push_back(at(box({0.045, 0.045, leg}, frame), {x * half.x(), y * half.y(), -kThickness - 0.5 * leg}));
    }
  }
  return from_parts("table", parts, 0.12F);
}

ThingPtr make_chair(Random& random) {
  const cv::Mat frame = wood_or_paint(random);
  const cv::Mat seat = fabric({256, 256}, paint(random), random);
  std::vector<Part> parts = {at(box({0.44, 0.42, 0.05}, seat), {0, 0, 0.45}),
                             at(box({0.42, 0.04, 0.36}, seat), {0, 0.19, 0.8})};
  for (const double x : {-0.19, 0.19}) {
    parts.push_back(at(box({0.03, 0.03, 0.43}, frame), {x, -0.18, 0.215}));
    parts.push_back(at(box({0.03, 0.03, 0.95}, frame), {x, 0.2, 0.475}));
  }
  return from_parts("chair", parts, 0.1F);
}

ThingPtr make_bookshelf(Random& random) {
  const cv::Mat board = wood_or_paint(random);
  const double width = random.uniform(0.7, 1.1);
  constexpr double kDepth = 0.28;
  constexpr int kRows = 5;
  constexpr double kRowHeight = 0.34;
  std::vector<Part> parts = {
      at(box({width, 0.015, kRows * kRowHeight}, board), {0, 0.5 * kDepth, 0.5 * kRows * kRowHeight})};
  for (const double side : {-0.5, 0.5})
    parts.push_back(at(box({0.02, kDepth, kRows * kRowHeight}, board), {side * width, 0, 0.5 * kRows * kRowHeight}));
  std::vector<cv::Mat> spines;
  constexpr int kSpines = 10;
  spines.reserve(kSpines);
  for (int i = 0; i < kSpines; ++i) spines.push_back(carton_side({64, 256}, random_palette(random), random));
  for (int row = 0; row < kRows; ++row) {
    parts.push_back(at(box({width, kDepth, 0.02}, board), {0, 0, row * kRowHeight}));
    double x = -0.5 * width + 0.03;
    while (x < 0.5 * width - 0.08) {
      const double thickness = random.uniform(0.015, 0.055);
      const double tall = random.uniform(0.19, 0.29);
      if (chance(random, 0.85))
        parts.push_back(at(box({thickness, 0.18, tall}, pick(random, spines)),
                           {x + 0.5 * thickness, -0.02, row * kRowHeight + 0.01 + 0.5 * tall}));
      x += thickness + 0.002;
    }
  }
  return from_parts("bookshelf", parts, 0.05F);
}

ThingPtr make_cabinet(const Eigen::Vector3d& size, Random& random) {
  const cv::Mat side = wood_or_paint(random);
  cv::Mat door;
  cv::resize(side, door, {512, 512});
  const int doors = std::max(1, static_cast<int>(std::lround(size.x() / 0.45)));
  const int step = door.cols / doors;
  for (int i = 0; i < doors; ++i) {
    cv::rectangle(door, {i * step + 3, 4, step - 6, door.rows - 8}, {30, 30, 30}, 2);
    const int x = i * step + step * (i % 2 == 0 ? 8 : 2) / 10;
    cv::line(door, {x, door.rows * 2 / 5}, {x, door.rows * 3 / 5}, {190, 195, 200}, std::max(3, step / 40));
  }
  BoxFaces faces;
  faces.front = door;
  faces.back = faces.left = faces.right = faces.top = faces.bottom = side;
  return make_asset("cabinet", box(size, faces), 0.12F);
}

ThingPtr make_picture(Random& random) {
  const double width = random.uniform(0.3, 0.7);
  const double height = random.uniform(0.3, 0.8);
  BoxFaces faces;
  faces.front = poster({static_cast<int>(600 * width), static_cast<int>(600 * height)}, random);
  faces.top = faces.left = faces.right = faces.bottom = faces.back = plain({32, 32}, paint(random), 0.05, random);
  return make_asset("picture", box({width, 0.02, height}, faces), 0.08F);
}

ThingPtr make_window(Random& random) {
  const double width = random.uniform(0.8, 1.4);
  const double height = random.uniform(0.8, 1.2);
  cv::Mat view = plain({256, 256}, {250, 240, 228}, 0.12, random);
  const int blinds = random.below(3) == 0 ? 24 : 0;
  for (int i = 0; i < blinds; ++i) cv::line(view, {0, i * 256 / blinds}, {256, i * 256 / blinds}, {170, 170, 165}, 4);
  cv::line(view, {128, 0}, {128, 256}, {120, 120, 120}, 8);
  cv::rectangle(view, {0, 0, 256, 256}, {120, 120, 120}, 14);
  return make_asset("window", box({width, 0.03, height}, view), 0.1F, 0.95F);
}

ThingPtr make_bin(Random& random) {
  return make_asset("bin", cup_mesh({0.14, 0.11, 0.32, 0.006}, plain({128, 128}, paint(random), 0.06, random)), 0.1F);
}

}  // namespace houghstream::world
