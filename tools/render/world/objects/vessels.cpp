#include "tools/render/world/objects/vessels.hpp"

#include <cmath>

#include "tools/render/world/objects/materials.hpp"

namespace houghstream::world {
namespace {

// Returns the outline of a thick-walled cup: foot, outside, rim, inside, inner bottom.
std::vector<ProfilePoint> cup_profile(const MugShape& shape) {
  const double foot = shape.foot_radius;
  const double rim = shape.rim_radius;
  const double inner_rim = rim - shape.wall;
  const double inner_foot = foot - shape.wall;
  return {{0.0, 0.0},
          {0.94 * foot, 0.0},
          {0.94 * foot, 0.0},
          {foot, 0.05 * shape.height},
          {0.5 * (foot + rim), 0.5 * shape.height},
          {rim, 0.99 * shape.height},
          {rim - 0.3 * shape.wall, shape.height},
          {inner_rim + 0.3 * shape.wall, shape.height},
          {inner_rim, 0.99 * shape.height},
          {0.5 * (inner_foot + inner_rim), 0.5 * shape.height},
          {inner_foot, shape.wall + 0.04 * shape.height},
          {0.85 * inner_foot, shape.wall},
          {0.0, shape.wall}};
}

std::vector<Eigen::Vector3d> handle_path(const MugShape& shape) {
  std::vector<Eigen::Vector3d> path;
  const double mean_radius = 0.5 * (shape.rim_radius + shape.foot_radius);
  const double reach = 0.032;
  constexpr int kSteps = 10;
  path.reserve(kSteps + 1);
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = M_PI * (static_cast<double>(i) / kSteps - 0.5);
    // Both ends lie inside the wall.
    path.emplace_back(mean_radius - 0.6 * shape.wall + reach * std::cos(angle), 0.0,
                      shape.height * (0.52 + 0.29 * std::sin(angle)));
  }
  return path;
}

}  // namespace

Mesh bowl_mesh(const BowlShape& shape, const cv::Mat& texture) {
  std::vector<ProfilePoint> profile = {{0.0, 0.0}, {shape.foot_radius, 0.0}, {shape.foot_radius, 0.0}};
  constexpr int kSteps = 10;
  const double foot_height = 0.06 * shape.height;
  for (int i = 0; i <= kSteps; ++i) {  // outside: a quarter of an ellipse
    const double angle = 0.5 * M_PI * i / kSteps;
    profile.push_back({shape.foot_radius + (shape.rim_radius - shape.foot_radius) * std::sin(angle),
                       foot_height + (shape.height - foot_height) * (1.0 - std::cos(angle))});
  }
  profile.push_back({shape.rim_radius - shape.wall, shape.height});
  for (int i = kSteps - 1; i >= 0; --i) {  // inside, one wall thickness away
    const double angle = 0.5 * M_PI * i / kSteps;
    profile.push_back({shape.foot_radius - shape.wall + (shape.rim_radius - shape.foot_radius) * std::sin(angle),
                       foot_height + shape.wall + (shape.height - foot_height - shape.wall) * (1.0 - std::cos(angle))});
  }
  profile.push_back({0.0, foot_height + shape.wall});
  return finish_object(lathe(with_arc_length(profile), texture));
}

Mesh mug_mesh(const MugShape& shape, const Palette& palette, Random& random) {
  const int outside_rows = 400;
  cv::Mat texture(512, 1024, CV_8UC3);
  mug_print({1024, outside_rows}, palette, random).copyTo(texture.rowRange(0, outside_rows));
  plain({1024, 512 - outside_rows}, palette.base * 0.97, 0.03, random).copyTo(texture.rowRange(outside_rows, 512));
  std::vector<ProfilePoint> profile = cup_profile(shape);
  const double edge = static_cast<double>(outside_rows) / 512.0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const bool outside = i >= 2 && i <= 5;
    profile[i].v = outside ? edge * (1.0 - profile[i].z / shape.height) : 0.98;
  }
  // The texture ends where the rim begins: the rim's first ring carries both texture rows.
  profile.insert(profile.begin() + 6, profile[5]);
  profile[6].v = 0.98;
  const cv::Mat glaze = plain({64, 64}, palette.base, 0.03, random);
  return finish_object(compose({at(lathe(profile, texture), Eigen::Vector3d::Zero()),
                                at(tube(handle_path(shape), 0.0058, glaze), Eigen::Vector3d::Zero())}));
}

Mesh cup_mesh(const MugShape& shape, const cv::Mat& texture) {
  return finish_object(lathe(with_arc_length(cup_profile(shape)), texture));
}

Mesh can_mesh(double radius, double height, const Palette& palette, Random& random) {
  const int label_rows = 420;
  cv::Mat texture(512, 1024, CV_8UC3);
  can_label({1024, label_rows}, palette, random).copyTo(texture.rowRange(0, label_rows));
  metal({1024, 512 - label_rows}, random).copyTo(texture.rowRange(label_rows, 512));
  const double edge = 419.0 / 512.0;
  const std::vector<ProfilePoint> profile = {{0.0, 0.006, 0.84},
                                             {0.62 * radius, 0.004, 0.86},
                                             {0.75 * radius, 0.0, 0.88},
                                             {0.80 * radius, 0.002, 0.89},
                                             {0.97 * radius, 0.010, 0.9},
                                             {0.97 * radius, 0.010, edge},
                                             {radius, 0.014, 0.97 * edge},
                                             {radius, height - 0.016, 0.06 * edge},
                                             {0.85 * radius, height - 0.004, 0.0},
                                             {0.85 * radius, height - 0.004, 0.9},
                                             {0.83 * radius, height, 0.92},
                                             {0.80 * radius, height, 0.93},
                                             {0.78 * radius, height - 0.004, 0.95},
                                             {0.0, height - 0.004, 0.99}};
  return finish_object(lathe(profile, texture));
}

Mesh carton_mesh(const Eigen::Vector3d& size, const Palette& palette, Random& random) {
  const auto pixels = [](double width, double height) {  // about 0.5 mm a texel
    return cv::Size(static_cast<int>(width * 2000), static_cast<int>(height * 2000));
  };
  BoxFaces faces;
  faces.front = carton_front(pixels(size.x(), size.z()), palette, random);
  faces.back = carton_front(pixels(size.x(), size.z()), palette, random);
  faces.left = carton_side(pixels(size.y(), size.z()), palette, random);
  faces.right = carton_side(pixels(size.y(), size.z()), palette, random);
  faces.top = plain(pixels(size.x(), size.y()), palette.base, 0.06, random);
  draw_title(faces.top, {8, 8, faces.top.cols - 16, faces.top.rows - 16}, palette.light, random);
  faces.bottom = plain(pixels(size.x(), size.y()), palette.base * 0.9, 0.06, random);
  return finish_object(box(size, faces));
}

Mesh rotated_mesh(const std::vector<Eigen::Vector2d>& outline, const cv::Mat& texture) {
  std::vector<ProfilePoint> profile = {{0.0, outline.front().y()}, {outline.front().x(), outline.front().y()}};
  for (const Eigen::Vector2d& point : outline) profile.push_back({point.x(), point.y()});
  profile.push_back({outline.back().x(), outline.back().y()});
  profile.push_back({0.0, outline.back().y()});
  return finish_object(lathe(with_arc_length(profile), texture));
}

}  // namespace houghstream::world
