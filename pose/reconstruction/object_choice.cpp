#include "pose/reconstruction/object_choice.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/random.hpp"
#include "pose/reconstruction/frame_levels.hpp"

namespace houghstream::reconstruction {
namespace {

constexpr double kCell_m = 0.005;      // of the plane, for what hangs together
constexpr double kHalfExtent_m = 0.8;  // of the plane that is looked at
constexpr double kLowest_m = 0.006;    // above the plane: what is lower is taken for the plane

double plane_distance_limit(double z) {
  return 0.004 + 2.0 * depth_sigma(z);
}

std::vector<Eigen::Vector3d> scattered_points(const RgbdFrame& frame, double farthest_m) {
  constexpr int kStep_px = 4;
  std::vector<Eigen::Vector3d> points;
  for (int y = kStep_px / 2; y < frame.depth.rows; y += kStep_px) {
    for (int x = kStep_px / 2; x < frame.depth.cols; x += kStep_px) {
      const float z = frame.depth.at<float>(y, x);
      if (z > 0.15F && z < farthest_m) points.push_back(frame.camera.backproject(x, y, z));
    }
  }
  return points;
}

Plane towards_camera(const Eigen::Vector3d& normal, double offset) {
  if (offset < 0.0) return {-normal, -offset};
  return {normal, offset};
}

/// Least squares through points, weighted as exactly as they are measured.
Plane fit_plane(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double weights = 0.0;
  const auto weight_of = [](const Eigen::Vector3d& p) { return 1.0 / (depth_sigma(p.z()) * depth_sigma(p.z())); };
  for (const Eigen::Vector3d& p : points) {
    mean += weight_of(p) * p;
    weights += weight_of(p);
  }
  mean /= weights;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) squares += weight_of(p) * (p - mean) * (p - mean).transpose();
  const Eigen::Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares).eigenvectors().col(0);
  return towards_camera(normal, -normal.dot(mean));
}

std::vector<Eigen::Vector3d> inliers_of(const Plane& plane, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> inliers;
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(plane.height(p)) < plane_distance_limit(p.z())) inliers.push_back(p);
  }
  return inliers;
}

std::optional<Plane> largest_plane(const std::vector<Eigen::Vector3d>& points, Random& random) {
  constexpr int kTrials = 400;
  constexpr std::size_t kCounted = 1500;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kCounted);
  std::optional<Plane> best;
  int most = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto pick = [&] { return points[static_cast<std::size_t>(random.below(static_cast<int>(points.size())))]; };
    const Eigen::Vector3d a = pick();
    const Eigen::Vector3d b = pick();
    const Eigen::Vector3d c = pick();
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-3) continue;
    const Plane plane = towards_camera(normal.normalized(), -normal.normalized().dot(a));
    int count = 0;
    for (std::size_t i = 0; i < points.size(); i += step)
      count += std::abs(plane.height(points[i])) < plane_distance_limit(points[i].z()) ? 1 : 0;
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  return best;
}

/// A camera held upright looks down on a table, or straight down.
bool may_carry(const Plane& plane) {
  return plane.offset > 0.08 && (-plane.normal.y() > 0.2 || -plane.normal.z() > 0.8);
}

/// Coordinates in a plane.
struct PlaneAxes {
  Eigen::Vector3d origin, x, y;

  /// About the point at which the camera looks, x to the camera's right.
  PlaneAxes(const Plane& plane, const Eigen::Vector3d& middle_ray) {
    const double along = plane.normal.dot(middle_ray);
    const double z = along < -1e-3 ? std::min(-plane.offset / along, 3.0) : 3.0;
    const Eigen::Vector3d ahead = z * middle_ray;
    origin = ahead - plane.height(ahead) * plane.normal;
    x = (Eigen::Vector3d::UnitX() - plane.normal.x() * plane.normal).normalized();
    y = plane.normal.cross(x);
  }
  std::optional<cv::Point> cell_of(const Eigen::Vector3d& point) const {
    const int u = static_cast<int>(std::floor((x.dot(point - origin) + kHalfExtent_m) / kCell_m));
    const int v = static_cast<int>(std::floor((y.dot(point - origin) + kHalfExtent_m) / kCell_m));
    if (u < 1 || v < 1 || u >= cells() - 1 || v >= cells() - 1) return std::nullopt;
    return cv::Point(u, v);
  }
  Eigen::Vector3d point_at(double u, double v) const {
    return origin + (u * kCell_m - kHalfExtent_m) * x + (v * kCell_m - kHalfExtent_m) * y;
  }
  static int cells() { return static_cast<int>(std::lround(2 * kHalfExtent_m / kCell_m)); }
};

