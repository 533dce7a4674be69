#include "detector/stages.hpp"

namespace houghstream {

const Engine& fast_engine() {
  static constexpr Engine kFast = {compute_features, find_leaves};
  return kFast;
}

void make_working_images(const Search& search, const RgbdFrame& frame, DetectorWorkspace& workspace) {
  make_working_images(frame, search.forest().features, search.settings.threads, workspace.images);
}

void compute_features(const Search& search, DetectorWorkspace& workspace) {
  const FeatureSettings& settings = search.forest().features;
  const std::vector<WorkingFrame>& frames = workspace.images.frames;
  place_patches(workspace.images, {search.forest().patch, search.settings.spacing}, workspace.patches);
  workspace.features.resize(frames.size());
  for (std::size_t level = 0; level < frames.size(); ++level) {
    search.engine.features({frames[level], settings, workspace.patches.tiles[level]}, search.settings.threads,
                           workspace.feature_memory, workspace.features[level]);
  }
}

void find_posteriors(const Search& search, DetectorWorkspace& workspace) {
  const DetectionSettings& settings = search.settings;
  find_posteriors({search.index, workspace.features, workspace.patches, settings.leaves, settings.threads},
                  search.engine, workspace.leaf_memory, workspace.posteriors);
}

VotingInput voting_input(const Search& search, const DetectorWorkspace& workspace) {
  return {search.forest(), workspace.patches, workspace.posteriors, workspace.images.frames.at(0).camera,
          search.settings.voting};
}

std::vector<Hypothesis> find_hypotheses(const Search& search, DetectorWorkspace& workspace) {
  return find_hypotheses(voting_input(search, workspace), search.settings.threads, workspace.voting_memory);
}

std::vector<Candidate> weigh_evidence(const Search& search, const RgbdFrame& frame,
                                      const std::vector<Hypothesis>& hypotheses, DetectorWorkspace& workspace) {
  const LabFrame in_lab{frame, workspace.images.lab, workspace.images.levels.at(0).scale};
  return weigh_evidence({search.index, in_lab, workspace.patches, search.settings.evidence, search.excluded_views},
                        hypotheses, search.settings.threads, workspace.evidence_memory);
}

}  // namespace houghstream
