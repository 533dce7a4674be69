#include "pipeline/process/recent_frames.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

RecentFrames::Decoded decoded(const FrameId& id) {
  DecodedFrame frame;
  frame.frame.id = id;
  return std::make_shared<const DecodedFrame>(std::move(frame));
}

TEST(RecentFrames, AreFoundByTheirName) {
  RecentFrames frames;
  frames.keep(decoded({"LEFT", 1}));
  frames.keep(decoded({"RIGHT", 1}));
  ASSERT_NE(frames.find({"LEFT", 1}), nullptr);
  EXPECT_EQ(frames.find({"LEFT", 1})->frame.id, (FrameId{"LEFT", 1}));
  EXPECT_EQ(frames.find({"LEFT", 2}), nullptr);
}

TEST(RecentFrames, AreFewHoweverManyCamerasThereAre) {
  RecentFrames frames;
  std::weak_ptr<const DecodedFrame> first;
  for (std::size_t i = 0; i <= RecentFrames::kFrames; ++i) {
    const RecentFrames::Decoded frame = decoded({std::to_string(i), 1});
    if (i == 0) first = frame;
    frames.keep(frame);
  }
  EXPECT_TRUE(first.expired());
  EXPECT_EQ(frames.find({"0", 1}), nullptr);
  EXPECT_NE(frames.find({"1", 1}), nullptr);
}

TEST(RecentFrames, LargeOnesAreFewer) {
  const cv::Mat large(3840, 2160, CV_32FC1);  // 33 MB, of which all have the same
  RecentFrames frames;
  for (std::int64_t i = 0; i < 8; ++i) {
    DecodedFrame frame;
    frame.frame.id = {"LEFT", i};
    frame.frame.depth = large;
    frames.keep(std::make_shared<const DecodedFrame>(std::move(frame)));
  }
  EXPECT_EQ(frames.find({"LEFT", 1}), nullptr);
  EXPECT_NE(frames.find({"LEFT", 7}), nullptr);
  EXPECT_NE(frames.find({"LEFT", 3}), nullptr);
}

}  // namespace
}  // namespace houghstream
