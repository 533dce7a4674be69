#include "detector/features/surface_planes.hpp"

#include "detector/features/surface_curvature.hpp"
#include "detector/features/surface_histograms.hpp"
#include "detector/features/surface_honv.hpp"

namespace houghstream {

std::vector<cv::Mat> surface_planes(FeatureFamily family, const WorkingFrame& frame, int threads) {
  PointHistogramSettings histograms;
  histograms.step_px = 4;  // of every pixel they would take minutes a frame
  switch (family) {
    case kHonv: return honv_planes(frame, threads);
    case kCurvature: return curvature_planes(frame, threads);
    case kPointHistogram: return pfh_planes(frame, histograms, threads);
    case kFastHistogram: return fpfh_planes(frame, histograms, threads);
    default: return {};
  }
}

}  // namespace houghstream
