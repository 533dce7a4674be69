#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/further_objects.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream {
namespace {

const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

// Ridged screw cap standing on z = 0, as a closed solid.
Mesh cap_mesh(double radius, double height, const cv::Scalar& colour, Random& random) {
  cv::Mat texture = plain({256, 64}, colour, 0.03, random);
  for (int x = 0; x < texture.cols; x += 8) cv::line(texture, {x, 0}, {x, texture.rows}, colour * 0.75, 2);
  const Mesh cap = turned_mesh({{radius, 0.0}, {radius, 0.8 * height}, {0.9 * radius, height}}, texture);
  return cap;
}

// Chequered cloth, closed round a lathe.
cv::Mat gingham(const cv::Size& size, const cv::Scalar& colour, int squares, Random& random) {
  cv::Mat image = plain(size, hsv(40, 0.03, 0.94), 0.03, random);
  const int side = size.width / (2 * squares);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const int dark = (x / side) % 2 + (y / side) % 2;
      const double share = 0.5 * dark;
      auto& pixel = image.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<std::uint8_t>((1 - share) * pixel[c] + share * colour[c]);
    }
  }
  return image;
}

}  // namespace

ThingPtr make_water_bottle(Random& random) {
  constexpr double r = 0.034;
  cv::Mat plastic = plain({1024, 768}, hsv(188, 0.32, 0.78), 0.04, random);
  Palette palette{hsv(214, 0.85, 0.55), hsv(190, 0.6, 0.9), hsv(0, 0.0, 0.97), hsv(220, 0.8, 0.25)};
  can_label({1024, 230}, palette, random).copyTo(plastic.rowRange(330, 560));
  const Mesh body = turned_mesh({{0.9 * r, 0.0},
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
  return make_thing("water_bottle", finish_object(compose({at(body, {0, 0, 0.1}), at(cap, {0, 0, 0.209})})), 0.4F);
}

ThingPtr make_shampoo_bottle(Random& random) {
  Palette palette{hsv(276, 0.5, 0.6), hsv(64, 0.6, 0.88), hsv(280, 0.05, 0.97), hsv(276, 0.7, 0.22)};
  cv::Mat plastic = plain({1024, 640}, palette.base, 0.04, random);
  can_label({1024, 330}, palette, random).copyTo(plastic.rowRange(210, 540));
  const Mesh body = turned_mesh(
      {{0.035, 0.0}, {0.038, 0.005}, {0.0395, 0.06}, {0.037, 0.12}, {0.031, 0.148}, {0.019, 0.16}, {0.015, 0.164}},
      plastic);
  const Mesh cap = cap_mesh(0.0185, 0.034, hsv(70, 0.1, 0.95), random);
  const Mesh joined = compose({at(body, {0, 0, 0.082}), at(cap, {0, 0, 0.181})});
  return make_thing("shampoo_bottle", finish_object(scaled(joined, {1.0, 0.62, 1.0})), 0.3F);
}

ThingPtr make_jam_jar(Random& random) {
  Palette palette{hsv(50, 0.12, 0.95), hsv(350, 0.8, 0.65), hsv(50, 0.1, 0.97), hsv(352, 0.85, 0.3)};
  cv::Mat jam = plain({1024, 512}, hsv(352, 0.85, 0.34), 0.2, random);
  cv::Mat paper = plain({400, 190}, palette.base, 0.03, random);
  draw_photo(paper, {10, 100, 120, 80}, random);
  draw_title(paper, {20, 10, 360, 80}, palette.dark, random);
  draw_text_lines(paper, {150, 105, 230, 70}, palette.dark, random);
  for (const int x : {60, 572}) paper.copyTo(jam(cv::Rect(x, 190, paper.cols, paper.rows)));
  const Mesh pot =
      turned_mesh({{0.034, 0.0}, {0.037, 0.005}, {0.0375, 0.06}, {0.036, 0.072}, {0.031, 0.08}, {0.031, 0.084}}, jam);
  const cv::Mat cloth = gingham({768, 192}, hsv(354, 0.8, 0.62), 16, random);
  const Mesh lid = turned_mesh({{0.0345, 0.0}, {0.0355, 0.003}, {0.0355, 0.013}, {0.034, 0.0155}}, cloth);
  return make_thing("jam_jar", finish_object(compose({at(pot, {0, 0, 0.042}), at(lid, {0, 0, 0.0905})})), 0.35F);
}

ThingPtr make_food_tin(Random& random) {
  constexpr double r = 0.0435;
  constexpr double h = 0.112;
  Palette palette{hsv(112, 0.65, 0.42), hsv(14, 0.9, 0.88), hsv(52, 0.25, 0.97), hsv(120, 0.8, 0.18)};
  cv::Mat texture = metal({1024, 768}, random);
  cv::Mat label = can_label({1024, 400}, palette, random);
  draw_photo(label, {0, 250, 330, 140}, random);
  draw_photo(label, {512, 250, 330, 140}, random);
  label.copyTo(texture.rowRange(184, 584));
  const Mesh tin = turned_mesh({{0.97 * r, 0.0},
                                {r, 0.001},
                                {r, 0.004},
                                {0.975 * r, 0.005},
                                {0.975 * r, h - 0.005},
                                {r, h - 0.004},
                                {r, h - 0.001},
                                {0.97 * r, h}},
                               texture);
  return make_thing("food_tin", tin, 0.3F);
}

}  // namespace houghstream
