#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/further_objects.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream {
namespace {

const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

Part turned(Mesh mesh, const Eigen::Vector3d& translation, double angle_rad, const Eigen::Vector3d& axis) {
  Part part{std::move(mesh), Eigen::Isometry3d::Identity()};
  part.T_object_part.translate(translation);
  part.T_object_part.rotate(Eigen::AngleAxisd(angle_rad, axis));
  return part;
}

cv::Mat pores(const cv::Size& size, const cv::Scalar& colour, Random& random) {
  cv::Mat image = plain(size, colour, 0.1, random);
  const int count = size.area() / 260;
  for (int i = 0; i < count; ++i) {
    const int x = random.below(size.width);
    const int y = random.below(size.height);
    cv::circle(image, {x, y}, random.between(1, 5), colour * random.uniform(0.45, 0.8), cv::FILLED, cv::LINE_AA);
  }
  return image;
}

}  // namespace

ThingPtr make_milk_carton(Random& random) {
  constexpr double kWidth = 0.074;
  constexpr double kBody = 0.15;
  constexpr double kRoof = 0.036;
  Palette palette{hsv(205, 0.08, 0.95), hsv(202, 0.75, 0.75), hsv(208, 0.8, 0.55), hsv(215, 0.8, 0.3)};
  BoxFaces faces;
  faces.front = carton_front({300, 600}, palette, random);
  faces.back = faces.front;
  faces.left = carton_side({300, 600}, palette, random);
  faces.right = carton_side({300, 600}, palette, random);
  faces.top = plain({64, 64}, palette.base, 0.04, random);
  faces.bottom = faces.top;
  cv::Mat slope = plain({300, 160}, palette.accent, 0.05, random);
  draw_title(slope, {30, 40, 240, 90}, palette.base, random);
  cv::Mat gable = plain({128, 64}, palette.base, 0.04, random);
  const double half = 0.5 * kWidth;
  // The ridge runs along x, so that its slopes look to the front and the back.
  Mesh roof = prism({{-half, 0.0}, {half, 0.0}, {0.0, kRoof}}, kWidth, gable, slope);
  const Mesh fin = box({kWidth, 0.004, 0.02}, plain({128, 32}, palette.accent * 0.95, 0.04, random));
  return make_thing("milk_carton",
                    finish_object(compose({at(box({kWidth, kWidth, kBody}, faces), {0, 0, 0.5 * kBody}),
                                           at(roof, {0, 0, kBody}, 0.5 * M_PI), at(fin, {0, 0, kBody + kRoof})})),
                    0.12F);
}

ThingPtr make_tea_box(Random& random) {
  const Palette palette{hsv(142, 0.7, 0.34), hsv(44, 0.75, 0.85), hsv(46, 0.35, 0.95), hsv(150, 0.8, 0.14)};
  return make_thing("tea_box", carton_mesh({0.138, 0.068, 0.082}, palette, random), 0.12F);
}

ThingPtr make_sponge(Random& random) {
  const cv::Mat foam = pores({512, 384}, hsv(50, 0.72, 0.9), random);
  const cv::Mat scourer = pores({512, 384}, hsv(135, 0.7, 0.36), random);
  return make_thing("sponge",
                    finish_object(compose({at(box({0.112, 0.072, 0.03}, foam), {0, 0, 0.015}),
                                           at(box({0.112, 0.072, 0.011}, scourer), {0, 0, 0.0355})})),
                    0.03F);
}

ThingPtr make_office_stapler(Random& random) {
  cv::Mat shell = plain({512, 96}, hsv(2, 0.82, 0.62), 0.06, random);
  const cv::Mat rubber = plain({128, 64}, hsv(220, 0.1, 0.14), 0.08, random);
  const cv::Mat steel = metal({128, 64}, random);
  // Seen from the side: the arm is high in the middle and low at both ends.
  const std::vector<Eigen::Vector2d> arm = {{-0.08, 0.0},  {0.068, 0.0},   {0.072, 0.008}, {0.06, 0.02},
                                            {0.01, 0.028}, {-0.05, 0.027}, {-0.074, 0.02}, {-0.082, 0.008}};
  const std::vector<Eigen::Vector2d> foot = {{-0.08, 0.0}, {0.07, 0.0}, {0.066, 0.01}, {-0.076, 0.012}};
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  return make_thing("office_stapler",
                    finish_object(compose({at(prism(foot, 0.042, rubber, rubber), kOrigin),
                                           turned(box({0.14, 0.018, 0.012}, steel), {-0.004, 0, 0.024}, 0.12, y),
                                           turned(prism(arm, 0.036, shell, shell), {0.0, 0, 0.032}, 0.12, y)})),
                    0.25F);
}

}  // namespace houghstream
