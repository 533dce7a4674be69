#include "drivers/virtual_camera/camera_images.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::virtual_camera {
namespace {

TEST(CameraImages, TheDiscOfThePatternMoves) {
  const Camera camera{320, 240, 262.5, 262.5, 159.5, 119.5};
  const CameraImages pattern = make_test_pattern(camera);
  ASSERT_EQ(pattern.images.size(), static_cast<std::size_t>(kPatternImages));
  for (int k = 0; k < kPatternImages; ++k) {
    const cv::Point2d disc = pattern_disc(camera, k);
    EXPECT_EQ(pattern.images[k].depth_mm.at<std::uint16_t>(disc), kPatternDiscMm);
    EXPECT_EQ(pattern.images[k].colour.at<cv::Vec3b>(disc), kPatternDiscColour);
    EXPECT_GT(cv::norm(disc - pattern_disc(camera, k + 1)), 5.0) << "pixels: a neighbour's colour would lie beside it";
  }
}

TEST(CameraImages, ASceneIsPlayedForwardsAndBackwards) {
  const auto folder = fresh_folder("camera_scene");
  BopWriter writer(folder);
  for (const int blue : {10, 20, 30}) {
    RgbdFrame frame = plain_frame();
    frame.colour = cv::Scalar(blue, 100, 200);
    writer.add(frame, {}, {});
  }
  writer.finish();
  const CameraImages scene = load_scene_images(folder);
  std::vector<int> blue;
  for (const CameraImage& image : scene.images) blue.push_back(image.colour.at<cv::Vec3b>(5, 5)[2]);
  EXPECT_EQ(blue, (std::vector<int>{10, 20, 30, 30, 20, 10})) << "RGB";
  EXPECT_EQ(scene.images[0].depth_mm.at<std::uint16_t>(5, 5), 1000);
  EXPECT_EQ(scene.images[0].depth_mm.at<std::uint16_t>(0, 0), 0) << "none";
  EXPECT_THROW(load_scene_images(folder / "none"), InputError);
}

}  // namespace
}  // namespace houghstream::virtual_camera
