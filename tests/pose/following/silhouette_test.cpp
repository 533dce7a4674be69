#include "pose/following/silhouette.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

const ObjectModel& model_of_box() {
  static const ObjectModel model = make_object_model("box", cereal_box(), ModelSettings());
  return model;
}

const ObjectModel& model_of_mug() {
  static const ObjectModel model = make_object_model("mug", mug(), ModelSettings());
  return model;
}

/// Returns whether the model covers a pixel.
bool is_covered_at(const cv::Mat& depth, const Eigen::Vector2f& pixel) {
  const auto x = static_cast<int>(std::lround(pixel.x()));
  const auto y = static_cast<int>(std::lround(pixel.y()));
  return !std::isnan(depth.at<float>(y, x));
}

TEST(Silhouette, ItsPointsAreWhereTheModelEndsInTheImage) {
  for (const ObjectModel* model : {&model_of_box(), &model_of_mug()}) {
    const Eigen::Isometry3d T = standing(40.0, 30.0, 0.6);
    const Silhouette silhouette = make_silhouette(*model, T, 200);
    ASSERT_GE(silhouette.points.size(), 150U);
    ASSERT_LE(silhouette.points.size(), 220U);
    const cv::Mat depth = render_depth(model->mesh, T, kCamera, {0, 0, kCamera.width, kCamera.height});
    int right = 0;
    for (const SilhouettePoint& point : silhouette.points) {
      const Eigen::Vector2f pixel = kCamera.project_single(T.cast<float>() * point.point);
      const Eigen::Vector2f normal = (T.linear().cast<float>() * point.normal).head<2>().normalized();
      right += !is_covered_at(depth, pixel + 1.6F * normal) && is_covered_at(depth, pixel - 1.6F * normal) ? 1 : 0;
    }
    EXPECT_GE(right, static_cast<int>(0.95 * static_cast<double>(silhouette.points.size())));
  }
}

TEST(Silhouette, KnowsHowFarTheModelIsOnEachSide) {
  const Silhouette silhouette = make_silhouette(model_of_box(), standing(0.0, 0.0, 0.8), 200);
  int at_sides = 0;
  for (const SilhouettePoint& point : silhouette.points) {
    EXPECT_GT(point.outside_m, 0.1F) << "a box has no notch";
    if (std::abs(point.normal.x()) < 0.99F || std::abs(point.point.z()) > 0.1F) continue;
    ++at_sides;
    EXPECT_NEAR(point.inside_m, 0.18F, 0.01F) << "from side to side";
  }
  EXPECT_GT(at_sides, 20);
}

TEST(Silhouette, DependsOnNothingButWhereTheCameraIs) {
  const Eigen::Isometry3d T = standing(40.0, 30.0, 0.6);
  const Silhouette silhouette = make_silhouette(model_of_box(), T, 100);
  Eigen::Isometry3d rolled = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) * T;
  EXPECT_TRUE(is_silhouette_of(silhouette, model_of_box(), rolled));
  Eigen::Isometry3d rotated = T;
  rotated.rotate(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(is_silhouette_of(silhouette, model_of_box(), rotated));
  rotated.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));
  EXPECT_FALSE(is_silhouette_of(silhouette, model_of_box(), rotated));
  EXPECT_FALSE(is_silhouette_of(silhouette, model_of_box(), standing(40.0, 30.0, 0.7)));
}

TEST(Silhouette, ThereIsNoneInsideTheModel) {
  EXPECT_TRUE(make_silhouette(model_of_box(), standing(0.0, 0.0, 0.1), 100).points.empty());
}

}  // namespace
}  // namespace houghstream
