#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/further_objects.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream {
namespace {

const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

// Ring round a lathe's texture, `from` to `to` in shares of its height.
void draw_ring(cv::Mat& texture, double from, double to, const cv::Scalar& colour) {
  const int top = static_cast<int>(from * texture.rows);
  const int bottom = static_cast<int>(to * texture.rows);
  cv::rectangle(texture, {0, top, texture.cols, bottom - top}, colour, cv::FILLED);
}

// Half an ellipse in the x-z plane from (low_x, low_z) out and back to (high_x, high_z): a handle.
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

}  // namespace

ThingPtr make_plate(Random& random) {
  cv::Mat glaze = plain({512, 512}, hsv(45, 0.05, 0.9), 0.03, random);
  // Rows run from the middle of the upper side to the rim (about 0.49) and on to the middle of the lower side.
  draw_ring(glaze, 0.41, 0.52, hsv(222, 0.75, 0.5));
  draw_ring(glaze, 0.36, 0.375, hsv(222, 0.75, 0.5));
  const std::vector<ProfilePoint> profile = {{0.0, 0.003},    {0.062, 0.003},  {0.062, 0.003},  {0.063, 0.0},
                                             {0.068, 0.0},    {0.068, 0.0},    {0.072, 0.005},  {0.088, 0.014},
                                             {0.118, 0.0265}, {0.118, 0.0265}, {0.1185, 0.029}, {0.117, 0.0305},
                                             {0.086, 0.0185}, {0.072, 0.0095}, {0.066, 0.008},  {0.0, 0.0075}};
  return make_thing("plate", finish_object(lathe(with_arc_length(profile), glaze)), 0.3F);
}

ThingPtr make_teapot(Random& random) {
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
  return make_thing("teapot",
                    finish_object(compose({at(body, kOrigin), at(handle, kOrigin), at(pour, kOrigin),
                                           at(turned_mesh(knob, knob_glaze), {0, 0, 0.134})})),
                    0.35F);
}

ThingPtr make_pitcher(Random& random) {
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
  return make_thing("pitcher", finish_object(compose({at(jug, kOrigin), at(handle, kOrigin)})), 0.3F);
}

ThingPtr make_tumbler(Random& random) {
  cv::Mat glass = plain({256, 512}, hsv(196, 0.5, 0.72), 0.05, random);
  const cv::Scalar orange = hsv(24, 0.85, 0.92);
  draw_ring(glass, 0.53, 0.56, orange);
  draw_ring(glass, 0.58, 0.64, orange);
  draw_ring(glass, 0.66, 0.69, orange);
  return make_thing("tumbler", cup_mesh({0.039, 0.029, 0.148, 0.0025}, glass), 0.4F);
}

}  // namespace houghstream
