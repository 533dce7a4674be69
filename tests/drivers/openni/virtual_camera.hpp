#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <string>

#include "drivers/openni/openni_device.hpp"
#include "drivers/virtual_camera/camera_images.hpp"
#include "tests/test_files.hpp"

namespace houghstream::openni {

/// Sets a virtual camera's script from construction on; OpenNI2 must not be running yet. CTest sets LD_LIBRARY_PATH so
/// that OpenNI2 finds its driver.
class VirtualCamera {
 public:
  VirtualCamera(const std::string& name, const std::string& script) : folder_(fresh_folder("camera_" + name)) {
    change(script);
    setenv("HOUGHSTREAM_VIRTUAL_CAMERA", script_file().c_str(), 1);
  }
  ~VirtualCamera() { std::filesystem::remove_all(folder_); }

  /// Takes effect within some hundredths of a second.
  void change(const std::string& script) const {
    const std::filesystem::path fresh = folder_ / "fresh";
    std::ofstream(fresh) << script;
    std::filesystem::rename(fresh, script_file());
  }

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path script_file() const { return folder_ / "script"; }

  std::filesystem::path folder_;
};

/// Returns the centre of the test pattern's disc as a mask shows it, pixels.
inline cv::Point2d centre_of(const cv::Mat& mask) {
  const cv::Moments moments = cv::moments(mask, true);
  return {moments.m10 / moments.m00, moments.m01 / moments.m00};
}
inline cv::Point2d disc_in_colour(const cv::Mat& bgr) {
  cv::Mat mask;
  const cv::Vec3b rgb = virtual_camera::kPatternDiscColour;
  cv::inRange(bgr, cv::Scalar(rgb[2], rgb[1], rgb[0]), cv::Scalar(rgb[2], rgb[1], rgb[0]), mask);
  return centre_of(mask);
}
inline cv::Point2d disc_in_depth_mm(const cv::Mat& depth_mm) {
  return centre_of(depth_mm == virtual_camera::kPatternDiscMm);
}

/// Returns the offset of the disc's colour from its depth, pixels.
inline double disc_error_px(const cv::Mat& bgr, const cv::Mat& depth_mm) {
  return cv::norm(disc_in_colour(bgr) - disc_in_depth_mm(depth_mm));
}

}  // namespace houghstream::openni
