#include "drivers/virtual_camera/camera_script.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::virtual_camera {
namespace {

TEST(CameraScript, WithoutAFileOneSynchronisedVgaCameraIsThere) {
  const CameraScript script = read_camera_script("");
  EXPECT_TRUE(script.plugged && script.can_sync && script.can_register);
  EXPECT_EQ(script.serials, std::vector<std::string>{"VC0001"});
  ASSERT_EQ(script.sizes.size(), 1U);
  EXPECT_EQ(script.sizes[0].width, 640);
  EXPECT_EQ(script.rate_hz, 30);
}

TEST(CameraScript, EveryLineSetsOneThing) {
  const auto file = fresh_folder("camera_script") / "script";
  write_text(file,
             "# a camera\nserial A1\nserial A2   # two of them\n\nplugged no\nsize 320x240\ncolour_late_ms 12.5\n"
             "drop_colour_every 7\nclock_ahead_ms -3\nrate_hz 15\nregisters_running yes\n"
             "register_late 2\n");
  const CameraScript script = read_camera_script(file);
  EXPECT_EQ(script.serials, (std::vector<std::string>{"A1", "A2"}));
  EXPECT_FALSE(script.plugged);
  EXPECT_EQ(script.sizes[0].height, 240);
  EXPECT_EQ(script.colour_late_ms, 12.5);
  EXPECT_EQ(script.drop_colour_every, 7);
  EXPECT_TRUE(script.registers_running);
  EXPECT_EQ(script.register_late, 2);
  EXPECT_EQ(script.clock_ahead_ms, -3.0);
  EXPECT_EQ(script.rate_hz, 15);
}

TEST(CameraScript, AFoldersNameMayHaveBlanks) {
  const auto file = fresh_folder("camera_script_blanks") / "script";
  write_text(file, "scene /my data/a scene \t # of yesterday\r\nplugged no\r\n");
  const CameraScript script = read_camera_script(file);
  EXPECT_EQ(script.scene, "/my data/a scene");
  EXPECT_FALSE(script.plugged);
}

TEST(CameraScript, BadLinesAreRefusedWithTheirNumber) {
  const auto file = fresh_folder("camera_script_bad") / "script";
  EXPECT_THROW(read_camera_script(file), InputError) << "missing";
  for (const char* line :
       {"plugin yes", "plugged maybe", "rate_hz fast", "size 640", "drop_depth_every -1", "plugged"}) {
    SCOPED_TRACE(line);
    write_text(file, std::string("serial A1\n") + line + "\n");
    expect_says(error_of([&] { read_camera_script(file); }), {"script:2:"});
  }
}

}  // namespace
}  // namespace houghstream::virtual_camera
