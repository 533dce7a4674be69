#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/further_objects.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream::world {
namespace {

const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

Part rotated(Mesh mesh, const Eigen::Vector3d& translation, double angle_rad, const Eigen::Vector3d& axis) {
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

// Returns a part of revolution with its axis along y (wheels) or x (parts lying on their side).
Part lying(Mesh mesh, const Eigen::Vector3d& translation, const Eigen::Vector3d& axis) {
  Part part{std::move(mesh), Eigen::Isometry3d::Identity()};
  part.T_object_part.translate(translation);
  part.T_object_part.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis));
  return part;
}

cv::Mat banana_skin(Random& random) {
  cv::Mat skin = plain({192, 512}, hsv(51, 0.82, 0.92), 0.06, random);
  for (int i = 0; i < 60; ++i) {
    const int x = random.below(skin.cols);
    const int y = random.between(60, 450);
    cv::ellipse(skin, {x, y}, {random.between(1, 4), random.between(3, 14)}, 0, 0, 360, hsv(32, 0.7, 0.42), cv::FILLED,
                cv::LINE_AA);
  }
  skin.rowRange(0, 50) = hsv(66, 0.6, 0.62);
  skin.rowRange(492, 512) = hsv(28, 0.6, 0.2);
  skin.rowRange(0, 12) = hsv(28, 0.6, 0.25);
  return skin;
}

}  // namespace

AssetPtr make_milk_carton(Random& random) {
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
  return make_asset("milk_carton",
                    finish_object(compose({at(box({kWidth, kWidth, kBody}, faces), {0, 0, 0.5 * kBody}),
                                           at(roof, {0, 0, kBody}, 0.5 * M_PI), at(fin, {0, 0, kBody + kRoof})})),
                    0.12F);
}

AssetPtr make_tea_box(Random& random) {
  const Palette palette{hsv(142, 0.7, 0.34), hsv(44, 0.75, 0.85), hsv(46, 0.35, 0.95), hsv(150, 0.8, 0.14)};
  return make_asset("tea_box", carton_mesh({0.138, 0.068, 0.082}, palette, random), 0.12F);
}

AssetPtr make_sponge(Random& random) {
  const cv::Mat foam = pores({512, 384}, hsv(50, 0.72, 0.9), random);
  const cv::Mat scourer = pores({512, 384}, hsv(135, 0.7, 0.36), random);
  return make_asset("sponge",
                    finish_object(compose({at(box({0.112, 0.072, 0.03}, foam), {0, 0, 0.015}),
                                           at(box({0.112, 0.072, 0.011}, scourer), {0, 0, 0.0355})})),
                    0.03F);
}

AssetPtr make_office_stapler(Random& random) {
  cv::Mat shell = plain({512, 96}, hsv(2, 0.82, 0.62), 0.06, random);
  const cv::Mat rubber = plain({128, 64}, hsv(220, 0.1, 0.14), 0.08, random);
  const cv::Mat steel = metal({128, 64}, random);
  // The outline is seen from the side: the arm is high in the middle and low at both ends.
  const std::vector<Eigen::Vector2d> arm = {{-0.08, 0.0},  {0.068, 0.0},   {0.072, 0.008}, {0.06, 0.02},
                                            {0.01, 0.028}, {-0.05, 0.027}, {-0.074, 0.02}, {-0.082, 0.008}};
  const std::vector<Eigen::Vector2d> foot = {{-0.08, 0.0}, {0.07, 0.0}, {0.066, 0.01}, {-0.076, 0.012}};
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  return make_asset("office_stapler",
                    finish_object(compose({at(prism(foot, 0.042, rubber, rubber), kOrigin),
                                           rotated(box({0.14, 0.018, 0.012}, steel), {-0.004, 0, 0.024}, 0.12, y),
                                           rotated(prism(arm, 0.036, shell, shell), {0.0, 0, 0.032}, 0.12, y)})),
                    0.25F);
}

AssetPtr make_beach_ball(Random& random) {
  constexpr double r = 0.058;
  constexpr int kSteps = 20;
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = M_PI * (static_cast<double>(i) / kSteps - 0.5);
    profile.push_back({i == 0 || i == kSteps ? 0.0 : r * std::cos(angle), r * std::sin(angle)});
  }
  cv::Mat texture = plain({768, 512}, hsv(0, 0.0, 0.94), 0.03, random);
  const std::vector<double> hues = {4, 48, 212, 128};
  for (std::size_t i = 0; i < hues.size(); ++i) {
    const int left = static_cast<int>(i) * 192;
    cv::rectangle(texture, {left, 0, 112, 512}, hsv(hues[i], 0.85, 0.78), cv::FILLED);
  }
  for (const int end : {0, 476}) texture.rowRange(end, end + 36) = hsv(0, 0.0, 0.94);
  return make_asset("beach_ball", finish_object(lathe(with_arc_length(profile), texture)), 0.25F);
}

