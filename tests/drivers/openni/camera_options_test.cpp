#include "drivers/openni/camera_options.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

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

}  // namespace
}  // namespace houghstream::openni