/// Something above the plane that hangs together.
struct Cluster {
  int pixels = 0;
  double lowest = 1e9, highest = 0.0;  ///< above the plane, metres
  double to_middle_px = 1e9;           ///< of its nearest pixel
  cv::Rect cells;
};

struct Clusters {
  cv::Mat of_pixel;  ///< CV_32SC1, 0 = none
  std::vector<Cluster> list;
};

cv::Point2d meant_place(const RgbdFrame& frame, const ChoiceSettings& settings) {
  if (settings.box_px) return (settings.box_px->tl() + settings.box_px->br()) * 0.5;
  if (settings.at_px) return *settings.at_px;
  return {0.5 * frame.depth.cols, 0.5 * frame.depth.rows};
}

/// Where each pixel above the plane falls on it; (-1,-1) for the others.
cv::Mat cells_of_pixels(const RgbdFrame& frame, const Plane& plane, const PlaneAxes& axes,
                        const ChoiceSettings& settings, cv::Mat& grid) {
  constexpr double kHighest_m = 0.75;
  const cv::Rect whole({0, 0}, frame.depth.size());
  const cv::Rect where = settings.box_px.value_or(whole) & whole;
  cv::Mat cells(frame.depth.size(), CV_32SC2, cv::Scalar(-1, -1));
  grid = cv::Mat::zeros(PlaneAxes::cells(), PlaneAxes::cells(), CV_8UC1);
  for (int y = where.y; y < where.br().y; ++y) {
    for (int x = where.x; x < where.br().x; ++x) {
      const float z = frame.depth.at<float>(y, x);
      if (!(z > 0.1F && z < settings.farthest_m)) continue;
      const Eigen::Vector3d p = frame.camera.backproject(x, y, z);
      const double height = plane.height(p);
      if (height < std::max(kLowest_m, 3.0 * depth_sigma(z)) || height > kHighest_m) continue;
      const auto cell = axes.cell_of(p);
      if (!cell) continue;
      cells.at<cv::Vec2i>(y, x) = {cell->x, cell->y};
      grid.at<std::uint8_t>(*cell) = 255;
    }
  }
  return cells;
}

Clusters find_clusters(const RgbdFrame& frame, const Plane& plane, const PlaneAxes& axes,
                       const ChoiceSettings& settings) {
  cv::Mat grid, joined, labels;
  const cv::Mat cells = cells_of_pixels(frame, plane, axes, settings, grid);
  cv::dilate(grid, joined, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  Clusters clusters;
  clusters.list.resize(static_cast<std::size_t>(cv::connectedComponents(joined, labels, 8, CV_32S)));
  clusters.of_pixel = cv::Mat::zeros(frame.depth.size(), CV_32SC1);
  const cv::Point2d meant = meant_place(frame, settings);
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      const auto& cell = cells.at<cv::Vec2i>(y, x);
      if (cell[0] < 0) continue;
      const int label = labels.at<int>(cell[1], cell[0]);
      clusters.of_pixel.at<int>(y, x) = label;
      Cluster& cluster = clusters.list[static_cast<std::size_t>(label)];
      const double height = plane.height(frame.camera.backproject(x, y, frame.depth.at<float>(y, x)));
      ++cluster.pixels;
      cluster.lowest = std::min(cluster.lowest, height);
      cluster.highest = std::max(cluster.highest, height);
      cluster.to_middle_px = std::min(cluster.to_middle_px, std::hypot(x - meant.x, y - meant.y));
      cluster.cells =
          cluster.cells.empty() ? cv::Rect(cell[0], cell[1], 1, 1) : cluster.cells | cv::Rect(cell[0], cell[1], 1, 1);
    }
  }
  return clusters;
}

