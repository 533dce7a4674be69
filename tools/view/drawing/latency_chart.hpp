#pragma once

#include <deque>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "pipeline/types/stage_time.hpp"

namespace houghstream::view {

/// Holds the times of one frame.
struct FrameLatency {
  std::vector<StageTime> stages;
  std::optional<double> total_ms;  ///< time from the frame's arrival to its last result
};

/// The history holds the last frames, oldest first.
using LatencyHistory = std::deque<FrameLatency>;

/// Returns the colour (BGR) of the Nth stage of a frame, from 0.
cv::Scalar stage_colour(std::size_t index);

/// Draws a row per stage in columns of `rows` rows, or of more and lower ones where `area` is not wide enough for all
/// columns: its colour, name and milliseconds.
void draw_stage_list(cv::Mat& image, const cv::Rect& area, const std::vector<StageTime>& stages, int rows);

/// Draws a column per frame, newest to the right: its stages on top of each other, and a white mark at the frame's
/// whole latency. The scale, a round number of milliseconds, holds 95 of 100 frames and is at the upper left; a column
/// that exceeds it is cut off there and has an orange cap, and the longest one is named beside the scale.
void draw_latency_chart(cv::Mat& image, const cv::Rect& area, const LatencyHistory& history);

}  // namespace houghstream::view
