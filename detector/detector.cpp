#include "detector/detector.hpp"

#include <utility>

#include "detector/stages.hpp"
#include "pipeline/base/check_settings.hpp"

namespace houghstream {

struct Detector::State {
  State(Forest given, const DetectionSettings& how) : forest(std::move(given)), index(forest), settings(how) {}

  Forest forest;
  ForestIndex index;
  DetectionSettings settings;
};

Detector::Detector(Forest forest, DetectionSettings settings)
    : state_(std::make_unique<State>(std::move(forest), settings)) {
  require_searchable(state_->forest.features, "forest");
  check_settings(settings, "detection settings");
}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;

const Forest& Detector::forest() const {
  return state_->forest;
}

Forest Detector::take_forest() && {
  return std::move(state_->forest);
}

const DetectionSettings& Detector::settings() const {
  return state_->settings;
}

// The method on one page; sections are those of Haensch, Kaiser and Hellwich (2017).
Detections Detector::detect(const RgbdFrame& frame, DetectorWorkspace& workspace,
                            const std::vector<ChromaPair>& camera_colours) const {
  const SearchContext search{state_->index, state_->settings, {}, camera_colours};
  check_frame(frame, "detector");
  StageClock clock;
  make_working_images(search, frame, workspace);  // Section 5.1.1
  clock.mark("detect.resize");
  compute_features(search, workspace);  // Section 3, around the patches of Section 5.1.3
  clock.mark("detect.features");
  find_posteriors(search, workspace);  // Section 5.1.2: leaves of every tree
  clock.mark("detect.leaves");
  const std::vector<Hypothesis> hypotheses = find_hypotheses(search, workspace);  // Section 2: votes and their maxima
  clock.mark("detect.votes");
  std::vector<ScoredHypothesis> candidates = score_hypotheses(search, frame, hypotheses, workspace);  // scores
  clock.mark("detect.evidence");
  return report_detections(search, frame, candidates, clock);  // Section 2: non-maximum suppression
}

Detections Detector::detect(const RgbdFrame& frame) const {
  DetectorWorkspace workspace;
  return detect(frame, workspace);
}

}  // namespace houghstream
