#include "drivers/files/camera_info.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

const std::string kCalibration = R"(image_width: 640
image_height: 480
camera_name: rgb_camera
camera_matrix:
  rows: 3
  cols: 3
  data: [528.5, 0, 315.25,
         0, 529, 240.5, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.1, -0.2, 0, 0, 0]
)";
const Camera kCalibrated{640, 480, 528.5, 529.0, 315.25, 240.5};

TEST(CameraInfo, ReadsWhatRosWrites) {
  const auto file = fresh_folder("camera_info") / "camera.yaml";
  write_text(file, kCalibration);
  EXPECT_TRUE(read_camera_info(file) == kCalibrated);
  EXPECT_TRUE(camera_of_option(file.string()) == kCalibrated);
  write_text(file, "%YAML:1.0\n---\n" + kCalibration);
  EXPECT_TRUE(read_camera_info(file) == kCalibrated) << "with a header";
}

TEST(CameraInfo, ReadsAMessageAsRosPrintsIt) {
  const auto file = fresh_folder("camera_info_message") / "camera.yaml";
  const std::string begin = "header:\n  stamp:\n    sec: 5\n  frame_id: camera\nheight: 480\nwidth: 640\n";
  const std::string numbers = "- 528.5\n- 0.0\n- 315.25\n- 0.0\n- 529.0\n- 240.5\n- 0.0\n- 0.0\n- 1.0\n";
  write_text(file, begin + "distortion_model: plumb_bob\nd:\n- 0.0\n- 0.0\nk:\n" + numbers + "binning_x: 0\n---\n");
  EXPECT_TRUE(read_camera_info(file) == kCalibrated);
  write_text(file, begin + "K: [528.5, 0.0, 315.25, 0.0, 529.0, 240.5, 0.0, 0.0, 1.0]\n");
  EXPECT_TRUE(read_camera_info(file) == kCalibrated) << "ROS 1";
  write_text(file, begin + "k:\n- 528.5\n");
  EXPECT_THROW(read_camera_info(file), InputError);
}

// Behind its matrix a cut cannot be told, and takes nothing but the warning of a distortion.
TEST(CameraInfo, ACutFileIsRefusedOrGivesTheSameCamera) {
  const auto file = fresh_folder("camera_info_cut") / "camera.yaml";
  const std::size_t matrix_end = kCalibration.find(']') + 1;
  for (std::size_t length = 0; length < kCalibration.size(); ++length) {
    write_text(file, kCalibration.substr(0, length));
    const std::string error = error_of([&] { EXPECT_TRUE(read_camera_info(file) == kCalibrated) << length; });
    EXPECT_TRUE(length >= matrix_end || !error.empty()) << length;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST(CameraInfo, TheOptionTakesNumbersToo) {
  EXPECT_TRUE(camera_of_option("640x480,528.5,529,315.25,240.5") == kCalibrated);
  EXPECT_THROW(camera_of_option("no_such_file.yaml"), InputError);
  EXPECT_THROW(camera_of_option("640x480,528.5"), InputError);
}

TEST(CameraInfo, BadFilesAreRefused) {
  const auto file = fresh_folder("camera_info_bad") / "camera.yaml";
  EXPECT_THROW(read_camera_info(file), InputError) << "missing";
  for (const std::string line : {"image_width: 640", "240.5, 0, 0, 1", "camera_matrix", "528.5"}) {
    write_text(file, kCalibration);
    replace_in_file(file, line, line == "528.5" ? "-1" : "x: 1");
    EXPECT_THROW(read_camera_info(file), InputError) << line;
  }
  for (const char* text : {"- 1\n- 2\n", "640", "camera_matrix: [1, 2]\n", "camera_matrix:\n  data: 3\n"}) {
    write_text(file, text);
    EXPECT_THROW(read_camera_info(file), InputError) << text;
  }
  write_text(file, "[1, 2");
  EXPECT_THROW(read_camera_info(file), InputError) << "no YAML";
}

}  // namespace
}  // namespace houghstream
