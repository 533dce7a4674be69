#include "detector/detector.hpp"

#include <utility>

#include "detector/detection_candidates.hpp"
#include "detector/voting/boxes.hpp"

namespace houghstream {

struct Detector::State {
  Forest forest;
  DetectionSettings settings;
};

Detector::Detector(Forest forest, DetectionSettings settings)
    : state_(std::make_unique<State>(State{std::move(forest), settings})) {}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;

const Forest& Detector::forest() const {
  return state_->forest;
}

Detections Detector::detect(const RgbdFrame& frame) const {
  const DetectionSettings& settings = state_->settings;
  check_frame(frame, "detector");
  StageClock clock;
  Detections out;
  out.frame = frame.id;
  for (Candidate& candidate : find_candidates(state_->forest, frame, settings, clock)) {
    if (candidate.detection.score >= settings.threshold) out.detections.push_back(std::move(candidate.detection));
  }
  out.detections = suppress_overlaps(std::move(out.detections), settings);
  clock.mark("detect.hypotheses");
  out.stages = frame.stages;
  out.stages.insert(out.stages.end(), clock.times().begin(), clock.times().end());
  return out;
}

}  // namespace houghstream
