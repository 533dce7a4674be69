#include "detector/baseline/use_baseline.hpp"

#include "detector/baseline/scale_space_search.hpp"
#include "detector/baseline/surface_curvature.hpp"
#include "detector/baseline/surface_histograms.hpp"
#include "detector/baseline/surface_honv.hpp"
#include "detector/extensions.hpp"

namespace houghstream::baseline {

std::vector<cv::Mat> surface_planes(FeatureFamily family, const WorkingFrame& frame, int threads) {
  PointHistogramSettings pfh;
  pfh.given = 20;  // all pairs of them are looked at
  switch (family) {
    case kHonv: return honv_planes(frame, threads);
    case kCurvature: return curvature_planes(frame, threads);
    case kPointHistogram: return pfh_planes(frame, pfh, threads);
    case kFastHistogram: return fpfh_planes(frame, {}, threads);
    default: return {};
  }
}

void use_baseline() {
  extend_detector({surface_planes, [](const Search& search, const RgbdFrame& frame, StageClock& clock) {
                     return search_scale_space(search, Way::kFast, frame, clock);
                   }});
}

}  // namespace houghstream::baseline
