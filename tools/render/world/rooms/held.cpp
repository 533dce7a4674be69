#include "tools/render/world/rooms/held.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/rooms/attitudes.hpp"

namespace houghstream::world {
namespace {

constexpr double kFingerRadiusM = 0.0085;
constexpr double kFingerStepM = 0.02;
constexpr double kPalmRadiusM = 0.021;
constexpr double kArmLengthM = 0.75;
constexpr double kOverTableM = 0.004;  // distance of the hand from the table

/// Describes the grip of the hand. Axes: `back` from the object towards the arm, `close` from the thumb to the fingers,
/// `along` from finger to finger.
struct Grip {
  Eigen::Matrix3d axes;  ///< columns back, close, along; world
  double reach_m;        ///< reach of the fingers round the asset, from the point that the palm touches
};

/// Returns points of the asset's surface in the grip's axes, from its origin.
std::vector<Eigen::Vector3d> surface_points(const Mesh& mesh, const Eigen::Matrix3d& R_grip_object) {
  constexpr int kSplit = 6;  // parts of a triangle's sides
  std::vector<Eigen::Vector3d> points;
  points.reserve(mesh.triangles.size() * (kSplit + 1) * (kSplit + 2) / 2);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d pa = R_grip_object * mesh.vertices[a].cast<double>();
    const Eigen::Vector3d pb = R_grip_object * mesh.vertices[b].cast<double>();
    const Eigen::Vector3d pc = R_grip_object * mesh.vertices[c].cast<double>();
    for (int i = 0; i <= kSplit; ++i) {
      for (int j = 0; j <= kSplit - i; ++j) {
        points.push_back(pa + (pb - pa) * (static_cast<double>(i) / kSplit) +
                         (pc - pa) * (static_cast<double>(j) / kSplit));
      }
    }
  }
  return points;
}

/// Returns the maximum that points reach to one side of `close` (sign), between two depths of `back` and about `along`.
double side_of(const std::vector<Eigen::Vector3d>& points, double sign, const Eigen::Vector2d& back, double along) {
  double farthest = 0.0;
  for (const Eigen::Vector3d& point : points) {
    if (point.x() < back.x() || point.x() > back.y() || std::abs(point.z() - along) > kFingerStepM) continue;
    farthest = std::max(farthest, sign * point.y());
  }
  return farthest;
}

/// Gives the position of a finger, in the grip's axes.
struct FingerPlace {
  double sign;   ///< sign of its side: 1 for a finger, -1 for the thumb
  double along;  ///< position from finger to finger
};

Mesh finger(const std::vector<Eigen::Vector3d>& points, const FingerPlace& place, double palm, const Grip& grip,
            const cv::Mat& skin) {
  const auto [sign, along] = place;
  const double tip = palm - grip.reach_m;
  const double near_side = side_of(points, sign, {palm - 0.5 * grip.reach_m, palm + 1.0}, along) + kFingerRadiusM;
  const double far_side = side_of(points, sign, {tip, palm - 0.3 * grip.reach_m}, along) + kFingerRadiusM;
  const double knuckle = std::max(near_side, far_side);
  const std::vector<Eigen::Vector3d> path = {{palm + kPalmRadiusM, sign * 0.012, along},
                                             {palm + 0.6 * kPalmRadiusM, sign * std::max(0.03, 0.6 * knuckle), along},
                                             {palm - 0.1 * grip.reach_m, sign * (knuckle + 0.004), along},
                                             {palm - 0.55 * grip.reach_m, sign * knuckle, along},
                                             {tip, sign * (far_side - 0.002), along}};
  const double r = kFingerRadiusM;
  return tapered_tube(path, {1.2 * r, 1.1 * r, 1.05 * r, r, 0.8 * r}, skin);
}

AssetPtr make_hand(const std::vector<Eigen::Vector3d>& points, const Grip& grip, const cv::Mat& skin,
                   const cv::Mat& sleeve) {
  double palm = 0.0;  // position where it touches the asset, along `back`
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(point.y()) < 0.03 && std::abs(point.z()) < 0.04) palm = std::max(palm, point.x());
  }
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Part> parts;
  parts.reserve(8);
  for (int i = 0; i < 4; ++i) {
    parts.push_back(at(finger(points, {1.0, (i - 1.5) * kFingerStepM}, palm, grip, skin), origin));
  }
  parts.push_back(at(finger(points, {-1.0, 0.5 * kFingerStepM}, palm, grip, skin), origin));
  const double middle = palm + kPalmRadiusM;
  parts.push_back(at(tapered_tube({{middle, 0, -0.042}, {middle, 0, -0.03}, {middle, 0, 0.03}, {middle, 0, 0.042}},
                                  {0.6 * kPalmRadiusM, kPalmRadiusM, kPalmRadiusM, 0.6 * kPalmRadiusM}, skin),
                     origin));
  parts.push_back(at(tapered_tube({{middle, 0, 0}, {middle + 0.03, 0, 0}, {middle + 0.08, 0, 0}, {middle + 0.2, 0, 0}},
                                  {0.03, 0.034, 0.028, 0.034}, skin, 20),
                     origin));
  parts.push_back(at(tapered_tube({{middle + 0.16, 0, 0}, {middle + 0.3, 0, 0}, {middle + kArmLengthM, 0, 0}},
                                  {0.038, 0.045, 0.055}, sleeve, 20),
                     origin));
  // The mesh stays in the asset's place: finish_object() would move the origin.
  Mesh mesh = compose(parts);
  const Eigen::Vector3f centre = mesh_bounds(mesh).center();
  mesh = finish_object(mesh);
  const Eigen::Vector3f moved = centre - mesh_bounds(mesh).center();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex += moved;
  return make_asset("hand", mesh, 0.08F);
}