/// The cluster that is meant; 0 = none.
int meant_cluster(const Clusters& clusters, const RgbdFrame& frame, const ChoiceSettings& settings) {
  constexpr int kFewestPixels = 60;
  constexpr double kHighestFoot_m = 0.035;
  int best = 0;
  double best_rank = 1e18;
  for (std::size_t i = 1; i < clusters.list.size(); ++i) {
    const Cluster& cluster = clusters.list[i];
    if (cluster.pixels < kFewestPixels || cluster.lowest > kHighestFoot_m) continue;
    if (!settings.box_px && cluster.to_middle_px > settings.farthest_share * frame.depth.cols) continue;
    const double rank = settings.box_px ? -cluster.pixels : cluster.to_middle_px - 1e-6 * cluster.pixels;
    if (rank >= best_rank) continue;
    best_rank = rank;
    best = static_cast<int>(i);
  }
  return best;
}

/// Why the chosen cluster cannot be taught; empty where it can.
std::string fault_of(const ChosenObject& object, const RgbdFrame& frame, const ChoiceSettings& settings) {
  const double widest = std::max(2.0 * object.radius_m, object.height_m);
  if (widest > settings.largest_m)
    return fmt::format(
        "what is meant is {:.0f} cm large, expected at most {:.0f} cm that stand apart from other things", 1e2 * widest,
        1e2 * settings.largest_m);
  if (std::max(object.radius_m, object.height_m) < settings.smallest_m)
    return fmt::format("what is meant is {:.0f} mm large, expected at least {:.0f} mm", 1e3 * widest,
                       1e3 * settings.smallest_m);
  const cv::Rect inner(2, 2, frame.depth.cols - 4, frame.depth.rows - 4);
  if ((object.box_px & inner) != object.box_px)
    return "what is meant is cut by the picture's edge, expected the whole object in the first picture";
  return {};
}

ChosenObject make_object(const RgbdFrame& frame, const Plane& plane, const PlaneAxes& axes, const Clusters& clusters,
                         int chosen) {
  const Cluster& cluster = clusters.list[static_cast<std::size_t>(chosen)];
  ChosenObject object;
  object.mask = clusters.of_pixel == chosen;
  object.box_px = cv::boundingRect(object.mask);
  constexpr double kLikeSkin = 0.15;
  object.like_skin =
      cv::countNonZero(skin_pixels(frame.colour) & object.mask) > kLikeSkin * cv::countNonZero(object.mask);
  const Eigen::Vector3d middle =
      axes.point_at(cluster.cells.x + 0.5 * cluster.cells.width, cluster.cells.y + 0.5 * cluster.cells.height);
  object.plane = refine_plane(frame, object.mask, plane, middle, 0.5);
  object.radius_m = 0.5 * kCell_m * std::hypot(cluster.cells.width, cluster.cells.height);
  object.height_m = cluster.highest;
  const Eigen::Vector3d& z = object.plane.normal;
  const Eigen::Vector3d x = (axes.x - axes.x.dot(z) * z).normalized();
  object.T_camera_stand.linear() << x, z.cross(x), z;
  object.T_camera_stand.translation() = middle - object.plane.height(middle) * z;
  return object;
}

/// Whether the surface about a pixel is level.
bool is_level(const RgbdFrame& frame, const Plane& plane, int x, int y) {
  constexpr int kApart_px = 3;
  constexpr double kCosine = 0.9;
  if (x < kApart_px || y < kApart_px || x + kApart_px >= frame.depth.cols || y + kApart_px >= frame.depth.rows)
    return false;
  const auto point = [&](int u, int v) { return frame.camera.backproject(u, v, frame.depth.at<float>(v, u)); };
  const Eigen::Vector3d normal =
      (point(x + kApart_px, y) - point(x - kApart_px, y)).cross(point(x, y + kApart_px) - point(x, y - kApart_px));
  return normal.allFinite() && std::abs(normal.normalized().dot(plane.normal)) > kCosine;
}

