#include "tools/render/world/mesh_views.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

/// Makes a brick of 8 x 12 x 18 cm with its lower corner at `low`, since a mesh's origin has no meaning.
Mesh brick(const cv::Vec3b& colour, const Eigen::Vector3f& low = {0.3F, -0.2F, 0.1F}) {
  Mesh mesh = box({0.08, 0.12, 0.18}, cv::Mat(8, 8, CV_8UC3, cv::Scalar::all(0)));
  mesh.texture.release();
  mesh.uvs.clear();
  mesh.colours.assign(mesh.vertices.size(), colour);
  const Eigen::Vector3f shift = low - mesh_bounds(mesh).min();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex += shift;
  return mesh;
}

const cv::Vec3b kRed(30, 30, 200);

/// Returns a brick of which the first so many sides are missing.
Mesh open_brick(int sides) {
  Mesh mesh = brick(kRed);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2 * sides);
  return mesh;
}

MeshViewSettings few_views(MeshAttitudes attitudes = MeshAttitudes::kResting) {
  MeshViewSettings settings;
  settings.attitudes = attitudes;
  settings.views_per_attitude = 4;
  settings.max_views = 60;
  return settings;
}

// Returns whether the bytes are equal, NaN included.
bool same_pixels(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && std::equal(a.datastart, a.dataend, b.datastart);
}

/// Returns the brick as a camera sees it: its sides are rough and bulge, so that it stands firmly on none of them.
Mesh bulging_brick() {
  constexpr int kSteps = 48;
  constexpr double kBulge_m = 0.0005;
  Mesh mesh;
  constexpr double kNoise_m = 0.0002;
  const Eigen::Vector3d half(0.04, 0.06, 0.09);
  Random random(7);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          const double u = 2.0 * i / kSteps - 1.0, v = 2.0 * j / kSteps - 1.0;
          Eigen::Vector3d p;
          p[axis] = sign * (half[axis] + kBulge_m * (1.0 - u * u) * (1.0 - v * v) + kNoise_m * random.normal());
          p[(axis + 1) % 3] = u * half[(axis + 1) % 3];
          p[(axis + 2) % 3] = sign * v * half[(axis + 2) % 3];
          mesh.vertices.push_back(p.cast<float>());
          mesh.colours.push_back(kRed);
        }
      }
      for (std::uint32_t i = 0; i < kSteps; ++i) {
        for (std::uint32_t j = 0; j < kSteps; ++j) {
          const std::uint32_t a = first + i * (kSteps + 1) + j, b = a + kSteps + 1;
          mesh.triangles.push_back({a, b, b + 1});
          mesh.triangles.push_back({a, b + 1, a + 1});
        }
      }
    }
  }
  compute_normals(mesh);
  return mesh;
}

void expect_six_sides(const std::vector<Eigen::Vector3d>& ups, double min_cosine = 0.9999) {
  ASSERT_EQ(ups.size(), 6U);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      const Eigen::Vector3d side = sign * Eigen::Vector3d::Unit(axis);
      const auto is_side = [&](const Eigen::Vector3d& up) { return up.dot(side) > min_cosine; };
      EXPECT_EQ(std::count_if(ups.begin(), ups.end(), is_side), 1) << axis << ' ' << sign;
    }
  }
}

TEST(UpDirections, OfABoxAreItsSidesTheFirmestFirst) {
  const std::vector<Eigen::Vector3d> ups = up_directions(brick(kRed), MeshAttitudes::kResting);
  expect_six_sides(ups);
  EXPECT_GT(std::abs(ups[0].x()), 0.99) << "flat on its largest side";
  EXPECT_GT(std::abs(ups[1].x()), 0.99);
  EXPECT_GT(std::abs(ups[5].z()), 0.99);
}

TEST(UpDirections, OfAnOpenMeshAreTheSidesOfItsBox) {
  for (int sides = 1; sides < 6; ++sides) {
    SCOPED_TRACE(sides);
    expect_six_sides(up_directions(open_brick(sides), MeshAttitudes::kResting));
  }
}