AssetPtr make_toy_truck(Random& random) {
  const cv::Mat red = plain({128, 128}, hsv(356, 0.85, 0.7), 0.04, random);
  const cv::Mat yellow = plain({128, 128}, hsv(46, 0.9, 0.92), 0.04, random);
  const cv::Mat dark = plain({64, 64}, hsv(220, 0.2, 0.2), 0.05, random);
  cv::Mat door = red.clone();
  cv::rectangle(door, {20, 14, 88, 52}, hsv(200, 0.35, 0.85), cv::FILLED);
  BoxFaces cab;
  cab.front = door;
  cab.back = cab.left = door;
  cab.right = cab.top = cab.bottom = red;
  std::vector<Part> parts = {at(box({0.18, 0.05, 0.014}, dark), {0, 0, 0.027}),
                             at(box({0.05, 0.07, 0.066}, cab), {-0.06, 0, 0.065}),
                             at(box({0.11, 0.07, 0.008}, yellow), {0.03, 0, 0.038})};
  // The bed is open at the top: four boards.
  for (const double y : {-0.0325, 0.0325}) parts.push_back(at(box({0.11, 0.005, 0.034}, yellow), {0.03, y, 0.058}));
  for (const double x : {-0.0225, 0.0825}) parts.push_back(at(box({0.005, 0.06, 0.034}, yellow), {x, 0, 0.058}));
  cv::Mat tyre = plain({128, 128}, hsv(220, 0.1, 0.12), 0.05, random);
  tyre.rowRange(0, 36) = hsv(0, 0.0, 0.75);
  tyre.rowRange(92, 128) = hsv(0, 0.0, 0.75);
  const Mesh wheel = rotated_mesh({{0.018, 0.0}, {0.021, 0.003}, {0.021, 0.013}, {0.018, 0.016}}, tyre);
  for (const double x : {-0.057, 0.057}) {
    for (const double y : {-0.03, 0.03}) parts.push_back(lying(wheel, {x, y, 0.021}, Eigen::Vector3d::UnitY()));
  }
  return make_asset("toy_truck", finish_object(compose(parts)), 0.25F);
}

AssetPtr make_banana(Random& random) {
  constexpr int kSteps = 24;
  constexpr double kBend = 0.095;  // radius of the arc it follows
  std::vector<Eigen::Vector3d> path;
  std::vector<double> radii;
  for (int i = 0; i <= kSteps; ++i) {
    const double fraction = static_cast<double>(i) / kSteps;
    const double angle = 2.1 * (fraction - 0.5);
    path.emplace_back(kBend * std::sin(angle), kBend * std::cos(angle), 0.0);
    const double bulge = std::sqrt(std::max(0.0, 1.0 - std::pow(2.0 * fraction - 1.0, 4)));
    radii.push_back(fraction < 0.1 ? 0.0062 : 0.005 + 0.0145 * bulge);
  }
  return make_asset("banana", finish_object(tapered_tube(path, radii, banana_skin(random), 12)), 0.12F);
}

AssetPtr make_flashlight(Random& random) {
  cv::Mat shell = plain({256, 768}, hsv(214, 0.6, 0.3), 0.05, random);
  const cv::Scalar yellow = hsv(50, 0.9, 0.92);
  const cv::Mat lens = plain({64, 64}, hsv(55, 0.08, 0.95), 0.03, random);
  shell.rowRange(140, 250) = yellow;  // the head
  shell.rowRange(660, 690) = yellow;
  for (int y = 380; y < 620; y += 24) shell.rowRange(y, y + 8) = hsv(214, 0.5, 0.12);
  const Mesh body =
      rotated_mesh({{0.0155, 0.0}, {0.0175, 0.003}, {0.0175, 0.112}, {0.028, 0.135}, {0.0285, 0.168}}, shell);
  const Mesh glass = rotated_mesh({{0.025, 0.0}, {0.022, 0.003}}, lens);
  const cv::Mat rubber = plain({64, 64}, hsv(4, 0.8, 0.7), 0.04, random);
  const Mesh button = box({0.022, 0.01, 0.008}, rubber);
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  return make_asset("flashlight",
                    finish_object(compose(
                        {lying(body, kOrigin, x), lying(glass, {0.0855, 0, 0}, x), at(button, {0.005, 0, 0.0185})})),
                    0.25F);
}

}  // namespace houghstream::world
