#include "drivers/virtual_camera/camera_pictures.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::virtual_camera {

cv::Point2d pattern_disc(const Camera& camera, int k) {
  const double turn = 2.0 * M_PI * k / kPatternPictures;
  return {0.5 * camera.width + 0.3 * camera.width * std::cos(turn),
          0.5 * camera.height + 0.3 * camera.height * std::sin(turn)};
}

CameraPictures make_test_pattern(const Camera& camera) {
  const cv::Size size(camera.width, camera.height);
  cv::Mat wall(size, CV_8UC3);
  cv::RNG random(1);
  random.fill(wall, cv::RNG::UNIFORM, cv::Scalar(20, 30, 60), cv::Scalar(60, 80, 140));
  CameraPictures all{camera, {}};
  for (int k = 0; k < kPatternPictures; ++k) {
    CameraPicture picture{wall.clone(), cv::Mat(size, CV_16UC1, cv::Scalar(kPatternWallMm))};
    const int radius = static_cast<int>(std::lround(kPatternRadius * camera.width));
    cv::circle(picture.colour, pattern_disc(camera, k), radius, cv::Scalar(kPatternDiscColour), cv::FILLED);
    cv::circle(picture.depth_mm, pattern_disc(camera, k), radius, cv::Scalar(kPatternDiscMm), cv::FILLED);
    all.pictures.push_back(std::move(picture));
  }
  return all;
}

CameraPictures load_scene_pictures(const std::filesystem::path& folder) {
  const BopScene scene(folder);
  const std::size_t count = scene.images().size();
  require(count > 0, "{}: has no images", folder.string());
  CameraPictures all{scene.images().front().camera, {}};
  for (std::size_t i = 0; i < count; ++i) {
    const RgbdFrame frame = scene.read_frame(i);
    require(frame.camera == all.camera, "{}: its cameras differ", folder.string());
    CameraPicture picture;
    cv::cvtColor(frame.colour, picture.colour, cv::COLOR_BGR2RGB);
    picture.depth_mm = depth_to_millimetres(frame.depth);
    all.pictures.push_back(std::move(picture));
  }
  for (std::size_t i = count; i-- > 0;) all.pictures.push_back(all.pictures[i]);
  return all;
}

}  // namespace houghstream::virtual_camera
