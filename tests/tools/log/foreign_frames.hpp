#pragma once

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/tools/log/recordings.hpp"
#include "tools/log/third_party_frames.hpp"

namespace houghstream::log_tools {

template <typename Message>
images_t convert(images_t (*conversion)(ByteView), const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  return conversion({bytes.data(), bytes.size()});
}

inline void expect_depth(const images_t& message, const RgbdFrame& frame) {
  EXPECT_EQ(message.utime, frame.id.utime);
  EXPECT_EQ(cv::norm(images_from_message(message).depth_mm, depth_to_millimetres(frame.depth), cv::NORM_INF), 0.0);
}

inline void expect_colour(const images_t& message, const RgbdFrame& frame) {
  EXPECT_EQ(cv::norm(images_from_message(message).colour, frame.colour, cv::NORM_INF), 0.0);
}

/// Cut anywhere, a message is refused, not read beyond its end.
template <typename Message>
void expect_cuts_refused(images_t (*conversion)(ByteView), const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  for (std::size_t size = 0; size < bytes.size(); size += size < 100 ? 1 : 97) {
    EXPECT_THROW(conversion({bytes.data(), size}), InputError) << size;
  }
}

}  // namespace houghstream::log_tools
