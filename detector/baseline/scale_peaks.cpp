#include "detector/baseline/scale_peaks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace houghstream {
namespace {

bool beside(const ScalePeak& a, const ScalePeak& b) {
  if (a.candidate.detection.class_id != b.candidate.detection.class_id || std::abs(a.size - b.size) != 1) return false;
  const cv::Point2f way = a.at_px - b.at_px;
  return std::max(std::abs(way.x), std::abs(way.y)) <= std::max(a.reach_px, b.reach_px);
}

bool is_slope(const std::vector<ScalePeak>& peaks, std::size_t i) {
  const float mass = peaks[i].candidate.evidence.mass_share;
  for (std::size_t j = 0; j < peaks.size(); ++j) {
    const float other = peaks[j].candidate.evidence.mass_share;
    if ((other > mass || (other == mass && j < i)) && beside(peaks[i], peaks[j])) return true;
  }
  return false;
}

}  // namespace

std::vector<Candidate> maxima_over_sizes(const std::vector<ScalePeak>& peaks) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    if (!is_slope(peaks, i)) candidates.push_back(peaks[i].candidate);
  }
  return candidates;
}

}  // namespace houghstream
