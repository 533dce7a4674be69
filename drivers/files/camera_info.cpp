#include "drivers/files/camera_info.hpp"

#include <cmath>
#include <initializer_list>
#include <optional>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/yaml_text.hpp"

namespace houghstream {
namespace {

std::vector<double> numbers_of(const YAML::Node& list) {
  std::vector<double> numbers;
  if (!list.IsDefined() || !list.IsSequence()) return numbers;
  for (const auto& entry : list) {
    if (const std::optional<double> number = yaml_number(entry)) numbers.push_back(*number);
  }
  return numbers;
}

/// Reads the intrinsics of a calibration's matrix, else of the message's list.
std::vector<double> numbers_of_either(const YAML::Node& yaml, const char* matrix,
                                      std::initializer_list<const char*> lists) {
  if (const YAML::Node data = yaml_member(yaml_member(yaml, matrix), "data"); data.IsDefined()) return numbers_of(data);
  for (const char* list : lists) {
    if (const YAML::Node node = yaml_member(yaml, list); node.IsDefined()) return numbers_of(node);
  }
  return {};
}

int size_of(const YAML::Node& yaml, const char* calibration, const char* message, const std::filesystem::path& file) {
  const char* key = yaml_member(yaml, calibration).IsDefined() ? calibration : message;
  const std::optional<double> pixels = yaml_number(yaml_member(yaml, key));
  require(pixels.has_value(), "{}: neither {} nor {}, expected pixels", file.string(), calibration, message);
  require(*pixels >= 1.0 && *pixels <= 1e5 && *pixels == std::floor(*pixels), "{}: {} of {}, expected pixels",
          file.string(), key, *pixels);
  return static_cast<int>(*pixels);
}

}  // namespace

Camera read_camera_info(const std::filesystem::path& file) {
  const YAML::Node yaml = parse_yaml(read_file(file, "a camera calibration file"), file.string());
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

Camera camera_of_option(const std::string& text) {
  if (std::filesystem::exists(text)) return read_camera_info(text);
  const bool looks_like_file = text.find(',') == std::string::npos;
  require(!looks_like_file, "--camera {}: no such file; expected a calibration file or WIDTHxHEIGHT,fx,fy,cx,cy", text);
  return parse_camera(text);
}

}  // namespace houghstream
