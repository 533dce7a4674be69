#include "drivers/files/camera_info.hpp"

#include <cmath>
#include <initializer_list>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/text/yaml_text.hpp"

namespace houghstream {
namespace {

cv::FileStorage parse_calibration(const std::filesystem::path& file) {
  const std::string text = yaml_for_opencv(read_file(file, "a camera calibration file"), file.string());
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

/// Those of a calibration's matrix, else of the message's list.
std::vector<double> numbers_of_either(const cv::FileStorage& yaml, const char* matrix,
                                      std::initializer_list<const char*> lists) {
  // Nothing where it is no map; OpenCV itself throws.
  if (yaml[matrix].isMap()) return numbers_of(yaml[matrix]["data"]);
  for (const char* list : lists) {
    if (yaml[list].isSeq()) return numbers_of(yaml[list]);
  }
  return {};
}

int size_of(const cv::FileStorage& yaml, const char* calibration, const char* message,
            const std::filesystem::path& file) {
  const char* key = yaml[calibration].isInt() ? calibration : message;
  require(yaml[key].isInt(), "{}: neither {} nor {}, expected pixels", file.string(), calibration, message);
  require(yaml[key].real() >= 1.0 && yaml[key].real() <= 1e5, "{}: {} of {}, expected pixels", file.string(), key,
          yaml[key].real());
  return static_cast<int>(yaml[key].real());
}

Camera camera_of_yaml(const std::filesystem::path& file) {
  const cv::FileStorage yaml = parse_calibration(file);
  const std::vector<double> K = numbers_of_either(yaml, "camera_matrix", {"k", "K"});
  require(K.size() == 9, "{}: {} numbers in camera_matrix: data, or k, expected 9", file.string(), K.size());
  const Camera camera{size_of(yaml, "image_width", "width", file),
                      size_of(yaml, "image_height", "height", file),
                      K[0],
                      K[4],
                      K[2],
                      K[5]};
  check_camera(camera, file.string());
  for (const double coefficient : numbers_of_either(yaml, "distortion_coefficients", {"d", "D"})) {
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

}  // namespace houghstream
