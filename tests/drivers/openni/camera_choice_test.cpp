#include "drivers/openni/camera_choice.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream::openni {
namespace {

const std::vector<CameraDescription> kCameras = {{"1d27/0609@1/4", "PrimeSense", "Xtion", "1103", {}},
                                                 {"1d27/0609@1/7", "PrimeSense", "Xtion", "1104", {{320, 240, 30}}}};

TEST(CameraChoice, UriNumberAndSerialMeanTheSameCamera) {
  for (const char* selector : {"1d27/0609@1/7", "#2", "1104"}) {
    EXPECT_EQ(choose_camera(kCameras, selector).serial, "1104") << selector;
  }
  EXPECT_EQ(choose_camera(kCameras, "").serial, "1103") << "the first one";
}

TEST(CameraChoice, WhatIsNotThereIsAnErrorThatNamesWhatIs) {
  for (const char* selector : {"#3", "1105"}) {
    try {
      choose_camera(kCameras, selector);
      ADD_FAILURE() << selector;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(selector), std::string::npos) << text;
      EXPECT_NE(text.find("1d27/0609@1/7, serial 1104, modes 320x240@30"), std::string::npos) << text;
    }
  }
  for (const char* selector : {"#", "#0", "#-1", "#x", "#1x"}) {
    EXPECT_THROW(choose_camera(kCameras, selector), InputError) << selector;
  }
  EXPECT_THROW(choose_camera({}, ""), InputError);
}

}  // namespace
}  // namespace houghstream::openni
