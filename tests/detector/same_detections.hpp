#pragma once

#include <gtest/gtest.h>

#include "pipeline/types/detection.hpp"

namespace houghstream {

/// Scores, boxes and centres, bit for bit.
inline void expect_same(const Detections& one, const Detections& other) {
  ASSERT_EQ(one.detections.size(), other.detections.size());
  for (std::size_t i = 0; i < one.detections.size(); ++i) {
    EXPECT_EQ(one.detections[i].score, other.detections[i].score);
    EXPECT_EQ(one.detections[i].box_px, other.detections[i].box_px);
    EXPECT_EQ(one.detections[i].centre_camera, other.detections[i].centre_camera);
  }
}

}  // namespace houghstream