/// Returns the fraction of the asset's silhouette that the hand occludes in a view.
double hidden_fraction(const PlacedAsset& hand, const PlacedAsset& thing, const Eigen::Isometry3d& T_camera_world) {
  const Camera camera{320, 240, 262.5, 262.5, 159.5, 119.5};
  const Eigen::Isometry3d T_camera_object = T_camera_world * thing.T_world_object;
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector3f& vertex : thing.thing->mesh.vertices) {
    extent.extend(camera.project(T_camera_object * vertex.cast<double>()));
  }
  const Eigen::Vector2i low = extent.min().array().floor().cast<int>();
  const Eigen::Vector2i size = extent.sizes().array().ceil().cast<int>() + 2;
  const cv::Rect region(low.x(), low.y(), size.x(), size.y());
  const cv::Mat object = render_depth(thing.thing->mesh, T_camera_object, camera, region);
  const cv::Mat before = render_depth(hand.thing->mesh, T_camera_world * hand.T_world_object, camera, region);
  const int all = cv::countNonZero(object == object);  // NaN differs from itself
  return all == 0 ? 0.0 : static_cast<double>(cv::countNonZero(before < object)) / all;
}

double mean_hidden_fraction(const PlacedAsset& hand, const PlacedAsset& thing, const HeldPlace& place) {
  double sum = 0.0;
  for (const Eigen::Isometry3d& T_camera_world : place.views) sum += hidden_fraction(hand, thing, T_camera_world);
  return sum / static_cast<double>(place.views.size());
}

double lowest_point(const PlacedAsset& placed) {
  double lowest = 1e9;
  for (const Eigen::Vector3f& vertex : placed.thing->mesh.vertices) {
    lowest = std::min(lowest, (placed.T_world_object * vertex.cast<double>()).z());
  }
  return lowest;
}

/// `liberty`, 0 to 1, limits how far from the usual direction the arm may come.
Grip draw_grip(double arm_azimuth_rad, double liberty, Random& random) {
  const double max_aside = 0.3 + 0.6 * liberty;
  const double azimuth = arm_azimuth_rad + random.uniform(-max_aside, max_aside);
  const double elevation = random.uniform(0.2, 0.9 + 0.4 * liberty);
  Grip grip;
  grip.axes.col(0) = Eigen::Vector3d(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                                     std::sin(elevation));
  const Eigen::Vector3d level = Eigen::Vector3d::UnitZ().cross(grip.axes.col(0)).normalized();
  grip.axes.col(1) = Eigen::AngleAxisd(random.uniform(-M_PI, M_PI), grip.axes.col(0)) * level;
  grip.axes.col(2) = grip.axes.col(0).cross(grip.axes.col(1));
  grip.reach_m = random.uniform(0.05, 0.09);
  return grip;
}

}  // namespace

Eigen::Matrix3d any_attitude(Random& random) {
  const double u = random.uniform();
  const double first = 2.0 * M_PI * random.uniform();
  const double second = 2.0 * M_PI * random.uniform();
  const double a = std::sqrt(1.0 - u);
  const double b = std::sqrt(u);
  return Eigen::Quaterniond(b * std::cos(second), a * std::sin(first), a * std::cos(first), b * std::sin(second))
      .toRotationMatrix();
}

PlacedAsset take_hold(const PlacedAsset& placed, const HeldPlace& place, Random& random) {
  constexpr int kTries = 400;
  const Eigen::Matrix3d R_world_object = placed.T_world_object.linear();
  const cv::Mat skin =
      plain({64, 64}, hsv(random.uniform(12, 26), random.uniform(0.3, 0.6), random.uniform(0.4, 0.9)), 0.06, random);
  const cv::Mat sleeve =
      fabric({128, 128}, hsv(random.uniform(0, 360), random.uniform(0.0, 0.6), random.uniform(0.15, 0.9)), random);
  for (int i = 0; i < kTries; ++i) {
    const Grip grip = draw_grip(place.arm_azimuth_rad, static_cast<double>(i) / kTries, random);
    const auto points = surface_points(placed.thing->mesh, grip.axes.transpose() * R_world_object);
    PlacedAsset hand{make_hand(points, grip, skin, sleeve), Eigen::Isometry3d::Identity(), 0, true};
    hand.T_world_object.linear() = grip.axes;
    hand.T_world_object.translation() = placed.T_world_object.translation();
    if (lowest_point(hand) < kOverTableM) continue;
    const double hidden = mean_hidden_fraction(hand, placed, place);
    if (hidden >= kMinGripped && hidden <= kMaxGripped) return hand;
  }
  fail("{}: no grip that hides {:.2f} to {:.2f} of it, after {} tries", placed.thing->name, kMinGripped, kMaxGripped,
       kTries);
}

AssetGroup hold(const AssetPtr& thing, int object_id, const HeldPlace& place, Random& random) {
  PlacedAsset placed{thing, Eigen::Isometry3d::Identity(), object_id, true};
  const Eigen::Matrix3d R_world_object = any_attitude(random);
  placed.T_world_object.linear() = R_world_object;
  const double height_m = random.uniform(kMinHeldM, kMaxHeldM);
  placed.T_world_object.translation() << place.over, height_m + height_above_table(thing->mesh, R_world_object);
  const PlacedAsset hand = take_hold(placed, place, random);
  return {hand, placed};
}

}  // namespace houghstream::world
