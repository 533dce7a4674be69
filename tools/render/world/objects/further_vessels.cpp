#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/further_objects.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream::world {
namespace {

const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

// Draws a ring round a lathe's texture, `from` to `to` in fractions of its height.
void draw_ring(cv::Mat& texture, double from, double to, const cv::Scalar& colour) {
  const int top = static_cast<int>(from * texture.rows);
  const int bottom = static_cast<int>(to * texture.rows);
  cv::rectangle(texture, {0, top, texture.cols, bottom - top}, colour, cv::FILLED);
}

// Returns half an ellipse in the x-z plane from (low_x, low_z) out and back to (high_x, high_z), for a handle.
std::vector<Eigen::Vector3d> handle_path(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double reach) {
  std::vector<Eigen::Vector3d> path;
  constexpr int kSteps = 12;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = M_PI * (static_cast<double>(i) / kSteps - 0.5);
    const Eigen::Vector2d between = low + 0.5 * (1.0 + std::sin(angle)) * (high - low);
    path.emplace_back(between.x() + reach * std::cos(angle), 0.0, between.y());
  }
  return path;
}

// Draws the rim of an upright vessel round the origin out to -x, as the lip that it pours over.
Mesh with_lip(Mesh vessel, double reach, double from_z, double to_z) {
  const std::vector<Eigen::Vector3f> smooth_normals = vessel.normals;
  std::vector<double> weights;
  for (Eigen::Vector3f& vertex : vessel.vertices) {
    const Eigen::Vector2d across = vertex.head<2>().cast<double>();
    const double angle = std::atan2(across.y(), -across.x()) / 0.4;
    const double height = std::clamp((vertex.z() - from_z) / (to_z - from_z), 0.0, 1.0);
    weights.push_back(across.norm() > 1e-6 ? std::exp(-angle * angle) * height * height : 0.0);
    vertex.x() -= static_cast<float>(reach * weights.back());
  }
  compute_normals(vessel);
  for (std::size_t i = 0; i < weights.size(); ++i) {  // elsewhere those without a seam
    if (weights[i] < 1e-3) vessel.normals[i] = smooth_normals[i];
  }
  return vessel;
}

// Makes a ridged screw cap standing on z = 0, as a closed solid.
Mesh cap_mesh(double radius, double height, const cv::Scalar& colour, Random& random) {
  cv::Mat texture = plain({256, 64}, colour, 0.03, random);
  for (int x = 0; x < texture.cols; x += 8) cv::line(texture, {x, 0}, {x, texture.rows}, colour * 0.75, 2);
  return rotated_mesh({{radius, 0.0}, {radius, 0.8 * height}, {0.9 * radius, height}}, texture);
}

// Draws chequered cloth, closed round a lathe.
cv::Mat gingham(const cv::Size& size, const cv::Scalar& colour, int squares, Random& random) {
  cv::Mat image = plain(size, hsv(40, 0.03, 0.94), 0.03, random);
  const int side = size.width / (2 * squares);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const int dark = (x / side) % 2 + (y / side) % 2;
      const double fraction = 0.5 * dark;
      auto& pixel = image.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<std::uint8_t>((1 - fraction) * pixel[c] + fraction * colour[c]);
    }
  }
  return image;
}

}  // namespace

AssetPtr make_plate(Random& random) {
  cv::Mat glaze = plain({512, 512}, hsv(45, 0.05, 0.9), 0.03, random);
  // Rows run from the middle of the upper side to the rim (about 0.49) and on to the middle of the lower side.
  draw_ring(glaze, 0.41, 0.52, hsv(222, 0.75, 0.5));
  draw_ring(glaze, 0.36, 0.375, hsv(222, 0.75, 0.5));
  const std::vector<ProfilePoint> profile = {{0.0, 0.003},    {0.062, 0.003},  {0.062, 0.003},  {0.063, 0.0},
                                             {0.068, 0.0},    {0.068, 0.0},    {0.072, 0.005},  {0.088, 0.014},
                                             {0.118, 0.0265}, {0.118, 0.0265}, {0.1185, 0.029}, {0.117, 0.0305},
                                             {0.086, 0.0185}, {0.072, 0.0095}, {0.066, 0.008},  {0.0, 0.0075}};
  return make_asset("plate", finish_object(lathe(with_arc_length(profile), glaze)), 0.3F);
}

