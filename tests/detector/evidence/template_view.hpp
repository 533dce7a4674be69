#pragma once

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/evidence/template_matching.hpp"
#include "detector/features/working_frame.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::toy {

inline constexpr float kDistance = 0.7F;

/// Returns the first toy view (stripes on a relief) as a forest remembers it.
inline ViewTemplate template_view() {
  const TrainingView view = training_views().front();
  const cv::Rect box = cv::boundingRect(view.mask);
  const double metres = view.frame.camera.metres_per_px(kDistance);
  const auto side = [&](int px, double centre) { return static_cast<float>((px - 0.5 - centre) * metres); };
  ViewTemplate out;
  out.box = {side(box.x, 159.5), side(box.y, 119.5), side(box.br().x, 159.5), side(box.br().y, 119.5)};
  out.appearance = make_template_grid(view.frame, view.mask, box, {0.0F, 0.0F, kDistance});
  return out;
}

/// Returns the frame with another image's colours, `scale` times its size, as views are compared with it.
inline LabFrame lab_frame(const RgbdFrame& frame, const cv::Mat& colour, float scale) {
  cv::Mat blurred;
  LabLevels lab;
  make_smoothed_lab(colour, blurred, lab);
  return {frame, lab, scale};
}

/// Returns the view of an object so many times as large, seen from as far.
inline ViewTemplate resized(ViewTemplate view, float size) {
  for (float& side : view.box) side *= size;
  for (std::int16_t& mm : view.appearance.mm) {
    if (mm > TemplateGrid::kNoDepth) mm = static_cast<std::int16_t>(std::lround(size * static_cast<float>(mm)));
  }
  mark_rim(view.appearance);
  return view;
}

}  // namespace houghstream::toy
