#include "drivers/virtual_camera/camera_images.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::virtual_camera {

cv::Point2d pattern_disc(const Camera& camera, int k) {
  const double turn = 2.0 * M_PI * k / kPatternImages;
  return {0.5 * camera.width + 0.3 * camera.width * std::cos(turn),
          0.5 * camera.height + 0.3 * camera.height * std::sin(turn)};
}

CameraImages make_test_pattern(const Camera& camera) {
  const cv::Size size(camera.width, camera.height);
  cv::Mat wall(size, CV_8UC3);
  cv::RNG random(1);
  random.fill(wall, cv::RNG::UNIFORM, cv::Scalar(20, 30, 60), cv::Scalar(60, 80, 140));
  CameraImages all{camera, {}};
  for (int k = 0; k < kPatternImages; ++k) {
    CameraImage image{wall.clone(), cv::Mat(size, CV_16UC1, cv::Scalar(kPatternWallMm))};
    const int radius = static_cast<int>(std::lround(kPatternRadius * camera.width));
    cv::circle(image.colour, pattern_disc(camera, k), radius, cv::Scalar(kPatternDiscColour), cv::FILLED);
    cv::circle(image.depth_mm, pattern_disc(camera, k), radius, cv::Scalar(kPatternDiscMm), cv::FILLED);
    all.images.push_back(std::move(image));
  }
  return all;
}

CameraImages load_scene_images(const std::filesystem::path& folder) {
  const BopScene scene(folder);
  const std::size_t count = scene.images().size();
  require(count > 0, "{}: has no images", folder.string());
  CameraImages all{scene.images().front().camera, {}};
  for (std::size_t i = 0; i < count; ++i) {
    const RgbdFrame frame = scene.read_frame(i);
    require(frame.camera == all.camera, "{}: its cameras differ", folder.string());
    CameraImage image;
    cv::cvtColor(frame.colour, image.colour, cv::COLOR_BGR2RGB);
    image.depth_mm = depth_to_millimetres(frame.depth);
    all.images.push_back(std::move(image));
  }
  for (std::size_t i = count; i-- > 0;) all.images.push_back(all.images[i]);
  return all;
}

}  // namespace houghstream::virtual_camera
