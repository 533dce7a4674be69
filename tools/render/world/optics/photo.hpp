#pragma once

#include <cstdint>

#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

/// Returns the factor on the light at which automatic exposure settles for an image (CV_32FC3, linear). Cameras do not
/// follow the scene's brightness all the way: dark rooms stay darker.
double automatic_exposure(const cv::Mat& radiance, const ColourCameraSettings& settings);

/// The image a colour camera takes of linear light (CV_32FC3 BGR): lens blur, vignetting, automatic exposure
/// unless the settings fix it, white balance, shot and read noise, sRGB. Returns CV_8UC3 BGR. Same seed, same image.
cv::Mat simulate_colour_camera(const cv::Mat& radiance, const ColourCameraSettings& settings, std::uint64_t seed);

/// Describes how a camera's processing departs from plain sRGB; the defaults do not. The steps and their order are
/// those of Karaimer & Brown, "A Software Platform for Manipulating the Camera Imaging Pipeline", ECCV 2016; cameras
/// differ in each of them (Kim, Lin, Lu, Suesstrunk, Lin & Brown, "A New In-Camera Imaging Model for Color Computer
/// Vision and Its Application", PAMI 34(12), 2012). The numbers of other_colour_camera() were chosen for this project.
struct ColourResponse {
  double further_vignetting = 0.0;                              ///< light lost in the corners besides, 0 to 1
  Eigen::Vector3d white_balance_bgr = Eigen::Vector3d::Ones();  ///< gain on each coded channel
  double gamma = 1.0;                                           ///< exponent on coded values; below 1 brightens
  double saturation = 1.0;                                      ///< factor on what a colour differs from its grey
  double sharpening = 0.0;                                      ///< share of the unsharp mask that is added
  double sharpening_px = 1.0;                                   ///< its standard deviation, pixels
};

/// A camera of another make: a cooler white, brighter middle tones, stronger colours and sharpened edges.
ColourResponse other_colour_camera();

/// Applies the camera's processing to an image (CV_8UC3 BGR, as simulate_colour_camera() returns it).
cv::Mat apply_camera_response(const cv::Mat& photo, const ColourResponse& response);

}  // namespace houghstream::world
