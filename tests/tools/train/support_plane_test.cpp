#include "tools/train/support_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/random.hpp"
#include "pipeline/types/plane.hpp"

namespace houghstream {
namespace {

const Camera kWideCamera{320, 240, 300.0, 300.0, 159.5, 119.5};
const Eigen::Vector3d kTableUp =
    -Eigen::Vector3d(0.0, std::cos(0.6), std::sin(0.6));  // the camera looks down at a table
constexpr double kTileDistance = 0.8;                     // to the object's middle

/// Returns a table 6 cm below a square thing that faces the camera, raised above the table by `gap_m`.
TrainingView standing_view(double gap_m) {
  TrainingView view;
  view.class_id = 1;
  view.T_camera_object.translation() = Eigen::Vector3d(0.0, 0.0, kTileDistance);
  view.frame.camera = kWideCamera;
  view.frame.colour = cv::Mat(kWideCamera.height, kWideCamera.width, CV_8UC3, cv::Scalar::all(90));
  view.frame.depth = cv::Mat(kWideCamera.height, kWideCamera.width, CV_32FC1);
  view.mask = cv::Mat::zeros(kWideCamera.height, kWideCamera.width, CV_8UC1);
  const Plane table(kTableUp, view.T_camera_object.translation() - (0.06 + gap_m) * kTableUp);
  Random random(1);
  for (int y = 0; y < kWideCamera.height; ++y) {
    for (int x = 0; x < kWideCamera.width; ++x) {
      const Eigen::Vector3d ray = kWideCamera.backproject(x, y, 1.0);
      const double z = -table.offset() / table.normal().dot(ray);
      const bool is_table = z > 0.0 && z < 2.0;
      view.frame.depth.at<float>(y, x) =
          is_table ? static_cast<float>(z + 0.001 * random.normal()) : std::numeric_limits<float>::quiet_NaN();
      const Eigen::Vector3d on_face = kTileDistance * ray;
      const double height = kTableUp.dot(on_face - view.T_camera_object.translation());
      if (std::abs(on_face.x()) > 0.05 || std::abs(height) > 0.06) continue;
      view.frame.depth.at<float>(y, x) = static_cast<float>(kTileDistance);
      view.mask.at<std::uint8_t>(y, x) = 255;
    }
  }
  return view;
}

TEST(FindSupport, IsThePlaneUnderTheObject) {
  const TrainingView view = standing_view(0.0);
  const auto support = find_support(view);
  ASSERT_TRUE(support);
  EXPECT_GT(support->normal().dot(kTableUp), 0.999);
  EXPECT_NEAR(support->signedDistance(view.T_camera_object.translation()), 0.06, 0.003);
}

TEST(FindSupport, IsNoneUnderWhatIsHeldAboveATable) {
  EXPECT_FALSE(find_support(standing_view(0.04)));
}

TEST(FindSupport, IsNoneWhereNothingIsSeenAroundTheObject) {
  TrainingView view = standing_view(0.0);
  view.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN(), view.mask == 0);
  EXPECT_FALSE(find_support(view));
}

TEST(FindSupports, LooksAtViewsOfObjectsAlone) {
  std::vector<TrainingView> views = {standing_view(0.0), standing_view(0.04), standing_view(0.0)};
  views[2].class_id = 0;
  views[2].mask.release();
  EXPECT_EQ(find_supports(views, 2), 1);
  EXPECT_TRUE(views[0].support && !views[1].support && !views[2].support);
}

}  // namespace
}  // namespace houghstream
