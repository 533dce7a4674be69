#include "detector/baseline/surface_planes.hpp"

#include "detector/baseline/surface_curvature.hpp"
#include "detector/baseline/surface_histograms.hpp"
#include "detector/baseline/surface_honv.hpp"

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

ExtraPlanes extra_planes(const WorkingFrame& frame, const FeatureSettings& settings, int threads) {
  ExtraPlanes extra;
  for (const FamilyName& known : kFamilyNames) {
    if (!is_surface_family(known.family) || (settings.families & known.family) == 0) continue;
    extra[known.family] = surface_planes(known.family, frame, threads);
  }
  return extra;
}

}  // namespace houghstream::baseline
