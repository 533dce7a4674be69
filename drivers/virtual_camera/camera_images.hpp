#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/types/camera.hpp"

namespace houghstream::virtual_camera {

/// Holds an image of each of the virtual camera's sensors, with depth registered to colour.
struct CameraImage {
  cv::Mat colour;    ///< CV_8UC3, RGB
  cv::Mat depth_mm;  ///< CV_16UC1, 0 = none
};

/// Images of the virtual camera.
struct CameraImages {
  Camera camera;
  std::vector<CameraImage> images;  ///< shown one after another, again and again
};

/// The disc of the test pattern moves fast enough that an image's neighbours show it elsewhere.
constexpr int kPatternImages = 60;                        ///< then it is where it was
cv::Point2d pattern_disc(const Camera& camera, int k);    ///< centre in image k, pixels
constexpr double kPatternRadius = 0.08;                   ///< fraction of the width
constexpr std::uint16_t kPatternDiscMm = 800;             ///< depth of the disc,
constexpr std::uint16_t kPatternWallMm = 1500;            ///< depth of the wall behind it
inline const cv::Vec3b kPatternDiscColour{250, 240, 20};  ///< RGB; the wall is darker and bluish, with a fixed pattern

CameraImages make_test_pattern(const Camera& camera);

/// Loads all images of a BOP scene folder, forwards and then backwards, so that there is no jump. Throws InputError.
CameraImages load_scene_images(const std::filesystem::path& folder);

}  // namespace houghstream::virtual_camera