/// What looks like one thing may be a thing on a disc, a book or a box lid: a wide level that carries something
/// smaller.
std::optional<Plane> carried_by(const RgbdFrame& frame, const ChosenObject& object) {
  constexpr double kBin_m = 0.002;
  constexpr double kHighest_m = 0.06;
  constexpr double kAbove_m = 0.012;
  constexpr double kLeastShare = 0.25;
  std::array<int, 31> levels{};
  int all = 0;
  for (int y = 0; y < object.mask.rows; ++y) {
    for (int x = 0; x < object.mask.cols; ++x) {
      if (object.mask.at<std::uint8_t>(y, x) == 0) continue;
      ++all;
      const double height = object.plane.height(frame.camera.backproject(x, y, frame.depth.at<float>(y, x)));
      if (height < kHighest_m && is_level(frame, object.plane, x, y))
        ++levels[static_cast<std::size_t>(height / kBin_m)];
    }
  }
  std::size_t best = 1;
  const auto about = [&](std::size_t i) { return levels[i - 1] + levels[i] + levels[i + 1]; };
  for (std::size_t i = 1; i + 1 < levels.size(); ++i) best = about(i) > about(best) ? i : best;
  if (about(best) < kLeastShare * all) return std::nullopt;
  const double level = kBin_m * (static_cast<double>(best) + 0.5);
  cv::Mat on_level = cv::Mat::zeros(object.mask.size(), CV_8UC1);
  Eigen::AlignedBox2d level_box, above_box;
  const Eigen::Isometry3d T_stand_camera = object.T_camera_stand.inverse();
  for (int y = 0; y < object.mask.rows; ++y) {
    for (int x = 0; x < object.mask.cols; ++x) {
      if (object.mask.at<std::uint8_t>(y, x) == 0) continue;
      const Eigen::Vector3d p = T_stand_camera * frame.camera.backproject(x, y, frame.depth.at<float>(y, x));
      if (std::abs(p.z() - level) < 2.0 * kBin_m) {
        on_level.at<std::uint8_t>(y, x) = 255;
        level_box.extend(p.head<2>());
      } else if (p.z() > level + kAbove_m) {
        above_box.extend(p.head<2>());
      }
    }
  }
  if (above_box.isEmpty() || above_box.diagonal().norm() > 0.85 * level_box.diagonal().norm()) return std::nullopt;
  Plane plane = object.plane;
  plane.offset -= level;
  const cv::Mat elsewhere = on_level == 0;
  return refine_plane(frame, elsewhere, plane, object.T_camera_stand.translation(), 0.5);
}

std::string nothing_there(const ChoiceSettings& settings) {
  if (settings.box_px) return "nothing with depth stands in the box, expected an object on the table there";
  if (settings.at_px)
    return fmt::format("nothing with depth stands near {},{}, expected an object on the table there", settings.at_px->x,
                       settings.at_px->y);
  return "nothing with depth stands near the picture's middle, expected an object there (or --box; what is transparent "
         "has no depth)";
}

/// What stands on this plane and is meant.
Choice choose_on(const RgbdFrame& frame, const Plane& plane, const ChoiceSettings& settings) {
  const cv::Point2d meant = meant_place(frame, settings);
  const PlaneAxes axes(plane, frame.camera.backproject(meant.x, meant.y, 1.0));
  const Clusters clusters = find_clusters(frame, plane, axes, settings);
  const int chosen = meant_cluster(clusters, frame, settings);
  if (chosen == 0) return {{}, nothing_there(settings)};
  ChosenObject object = make_object(frame, plane, axes, clusters, chosen);
  object.boxed = settings.box_px.has_value();
  if (const std::optional<Plane> carrier = carried_by(frame, object)) {
    if (Choice carried = choose_on(frame, *carrier, settings); carried.object) return carried;
  }
  std::string fault = fault_of(object, frame, settings);
  if (!fault.empty()) return {{}, std::move(fault)};
  return {std::move(object), {}};
}

}  // namespace

cv::Mat skin_pixels(const cv::Mat& colour) {
  cv::Mat ycrcb, skin;
  cv::cvtColor(colour, ycrcb, cv::COLOR_BGR2YCrCb);
  cv::inRange(ycrcb, cv::Scalar(20, 136, 77), cv::Scalar(255, 176, 127), skin);
  return skin;
}

