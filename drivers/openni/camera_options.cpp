#include "drivers/openni/camera_options.hpp"

#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream::openni {
namespace {

/// OpenCV reads YAML that starts with its own header; ROS writes none.
cv::FileStorage parse_yaml(const std::filesystem::path& file) {
  std::string text = read_file(file, "a camera calibration file");
  check_yaml_nesting(text, file.string());
  if (text.rfind("%YAML", 0) != 0) text = "%YAML:1.0\n---\n" + text;
  cv::FileStorage yaml;
  try {
    yaml.open(text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  } catch (const cv::Exception&) {
    fail("{}: no YAML, expected a camera calibration file", file.string());
  }
  require(yaml.isOpened() && yaml.root().isMap(), "{}: no YAML of names and values, expected a camera calibration file",
          file.string());
  return yaml;
}

std::vector<double> numbers_of(const cv::FileNode& list) {
  std::vector<double> numbers;
  for (const cv::FileNode& number : list) {
    if (number.isReal() || number.isInt()) numbers.push_back(number.real());
  }
  return numbers;
}

/// Nothing where `map` is none; OpenCV itself throws.
cv::FileNode member(const cv::FileNode& map, const char* key) {
  return map.isMap() ? map[key] : cv::FileNode();
}

int size_of(const cv::FileStorage& yaml, const char* key, const std::filesystem::path& file) {
  require(yaml[key].isInt(), "{}: no {}, expected pixels", file.string(), key);
  require(yaml[key].real() >= 1.0 && yaml[key].real() <= 1e5, "{}: {} of {}, expected pixels", file.string(), key,
          yaml[key].real());
  return static_cast<int>(yaml[key].real());
}

}  // namespace

std::string mode_text(const CameraMode& mode) {
  return fmt::format("{}x{}@{}", mode.width, mode.height, mode.rate_hz);
}

std::string modes_text(const std::vector<CameraMode>& modes) {
  std::string text;
  for (const CameraMode& mode : modes) text += (text.empty() ? "" : ", ") + mode_text(mode);
  return text.empty() ? "none" : text;
}

CameraMode parse_camera_mode(const std::string& text) {
  CameraMode mode;
  int with_rate = -1;
  int size_only = -1;
  std::sscanf(text.c_str(), "%5dx%5d%n@%4d%n", &mode.width, &mode.height, &size_only, &mode.rate_hz, &with_rate);
  const int end = static_cast<int>(text.size());
  const bool positive = mode.width > 0 && mode.height > 0 && mode.rate_hz > 0;
  require((with_rate == end || size_only == end) && positive,
          "--mode '{}', expected WIDTHxHEIGHT or WIDTHxHEIGHT@RATE, for instance 640x480@30", text);
  return mode;
}

namespace {

Camera camera_of_yaml(const std::filesystem::path& file) {
  const cv::FileStorage yaml = parse_yaml(file);
  const std::vector<double> K = numbers_of(member(yaml["camera_matrix"], "data"));
  require(K.size() == 9, "{}: camera_matrix has {} numbers in its data, expected 9", file.string(), K.size());
  const Camera camera{size_of(yaml, "image_width", file), size_of(yaml, "image_height", file), K[0], K[4], K[2], K[5]};
  check_camera(camera, file.string());
  for (const double coefficient : numbers_of(member(yaml["distortion_coefficients"], "data"))) {
    if (std::abs(coefficient) < 1e-9) continue;
    log_warning("{}: its distortion is not corrected; boxes and poses near the image's edge may be a little off",
                file.string());
    break;
  }
  return camera;
}

}  // namespace

Camera read_camera_info(const std::filesystem::path& file) {
  try {
    return camera_of_yaml(file);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {  // OpenCV's own, and those of strings that it makes too long
    fail("{}: no YAML, expected a camera calibration file", file.string());
  }
}

Camera camera_of_option(const std::string& text) {
  if (std::filesystem::exists(text)) return read_camera_info(text);
  const bool looks_like_file = text.find(',') == std::string::npos;
  require(!looks_like_file, "--camera {}: no such file; expected a calibration file or WIDTHxHEIGHT,fx,fy,cx,cy", text);
  return parse_camera(text);
}

}  // namespace houghstream::openni