AssetPtr make_teapot(Random& random) {
  const cv::Mat glaze = plain({256, 256}, hsv(168, 0.62, 0.42), 0.06, random);
  const cv::Mat knob_glaze = plain({64, 64}, hsv(40, 0.35, 0.85), 0.05, random);
  const std::vector<ProfilePoint> profile = {{0.0, 0.0},       {0.042, 0.0},    {0.042, 0.0},   {0.044, 0.005},
                                             {0.06, 0.02},     {0.0705, 0.042}, {0.073, 0.06},  {0.068, 0.082},
                                             {0.053, 0.101},   {0.038, 0.11},   {0.038, 0.11},  {0.0405, 0.111},
                                             {0.0405, 0.1145}, {0.034, 0.1195}, {0.018, 0.125}, {0.0, 0.1265}};
  const std::vector<Eigen::Vector2d> knob = {
      {0.006, 0.0}, {0.0055, 0.004}, {0.011, 0.01}, {0.011, 0.014}, {0.006, 0.0185}};
  const std::vector<Eigen::Vector3d> spout = {
      {-0.055, 0, 0.04}, {-0.08, 0, 0.05}, {-0.098, 0, 0.07}, {-0.108, 0, 0.09}, {-0.122, 0, 0.107}};
  const Mesh body = lathe(with_arc_length(profile), glaze);
  const Mesh handle = tube(handle_path({0.06, 0.032}, {0.048, 0.098}, 0.06), 0.0075, glaze);
  const Mesh pour = tapered_tube(spout, {0.02, 0.0175, 0.0135, 0.0105, 0.009}, glaze, 16);
  return make_asset("teapot",
                    finish_object(compose({at(body, kOrigin), at(handle, kOrigin), at(pour, kOrigin),
                                           at(rotated_mesh(knob, knob_glaze), {0, 0, 0.134})})),
                    0.35F);
}

AssetPtr make_pitcher(Random& random) {
  cv::Mat enamel = plain({512, 512}, hsv(48, 0.1, 0.88), 0.04, random);
  const cv::Scalar red = hsv(4, 0.78, 0.62);
  draw_ring(enamel, 0.46, 0.52, red);  // the rim, both sides
  draw_ring(enamel, 0.74, 0.8, red);
  draw_ring(enamel, 0.82, 0.835, red);
  const cv::Mat grip = plain({64, 64}, red, 0.04, random);
  const MugShape shape{0.05, 0.066, 0.21, 0.003};
  const double foot = -0.5 * shape.height;
  const Mesh handle = tube(handle_path({0.0597, foot + 0.063}, {0.0502, foot + 0.187}, 0.05), 0.0075, grip);
  const Mesh jug = with_lip(cup_mesh(shape, enamel), 0.026, 0.2 * shape.height, 0.5 * shape.height);
  return make_asset("pitcher", finish_object(compose({at(jug, kOrigin), at(handle, kOrigin)})), 0.3F);
}

AssetPtr make_tumbler(Random& random) {
  cv::Mat glass = plain({256, 512}, hsv(196, 0.5, 0.72), 0.05, random);
  const cv::Scalar orange = hsv(24, 0.85, 0.92);
  draw_ring(glass, 0.53, 0.56, orange);
  draw_ring(glass, 0.58, 0.64, orange);
  draw_ring(glass, 0.66, 0.69, orange);
  return make_asset("tumbler", cup_mesh({0.039, 0.029, 0.148, 0.0025}, glass), 0.4F);
}

