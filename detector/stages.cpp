#include "detector/stages.hpp"

#include "detector/evidence/camera_chroma.hpp"
#include "detector/evidence/suppression.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

template <typename Settings>
std::vector<double> numbers_of(const Settings& settings) {
  std::vector<double> numbers;
  for_each_number(settings, [&](const auto& /*field*/, auto value) { numbers.push_back(static_cast<double>(value)); });
  return numbers;
}

std::vector<ScoredHypothesis> score_all_groups(const SearchContext& search, const std::vector<GroupHypotheses>& groups,
                                               DetectorWorkspace& workspace) {
  const DetectionSettings& settings = search.settings;
  const bool is_coloured = search.forest().scoring == Scoring::kEvidence && settings.evidence.learn_camera_colours;
  return is_coloured
             ? score_in_camera_colours(groups, search.remembered_colours, settings.threads, workspace.scoring_workspace)
             : score_in_taught_colours(groups, settings.threads, workspace.scoring_workspace);
}

}  // namespace

void make_working_images(const SearchContext& search, const RgbdFrame& frame, DetectorWorkspace& workspace) {
  make_working_images(frame, search.forest().features, search.settings.threads, workspace.images);
}

void compute_features(const SearchContext& search, DetectorWorkspace& workspace) {
  const FeatureSettings& settings = search.forest().features;
  const std::vector<WorkingFrame>& frames = workspace.images.frames;
  place_patches(workspace.images, {search.forest().patch, search.settings.spacing}, workspace.patches);
  workspace.features.resize(frames.size());
  for (std::size_t level = 0; level < frames.size(); ++level) {
    compute_features({frames[level], settings, workspace.patches.tiles[level]}, search.settings.threads,
                     workspace.feature_workspace, workspace.features[level]);
  }
}

void find_posteriors(const SearchContext& search, DetectorWorkspace& workspace) {
  const DetectionSettings& settings = search.settings;
  PosteriorInput input{search.index, workspace.features, workspace.patches, settings.leaves};
  input.threads = settings.threads;
  find_posteriors(input, workspace.leaf_workspace, workspace.posteriors);
}

std::vector<Hypothesis> find_hypotheses(const SearchContext& search, DetectorWorkspace& workspace) {
  return find_hypotheses(voting_input(search, workspace), search.settings.threads, workspace.voting_workspace);
}

VotingInput voting_input(const SearchContext& search, const DetectorWorkspace& workspace) {
  VotingInput input{search.forest(), workspace.patches, workspace.posteriors, workspace.images.frames.at(0).camera,
                    search.settings.voting};
  input.searched_classes = search.searched_classes;
  return input;
}

std::vector<ScoredHypothesis> score_hypotheses(const SearchContext& search, const RgbdFrame& frame,
                                               const std::vector<Hypothesis>& hypotheses,
                                               DetectorWorkspace& workspace) {
  const LabFrame in_lab{frame, workspace.images.lab, workspace.images.levels.at(0).scale};
  const ScoringInput input{search.index, in_lab, workspace.patches, search.settings.evidence, search.excluded_views};
  return score_all_groups(search, {{input, hypotheses}}, workspace);
}

std::vector<ScoredHypothesis> score_hypotheses(const std::vector<SearchContext>& groups, const RgbdFrame& frame,
                                               const std::vector<std::vector<Hypothesis>>& hypotheses,
                                               DetectorWorkspace& workspace) {
  const LabFrame in_lab{frame, workspace.images.lab, workspace.images.levels.at(0).scale};
  const SearchContext& first = groups.front();
  std::vector<GroupHypotheses> inputs;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const SearchContext& search = groups[i];
    inputs.push_back(
        {{search.index, in_lab, workspace.patches, first.settings.evidence, search.excluded_views}, hypotheses[i]});
  }
  return score_all_groups(first, inputs, workspace);
}

Detections report_detections(const SearchContext& search, const RgbdFrame& frame,
                             std::vector<ScoredHypothesis>& candidates, StageClock& clock) {
  Detections out;
  out.frame = frame.id;
  out.detections = suppress(candidates, search.settings.evidence, search.settings.suppression);
  clock.mark("detect.suppression");
  out.stages = frame.stages;
  out.stages.insert(out.stages.end(), clock.times().begin(), clock.times().end());
  return out;
}

bool can_share_features(const Forest& a, const Forest& b) {
  const FeatureSettings& one = a.features;
  const FeatureSettings& other = b.features;
  return a.profile == b.profile && a.scoring == b.scoring && one.families == other.families &&
         one.handling == other.handling && one.scales == other.scales && numbers_of(one) == numbers_of(other) &&
         numbers_of(a.patch) == numbers_of(b.patch);
}

void require_searchable(const FeatureSettings& settings, const std::string& source) {
  require(settings.handling == ScaleHandling::kDepthNormalised,
          "{}: searches several sizes of the image, which this program cannot, expected one with {}", source,
          kStudyPrograms);
  std::uint32_t surfaces = 0;
  for (const FamilyName& known : kFamilyNames) {
    if (is_surface_family(known.family)) surfaces |= settings.families & known.family;
  }
  require(surfaces == 0, "{}: has the features '{}', which this program cannot compute, expected one with {}", source,
          family_names(surfaces), kStudyPrograms);
}

}  // namespace houghstream
