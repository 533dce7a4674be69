#include "drivers/openni/camera_options.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/drivers/test_files.hpp"

namespace houghstream::openni {
namespace {

TEST(CameraMode, IsReadAsItIsWritten) {
  const CameraMode mode = parse_camera_mode("320x240@60");
  EXPECT_TRUE((mode == CameraMode{320, 240, 60}));
  EXPECT_EQ(mode_text(mode), "320x240@60");
  EXPECT_TRUE((parse_camera_mode("1280x1024") == CameraMode{1280, 1024, 30}));
  EXPECT_EQ(modes_text({}), "none");
  EXPECT_EQ(modes_text({mode, CameraMode{}}), "320x240@60, 640x480@30");
}

TEST(CameraMode, OtherTextsAreRefused) {
  for (const char* text : {"", "VGA", "640", "640x", "640x480@", "640x480@30Hz", "0x480", "640x-480", "640x480@0"}) {
    EXPECT_THROW(parse_camera_mode(text), InputError) << text;
  }
}

const std::string kYaml = R"(image_width: 640
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
const Camera kCamera{640, 480, 528.5, 529.0, 315.25, 240.5};

TEST(CameraInfo, ReadsWhatRosWrites) {
  const auto file = fresh_folder("camera_info") / "camera.yaml";
  write_text(file, kYaml);
  EXPECT_TRUE(read_camera_info(file) == kCamera);
  EXPECT_TRUE(camera_of_option(file.string()) == kCamera);
  write_text(file, "%YAML:1.0\n---\n" + kYaml);
  EXPECT_TRUE(read_camera_info(file) == kCamera) << "with a header";
}

TEST(CameraInfo, TheOptionTakesNumbersToo) {
  EXPECT_TRUE(camera_of_option("640x480,528.5,529,315.25,240.5") == kCamera);
  EXPECT_THROW(camera_of_option("no_such_file.yaml"), InputError);
  EXPECT_THROW(camera_of_option("640x480,528.5"), InputError);
}

TEST(CameraInfo, BadFilesAreRefused) {
  const auto file = fresh_folder("camera_info_bad") / "camera.yaml";
  EXPECT_THROW(read_camera_info(file), InputError) << "missing";
  for (const std::string line : {"image_width: 640", "240.5, 0, 0, 1", "camera_matrix", "528.5"}) {
    write_text(file, kYaml);
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

// OpenCV's reader would need 25 MB of the stack.
TEST(CameraInfo, ListsWithinListsWithoutEndAreRefused) {
  const auto file = fresh_folder("camera_info_deep") / "camera.yaml";
  std::string brackets;
  for (int i = 0; i < 5000; ++i) brackets += "[\n";
  std::string dashes;
  for (int i = 0; i < 5000; ++i) dashes += "- ";
  for (const std::string& deep : {brackets, dashes}) {
    write_text(file, kYaml + "more:\n  " + deep + "1\n");
    EXPECT_THROW(read_camera_info(file), InputError);
  }
}

}  // namespace
}  // namespace houghstream::openni