AssetPtr make_water_bottle(Random& random) {
  constexpr double r = 0.034;
  cv::Mat plastic = plain({1024, 768}, hsv(188, 0.32, 0.78), 0.04, random);
  Palette palette{hsv(214, 0.85, 0.55), hsv(190, 0.6, 0.9), hsv(0, 0.0, 0.97), hsv(220, 0.8, 0.25)};
  can_label({1024, 230}, palette, random).copyTo(plastic.rowRange(330, 560));
  const Mesh body = rotated_mesh({{0.9 * r, 0.0},
                                  {r, 0.006},
                                  {r, 0.03},
                                  {0.94 * r, 0.035},
                                  {r, 0.04},
                                  {r, 0.13},
                                  {0.94 * r, 0.135},
                                  {r, 0.14},
                                  {0.9 * r, 0.165},
                                  {0.55 * r, 0.19},
                                  {0.4 * r, 0.2}},
                                 plastic);
  const Mesh cap = cap_mesh(0.0155, 0.02, hsv(214, 0.85, 0.5), random);
  return make_asset("water_bottle", finish_object(compose({at(body, {0, 0, 0.1}), at(cap, {0, 0, 0.209})})), 0.4F);
}

AssetPtr make_shampoo_bottle(Random& random) {
  Palette palette{hsv(276, 0.5, 0.6), hsv(64, 0.6, 0.88), hsv(280, 0.05, 0.97), hsv(276, 0.7, 0.22)};
  cv::Mat plastic = plain({1024, 640}, palette.base, 0.04, random);
  can_label({1024, 330}, palette, random).copyTo(plastic.rowRange(210, 540));
  const Mesh body = rotated_mesh(
      {{0.035, 0.0}, {0.038, 0.005}, {0.0395, 0.06}, {0.037, 0.12}, {0.031, 0.148}, {0.019, 0.16}, {0.015, 0.164}},
      plastic);
  const Mesh cap = cap_mesh(0.0185, 0.034, hsv(70, 0.1, 0.95), random);
  const Mesh joined = compose({at(body, {0, 0, 0.082}), at(cap, {0, 0, 0.181})});
  return make_asset("shampoo_bottle", finish_object(scaled(joined, {1.0, 0.62, 1.0})), 0.3F);
}

AssetPtr make_jam_jar(Random& random) {
  Palette palette{hsv(50, 0.12, 0.95), hsv(350, 0.8, 0.65), hsv(50, 0.1, 0.97), hsv(352, 0.85, 0.3)};
  cv::Mat jam = plain({1024, 512}, hsv(352, 0.85, 0.34), 0.2, random);
  cv::Mat paper = plain({400, 190}, palette.base, 0.03, random);
  draw_photo(paper, {10, 100, 120, 80}, random);
  draw_title(paper, {20, 10, 360, 80}, palette.dark, random);
  draw_text_lines(paper, {150, 105, 230, 70}, palette.dark, random);
  for (const int x : {60, 572}) paper.copyTo(jam(cv::Rect(x, 190, paper.cols, paper.rows)));
  const Mesh pot =
      rotated_mesh({{0.034, 0.0}, {0.037, 0.005}, {0.0375, 0.06}, {0.036, 0.072}, {0.031, 0.08}, {0.031, 0.084}}, jam);
  const cv::Mat cloth = gingham({768, 192}, hsv(354, 0.8, 0.62), 16, random);
  const Mesh lid = rotated_mesh({{0.0345, 0.0}, {0.0355, 0.003}, {0.0355, 0.013}, {0.034, 0.0155}}, cloth);
  return make_asset("jam_jar", finish_object(compose({at(pot, {0, 0, 0.042}), at(lid, {0, 0, 0.0905})})), 0.35F);
}

AssetPtr make_food_tin(Random& random) {
  constexpr double r = 0.0435;
  constexpr double h = 0.112;
  Palette palette{hsv(112, 0.65, 0.42), hsv(14, 0.9, 0.88), hsv(52, 0.25, 0.97), hsv(120, 0.8, 0.18)};
  cv::Mat texture = metal({1024, 768}, random);
  cv::Mat label = can_label({1024, 400}, palette, random);
  draw_photo(label, {0, 250, 330, 140}, random);
  draw_photo(label, {512, 250, 330, 140}, random);
  label.copyTo(texture.rowRange(184, 584));
  const Mesh tin = rotated_mesh({{0.97 * r, 0.0},
                                 {r, 0.001},
                                 {r, 0.004},
                                 {0.975 * r, 0.005},
                                 {0.975 * r, h - 0.005},
                                 {r, h - 0.004},
                                 {r, h - 0.001},
                                 {0.97 * r, h}},
                                texture);
  return make_asset("food_tin", tin, 0.3F);
}

}  // namespace houghstream::world
