#include "pipeline/process/detector_count.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(DetectorCount, IsHowManyResultsAFrameHadOfLate) {
  DetectorCount detectors;
  EXPECT_EQ(detectors.estimate("LEFT"), 1);
  detectors.note_result({"LEFT", 1});
  detectors.note_result({"RIGHT", 1});
  EXPECT_EQ(detectors.estimate("LEFT"), 1) << "the other one's is another frame";
  detectors.note_result({"LEFT", 2});
  detectors.note_result({"LEFT", 1});
  EXPECT_EQ(detectors.estimate("LEFT"), 2);
  EXPECT_EQ(detectors.estimate("RIGHT"), 1);
  for (int i = 10; i < 30; ++i) detectors.note_result({"LEFT", i});
  EXPECT_EQ(detectors.estimate("LEFT"), 1) << "one of them is gone";
}

TEST(DetectorCount, AFrameThatComesAgainIsCountedAnew) {
  DetectorCount detectors;
  detectors.note_result({"LEFT", 1});
  detectors.forget({"LEFT", 1});
  detectors.forget({"NONE", 1});
  detectors.note_result({"LEFT", 1});
  EXPECT_EQ(detectors.estimate("LEFT"), 1);
}

TEST(DetectorCount, ASecondRunWithTheSameStampsIsNoSecondDetector) {
  DetectorCount detectors;
  for (int run = 0; run < 3; ++run) {
    for (int utime = 0; utime < 8; ++utime) {
      detectors.note_frame({"LEFT", utime});
      detectors.note_result({"LEFT", utime});
      EXPECT_EQ(detectors.estimate("LEFT"), 1) << run << " " << utime;
    }
  }
}

TEST(DetectorCount, AResultMayComeBeforeItsFrame) {
  DetectorCount detectors;
  detectors.note_result({"LEFT", 1});
  detectors.note_frame({"LEFT", 1});
  detectors.note_result({"LEFT", 1});
  EXPECT_EQ(detectors.estimate("LEFT"), 2) << "of the same frame";
  detectors.note_frame({"LEFT", 1});
  detectors.note_result({"LEFT", 1});
  EXPECT_EQ(detectors.estimate("LEFT"), 1) << "of another one of that name";
}

TEST(DetectorCount, RemembersAFewCamerasOnly) {
  DetectorCount detectors;
  for (std::size_t i = 0; i < DetectorCount::kCameras; ++i) detectors.note_result({std::to_string(i), 1});
  for (int twice = 0; twice < 2; ++twice) {
    detectors.note_result({"one more", 1});
    detectors.note_result({"0", 1});
  }
  EXPECT_EQ(detectors.estimate("one more"), 1);
  EXPECT_EQ(detectors.estimate("0"), 3);
}

}  // namespace
}  // namespace houghstream
