#include "detector/detector.hpp"

#include <algorithm>
#include <utility>

#include "detector/extensions.hpp"
#include "detector/stages.hpp"

namespace houghstream {
namespace {

/// Those that are likely enough; of overlapping ones the stronger (Section 2). Weaker ones that a pose may confirm
/// stand behind, and never suppress any of them.
std::vector<Detection> suppress(std::vector<Candidate>& candidates, const DetectionSettings& settings) {
  const EvidenceSettings& evidence = settings.evidence;
  std::vector<Detection> likely;
  for (Candidate& candidate : candidates) {
    Detection& detection = candidate.detection;
    detection.reported = detection.score >= evidence.threshold;
    if (detection.reported || detection.score >= evidence.candidates_from) likely.push_back(std::move(detection));
  }
  std::vector<Detection> kept = suppress_overlaps(std::move(likely), settings.suppression);
  const auto reported = std::count_if(kept.begin(), kept.end(), [](const Detection& it) { return it.reported; });
  const auto most = static_cast<std::size_t>(reported + evidence.max_candidates);
  if (kept.size() > most) kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(most), kept.end());
  return kept;
}

}  // namespace

struct Detector::State {
  State(Forest given, const DetectionSettings& how, const Engine& by)
      : forest(std::move(given)), index(forest), settings(how), engine(by) {}

  Forest forest;
  ForestIndex index;
  DetectionSettings settings;
  const Engine& engine;
};

Detector::Detector(Forest forest, DetectionSettings settings, const Engine& engine)
    : state_(std::make_unique<State>(std::move(forest), settings, engine)) {
  require_extensions(state_->forest.features, "forest");
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
Detections Detector::detect(const RgbdFrame& frame, DetectorWorkspace& workspace) const {
  const Search search{state_->index, state_->settings, state_->engine};
  check_frame(frame, "detector");
  StageClock clock;
  std::vector<Candidate> candidates;
  if (search.forest().features.handling == ScaleHandling::kScaleSpace) {  // the original's way, see detector/baseline
    candidates = extensions().search_scale_space(search, frame, clock);
  } else {
    make_working_images(search, frame, workspace);  // Section 5.1.1
    clock.mark("detect.resize");
    compute_features(search, workspace);  // Section 3, around the patches of Section 5.1.3
    clock.mark("detect.features");
    find_posteriors(search, workspace);  // Section 5.1.2: leaves of every tree
    clock.mark("detect.leaves");
    const std::vector<Hypothesis> hypotheses = find_hypotheses(search, workspace);  // Section 2: votes and their maxima
    clock.mark("detect.votes");
    candidates = weigh_evidence(search, frame, hypotheses, workspace);  // scores
    clock.mark("detect.evidence");
  }
  Detections out;
  out.frame = frame.id;
  out.detections = suppress(candidates, search.settings);  // Section 2: non-maximum suppression
  clock.mark("detect.suppression");
  out.stages = frame.stages;
  out.stages.insert(out.stages.end(), clock.times().begin(), clock.times().end());
  return out;
}

Detections Detector::detect(const RgbdFrame& frame) const {
  DetectorWorkspace workspace;
  return detect(frame, workspace);
}

}  // namespace houghstream
