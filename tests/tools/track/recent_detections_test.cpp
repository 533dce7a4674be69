#include "tools/track/recent_detections.hpp"

#include <gtest/gtest.h>

namespace houghstream::track {
namespace {

Detections found(const FrameId& frame, const std::string& name) {
  Detection detection;
  detection.class_name = name;
  return {frame, {detection}, {}};
}

TEST(RecentDetections, AreThoseOfAllDetectorsOfTheFrame) {
  RecentDetections recent;
  recent.add(found({"LEFT", 1}, "can"));
  recent.add(found({"LEFT", 1}, "mug"));
  recent.add(found({"RIGHT", 1}, "bowl"));
  EXPECT_EQ(recent.find({"LEFT", 1}).detections.size(), 2U);
  EXPECT_EQ(recent.find({"LEFT", 2}).detections.size(), 0U);
}

TEST(RecentDetections, AFrameThatHasTheNameOfAnotherOneHasItsOwn) {
  RecentDetections recent;
  recent.add(found({"LEFT", 1}, "can"));
  recent.add(found({"RIGHT", 1}, "can"));
  recent.forget({"LEFT", 1});
  recent.add(found({"LEFT", 1}, "mug"));
  ASSERT_EQ(recent.find({"LEFT", 1}).detections.size(), 1U);
  EXPECT_EQ(recent.find({"LEFT", 1}).detections[0].class_name, "mug");
  EXPECT_EQ(recent.find({"RIGHT", 1}).detections.size(), 1U);
}

}  // namespace
}  // namespace houghstream::track
