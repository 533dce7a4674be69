#include "pose/following/camera_lag.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

// Edges and depth err alike in neighbouring frames, so that a registration says less than its equations promise.
// Chosen: as if errors lasted a third of a second at 60 Hz.
constexpr double kIndependent = 0.01;
constexpr double kMaxInformation = 1.0 / (0.0005 * 0.0005);  // 1/s^2; beyond it the oldest evidence is forgotten

}  // namespace

void CameraLag::update(const LagEvidence& evidence, double deviation_s) {
  if (!(deviation_s > 0.0) || !(evidence.information > 0.0) || !std::isfinite(evidence.weighted)) return;
  observed_information_ += kIndependent * evidence.information / (deviation_s * deviation_s);
  weighted_ += kIndependent * evidence.weighted / deviation_s;
  const double kept = std::min(1.0, kMaxInformation / observed_information_);
  observed_information_ *= kept;
  weighted_ *= kept;
}

double CameraLag::sigma_s() const {
  return 1.0 / std::sqrt(information());
}

bool CameraLag::is_known() const {
  return sigma_s() < 0.2 * prior_s_;
}

}  // namespace houghstream