TEST(MeshViews, AScanWhoseSidesAreNotQuiteFlatStandsOnThemAll) {
  expect_six_sides(up_directions(bulging_brick(), MeshAttitudes::kResting), 0.998);
}

TEST(UpDirections, AreTheZAxisOrNoneWhereAsked) {
  const std::vector<Eigen::Vector3d> upright = up_directions(brick(kRed), MeshAttitudes::kUpright);
  ASSERT_EQ(upright.size(), 1U);
  EXPECT_EQ(upright[0], Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(up_directions(brick(kRed), MeshAttitudes::kAny).empty());
  EXPECT_EQ(parse_mesh_attitudes("any"), MeshAttitudes::kAny);
  EXPECT_THROW(parse_mesh_attitudes("flying"), InputError);
}

TEST(MeshViews, AreAsManyOfEachAttitudeAsAskedForButNotTooMany) {
  MeshViewSettings settings = few_views();
  EXPECT_EQ(MeshViews(brick(kRed), settings, 1).count(), 24);
  EXPECT_EQ(MeshViews(open_brick(1), settings, 1).count(), 24);
  settings.max_views = 18;
  EXPECT_EQ(MeshViews(brick(kRed), settings, 1).count(), 18);
  EXPECT_EQ(MeshViews(brick(kRed), few_views(MeshAttitudes::kUpright), 1).count(), 4);
  EXPECT_EQ(MeshViews(brick(kRed), few_views(MeshAttitudes::kAny), 1).count(), 60);
  EXPECT_TRUE(MeshViews(brick(kRed), few_views(MeshAttitudes::kAny), 1).ups().empty());
}

TEST(MeshViews, TheSameSeedGivesTheSameViews) {
  const MeshViews views(brick(kRed), few_views(), 5);
  const TrainingView view = views.render(3);
  const TrainingView again = MeshViews(brick(kRed), few_views(), 5).render(3);
  EXPECT_TRUE(same_pixels(view.frame.colour, again.frame.colour));
  EXPECT_TRUE(same_pixels(view.frame.depth, again.frame.depth));
  EXPECT_TRUE(view.T_camera_object.matrix() == again.T_camera_object.matrix());
  const TrainingView other = MeshViews(brick(kRed), few_views(), 6).render(3);
  EXPECT_FALSE(same_pixels(view.frame.colour, other.frame.colour));
}

TEST(MeshViews, TheMaskAndTheDepthAreThoseOfTheMeshAtItsPose) {
  for (const MeshAttitudes attitudes : {MeshAttitudes::kResting, MeshAttitudes::kAny}) {
    const Mesh mesh = brick(kRed);
    const MeshViews views(mesh, few_views(attitudes), 1);
    for (int index = 0; index < views.count(); index += 5) {
      const TrainingView view = views.render(index);
      check_frame(view.frame, "rendered");
      const cv::Rect all({0, 0}, view.mask.size());
      const cv::Mat rendered = render_depth(mesh, view.T_camera_object, view.frame.camera, all);
      const cv::Mat shown = rendered == rendered;
      EXPECT_GT(cv::countNonZero(view.mask), 2000) << index;
      EXPECT_LE(cv::countNonZero(shown != view.mask), cv::countNonZero(view.mask) / 100) << index;
      EXPECT_EQ(cv::countNonZero(view.mask.row(0)) + cv::countNonZero(view.mask.col(0)), 0) << "all of it is seen";
      std::vector<float> errors;
      for (int i = 0; i < static_cast<int>(rendered.total()); ++i) {
        const float error = std::abs(view.frame.depth.at<float>(i / all.width, i % all.width) -
                                     rendered.at<float>(i / all.width, i % all.width));
        if (error == error) errors.push_back(error);
      }
      ASSERT_GT(errors.size(), 1000U) << index;
      std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
      EXPECT_LT(errors[errors.size() / 2], 0.006F) << index;
    }
  }
}

TEST(MeshViews, KnowThePlaneThatTheMeshStandsOn) {
  const MeshViews views(brick(kRed), few_views(), 1);
  int standing = 0;
  for (int index = 0; index < views.count(); ++index) {
    const TrainingView view = views.render(index);
    if (!view.support) continue;
    ++standing;
    std::vector<double> distances;
    for (int y = 0; y < view.mask.rows; ++y) {
      for (int x = 0; x < view.mask.cols; ++x) {
        const float z = view.frame.depth.at<float>(y, x);
        if (view.mask.at<std::uint8_t>(y, x) != 0 || !(z < 1.0F)) continue;  // the wall is farther
        distances.push_back(std::abs(view.support->signedDistance(view.frame.camera.backproject(x, y, z))));
      }
    }
    ASSERT_GT(distances.size(), 200U) << index;
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    EXPECT_LT(*middle, 0.005) << index;
  }
  EXPECT_GT(standing, views.count() / 2);
}

TEST(MeshViews, ShowAMeshUpsideDownToo) {
  const MeshViews views(brick(kRed), few_views(), 1);
  std::set<std::pair<int, bool>> towards_camera;  // axis, sign
  for (int index = 0; index < views.count(); ++index) {
    const TrainingView view = views.render(index);
    const Eigen::Vector3d middle = mesh_bounds(brick(kRed)).center().cast<double>();
    const Eigen::Vector3d eye = view.T_camera_object.inverse().translation() - middle;
    EXPECT_NEAR(eye.norm(), 0.7, 0.05);
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(eye[axis]) > 0.4 * eye.norm()) towards_camera.insert({axis, eye[axis] > 0.0});
    }
  }
  EXPECT_EQ(towards_camera.size(), 6U) << "every side is seen";
}

