#include "drivers/virtual_camera/camera_script.hpp"

#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "pipeline/base/checks.hpp"

namespace houghstream::virtual_camera {
namespace {

using Setter = std::function<void(CameraScript&, const std::string&)>;

double number_of(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  require(!value.empty() && *end == '\0', "'{}', expected a number", value);
  return number;
}

int count_of(const std::string& value) {
  const double number = number_of(value);
  require(number >= 0 && number <= 1000 && number == static_cast<int>(number), "'{}', expected 0 to 1000", value);
  return static_cast<int>(number);
}

bool flag_of(const std::string& value) {
  require(value == "yes" || value == "no", "'{}', expected yes or no", value);
  return value == "yes";
}

/// Returns the test pattern's camera, whose angle is as wide as a PrimeSense's at every size.
Camera pattern_camera(const std::string& value) {
  Camera camera;
  const int fields = std::sscanf(value.c_str(), "%5dx%5d", &camera.width, &camera.height);
  require(fields == 2 && camera.width > 0 && camera.height > 0, "'{}', expected WIDTHxHEIGHT", value);
  camera.fx = camera.fy = 525.0 * camera.width / 640.0;
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  return camera;
}

const std::map<std::string, Setter>& setters() {
  static const std::map<std::string, Setter> all = {
      {"scene", [](CameraScript& s, const std::string& v) { s.scene = v; }},
      {"serial", [](CameraScript& s, const std::string& v) { s.serials.push_back(v); }},
      {"size", [](CameraScript& s, const std::string& v) { s.sizes.push_back(pattern_camera(v)); }},
      {"rate_hz", [](CameraScript& s, const std::string& v) { s.rate_hz = std::max(1, count_of(v)); }},
      {"plugged", [](CameraScript& s, const std::string& v) { s.plugged = flag_of(v); }},
      {"can_sync", [](CameraScript& s, const std::string& v) { s.can_sync = flag_of(v); }},
      {"can_register", [](CameraScript& s, const std::string& v) { s.can_register = flag_of(v); }},
      {"registers_running", [](CameraScript& s, const std::string& v) { s.registers_running = flag_of(v); }},
      {"register_late", [](CameraScript& s, const std::string& v) { s.register_late = count_of(v); }},
      {"colour_phase_ms", [](CameraScript& s, const std::string& v) { s.colour_phase_ms = number_of(v); }},
      {"colour_late_ms", [](CameraScript& s, const std::string& v) { s.colour_late_ms = number_of(v); }},
      {"drop_depth_every", [](CameraScript& s, const std::string& v) { s.drop_depth_every = count_of(v); }},
      {"drop_colour_every", [](CameraScript& s, const std::string& v) { s.drop_colour_every = count_of(v); }},
      {"clock_ahead_ms", [](CameraScript& s, const std::string& v) { s.clock_ahead_ms = number_of(v); }},
      {"clock_drift_ppm", [](CameraScript& s, const std::string& v) { s.clock_drift_ppm = number_of(v); }},
      {"shutter_file", [](CameraScript& s, const std::string& v) { s.shutter_file = v; }},
  };
  return all;
}

void read_line(CameraScript& script, const std::string& line) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::string key;
  std::string value;
  words >> key;
  std::getline(words >> std::ws, value);  // a folder's name may have blanks in it
  value.erase(value.find_last_not_of(" \t\r") + 1);
  if (key.empty()) return;
  const auto setter = setters().find(key);
  require(setter != setters().end(), "unknown key '{}'", key);
  setter->second(script, value);
}

}  // namespace

CameraScript read_camera_script(const std::filesystem::path& file) {
  CameraScript script;
  if (!file.empty()) {
    std::ifstream in(file);
    require(in.good(), "{}: cannot be read, expected the virtual camera's script", file.string());
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
      try {
        read_line(script, line);
      } catch (const InputError& error) {
        fail("{}:{}: {}", file.string(), number, error.what());
      }
    }
  }
  if (script.serials.empty()) script.serials.emplace_back("VC0001");
  if (script.sizes.empty()) script.sizes.push_back(pattern_camera("640x480"));
  return script;
}

}  // namespace houghstream::virtual_camera
