#include "detector/baseline/study_detector.hpp"

#include <utility>

#include "detector/baseline/scale_space_search.hpp"
#include "pipeline/base/check_settings.hpp"

namespace houghstream::baseline {
namespace {

/// Runs the stages of Detector::detect up to the evidence, two of them in the way that is asked for.
std::vector<ScoredHypothesis> search_normalised(const SearchContext& search, Way way, const RgbdFrame& frame,
                                                DetectorWorkspace& workspace, StageClock& clock) {
  const DetectionSettings& settings = search.settings;
  make_working_images(search, frame, workspace);
  clock.mark("detect.resize");
  compute_features_by(way, search, workspace);
  clock.mark("detect.features");
  PosteriorInput input{search.index, workspace.features, workspace.patches, settings.leaves};
  input.threads = settings.threads;
  find_posteriors_by(way, input, workspace.leaf_workspace, workspace.posteriors);
  clock.mark("detect.leaves");
  const std::vector<Hypothesis> hypotheses = find_hypotheses(search, workspace);
  clock.mark("detect.votes");
  std::vector<ScoredHypothesis> candidates = score_hypotheses(search, frame, hypotheses, workspace);
  clock.mark("detect.evidence");
  return candidates;
}

}  // namespace

StudyDetector::StudyDetector(Forest forest, const DetectionSettings& settings, Way way)
    : forest_(std::move(forest)), index_(forest_), settings_(settings), way_(way) {
  check_settings(settings_, "detection settings");
}

Detections StudyDetector::detect(const RgbdFrame& frame, DetectorWorkspace& workspace) const {
  const SearchContext search{index_, settings_};
  check_frame(frame, "detector");
  StageClock clock;
  const bool in_scale_space = forest_.features.handling == ScaleHandling::kScaleSpace;
  std::vector<ScoredHypothesis> candidates = in_scale_space ? search_scale_space(search, way_, frame, clock)
                                                            : search_normalised(search, way_, frame, workspace, clock);
  return report_detections(search, frame, candidates, clock);
}

Detections StudyDetector::detect(const RgbdFrame& frame) const {
  DetectorWorkspace workspace;
  return detect(frame, workspace);
}

}  // namespace houghstream::baseline