/// Returns the mean of a* and b* over the mask.
Eigen::Vector2d chroma(const TrainingView& view) {
  cv::Mat lab;
  cv::cvtColor(view.frame.colour, lab, cv::COLOR_BGR2Lab);
  const cv::Scalar mean = cv::mean(lab, view.mask);
  return {mean[1] - 128.0, mean[2] - 128.0};
}

/// Returns the largest distance between the chroma of two views.
double spread_of_chroma(const MeshViews& views) {
  std::vector<Eigen::Vector2d> all;
  for (int index = 0; index < views.count(); index += 3) all.push_back(chroma(views.render(index)));
  double maximum = 0.0;
  for (const Eigen::Vector2d& a : all) {
    for (const Eigen::Vector2d& b : all) maximum = std::max(maximum, (a - b).norm());
  }
  return maximum;
}

TEST(MeshViews, ShowTheColoursOfVertices) {
  const MeshViews red(brick(kRed), few_views(), 1);
  const MeshViews blue(brick({200, 60, 20}), few_views(), 1);
  for (int index = 0; index < red.count(); index += 3) {
    const cv::Scalar of_red = cv::mean(red.render(index).frame.colour, red.render(index).mask);
    EXPECT_GT(of_red[2], 1.5 * of_red[0]) << index;
    const cv::Scalar of_blue = cv::mean(blue.render(index).frame.colour, blue.render(index).mask);
    EXPECT_GT(of_blue[0], 1.5 * of_blue[2]) << index;
  }
}

TEST(MeshViews, AMeshWithoutColoursHasAnotherInEveryView) {
  MeshViewSettings settings = few_views();
  const double coloured = spread_of_chroma(MeshViews(brick(kRed), settings, 1));
  settings.has_colour = false;
  const double colourless = spread_of_chroma(MeshViews(brick(kRed), settings, 1));
  EXPECT_GT(colourless, 60.0);
  EXPECT_GT(colourless, 1.5 * coloured);
  Mesh bare = brick(kRed);
  bare.colours.clear();
  EXPECT_TRUE(same_pixels(MeshViews(bare, settings, 1).render(2).frame.colour,
                          MeshViews(brick(kRed), settings, 1).render(2).frame.colour))
      << "what colours it has do not count";
  EXPECT_THROW(MeshViews(bare, few_views(), 1), InputError);
}

TEST(RandomRotation, IsARotationAndAllDirectionsAreAlike) {
  Random random(1);
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Matrix3d R = random_rotation(random);
    ASSERT_NEAR(R.determinant(), 1.0, 1e-9);
    mean += R / 2000.0;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.06);
}

}  // namespace
}  // namespace houghstream::world