std::vector<Plane> find_planes(const RgbdFrame& frame, const ChoiceSettings& settings) {
  constexpr int kMost = 5;
  std::vector<Eigen::Vector3d> points = scattered_points(frame, settings.farthest_m);
  const auto fewest = std::max<std::size_t>(150, points.size() / 15);
  Random random(settings.seed);
  std::vector<Plane> planes;
  for (int i = 0; i < kMost && points.size() > fewest; ++i) {
    std::optional<Plane> plane = largest_plane(points, random);
    if (!plane) break;
    for (int again = 0; again < 2; ++again) {
      const std::vector<Eigen::Vector3d> inliers = inliers_of(*plane, points);
      if (inliers.size() < fewest) return planes;
      plane = fit_plane(inliers);
    }
    if (may_carry(*plane)) planes.push_back(*plane);
    points.erase(std::remove_if(points.begin(), points.end(),
                                [&](const Eigen::Vector3d& p) {
                                  return std::abs(plane->height(p)) < 2.0 * plane_distance_limit(p.z());
                                }),
                 points.end());
  }
  return planes;
}

Plane refine_plane(const RgbdFrame& frame, const cv::Mat& mask, const Plane& plane, const Eigen::Vector3d& middle,
                   double radius_m) {
  constexpr std::size_t kFewest = 200;
  Plane refined = plane;
  for (int again = 0; again < 3; ++again) {
    std::vector<Eigen::Vector3d> points;
    for (int y = 1; y < frame.depth.rows; y += 2) {
      for (int x = 1; x < frame.depth.cols; x += 2) {
        const float z = frame.depth.at<float>(y, x);
        if (!(z > 0.1F) || (!mask.empty() && mask.at<std::uint8_t>(y, x) != 0)) continue;
        const Eigen::Vector3d p = frame.camera.backproject(x, y, z);
        if (std::abs(refined.height(p)) < plane_distance_limit(z) && (p - middle).norm() < radius_m)
          points.push_back(p);
      }
    }
    if (points.size() < kFewest) return plane;
    refined = fit_plane(points);
  }
  return refined;
}

Choice choose_object(const RgbdFrame& frame, const ChoiceSettings& settings) {
  const cv::Rect whole({0, 0}, frame.depth.size());
  if (settings.box_px && (*settings.box_px & whole) != *settings.box_px)
    return {{}, fmt::format("the box lies not within the picture, which has {}x{} pixels", whole.width, whole.height)};
  if (settings.at_px && !whole.contains(*settings.at_px))
    return {{},
            fmt::format("{},{} lies not within the picture, which has {}x{} pixels", settings.at_px->x,
                        settings.at_px->y, whole.width, whole.height)};
  const std::vector<Plane> planes = find_planes(frame, settings);
  if (planes.empty()) return {{}, "no table or other level surface is seen, expected one on which the object stands"};
  Choice first;
  for (const Plane& plane : planes) {
    Choice choice = choose_on(frame, plane, settings);
    if (choice.object) return choice;
    if (first.reason.empty()) first = std::move(choice);
  }
  return first;
}

std::string describe_choice(const ChosenObject& object) {
  const cv::Point middle = (object.box_px.tl() + object.box_px.br()) / 2;
  return fmt::format("meant is what stands at {},{} in the picture, {:.0f} cm across and {:.0f} cm high", middle.x,
                     middle.y, 2e2 * object.radius_m, 1e2 * object.height_m);
}

std::optional<cv::Rect> seen_box(const Eigen::AlignedBox3d& box, const Camera& camera,
                                 const Eigen::Isometry3d& T_camera_box) {
  std::vector<cv::Point2f> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d p = T_camera_box * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
    if (p.z() < 0.05) return std::nullopt;
    const Eigen::Vector2d px = camera.project(p);
    corners.emplace_back(static_cast<float>(px.x()), static_cast<float>(px.y()));
  }
  return cv::boundingRect(corners);
}

}  // namespace houghstream::reconstruction
