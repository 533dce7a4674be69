#include "detector/detector.hpp"

#include <memory>
#include <set>
#include <string>
#include <utility>

#include "detector/stages.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream {

namespace {

std::vector<Forest> one_group(Forest forest) {
  std::vector<Forest> groups;  // a list would copy it
  groups.push_back(std::move(forest));
  return groups;
}

/// Groups whose detections could be taken for one another's, or that see a frame in different ways, find nothing
/// together.
void require_searchable_together(const std::vector<Forest>& groups) {
  require(!groups.empty(), "detector: no forest, expected at least one");
  std::set<int> ids;
  std::set<std::string> names;
  for (std::size_t i = 0; i < groups.size() && groups.size() > 1; ++i) {
    const std::string group = fmt::format("forest {} of {}", i + 1, groups.size());
    require(can_share_features(groups[i], groups.front()),
            "{}: of profile '{}', expected profile '{}' and the settings of the first", group, groups[i].profile,
            groups.front().profile);
    for (const ObjectClass& object : groups[i].classes)
      require(ids.insert(object.class_id).second && names.insert(object.name).second,
              "{}: object {} '{}', expected an id and a name that no other has", group, object.class_id, object.name);
  }
}

using ForestIndices = std::vector<std::unique_ptr<const ForestIndex>>;

ForestIndices make_indices(const std::vector<Forest>& groups, int threads) {
  ForestIndices indices(groups.size());
  parallel_for(threads, static_cast<int>(groups.size()), [&](int i) {
    const auto place = static_cast<std::size_t>(i);
    indices[place] = std::make_unique<const ForestIndex>(groups[place]);
  });
  return indices;
}

}  // namespace

struct Detector::State {
  State(std::vector<Forest> given, const DetectionSettings& how)
      : groups(std::move(given)), indices(make_indices(groups, how.threads)), settings(how) {}

  /// Returns the search of each group.
  std::vector<SearchContext> searches(const std::vector<ChromaPair>& camera_colours) const {
    std::vector<SearchContext> all;
    all.reserve(indices.size());
    std::size_t classes = 0;
    for (const Forest& forest : groups) classes += forest.classes.size();
    for (const std::unique_ptr<const ForestIndex>& index : indices) {
      SearchContext& search = all.emplace_back(SearchContext{*index, settings});
      search.remembered_colours = camera_colours;
      search.searched_classes = classes;
    }
    return all;
  }

  std::vector<Forest> groups;
  ForestIndices indices;
  DetectionSettings settings;
};

Detector::Detector(Forest forest, DetectionSettings settings)
    : Detector(one_group(std::move(forest)), std::move(settings)) {}

Detector::Detector(std::vector<Forest> groups, DetectionSettings settings) {
  for (const Forest& forest : groups) require_searchable(forest.features, "forest");
  require_searchable_together(groups);
  check_settings(settings, "detection settings");
  state_ = std::make_unique<State>(std::move(groups), settings);
}
Detector::~Detector() = default;
Detector::Detector(Detector&&) noexcept = default;

const std::vector<Forest>& Detector::groups() const {
  return state_->groups;
}

std::vector<Forest> Detector::take_groups() && {
  return std::move(state_->groups);
}

const DetectionSettings& Detector::settings() const {
  return state_->settings;
}

// The method on one page; sections are those of Haensch, Kaiser and Hellwich (2017).
Detections Detector::detect(const RgbdFrame& frame, DetectorWorkspace& workspace,
                            const std::vector<ChromaPair>& camera_colours) const {
  const std::vector<SearchContext> groups = state_->searches(camera_colours);
  check_frame(frame, "detector");
  StageClock clock;
  make_working_images(groups.front(), frame, workspace);  // Section 5.1.1
  clock.mark("detect.resize");
  compute_features(groups.front(), workspace);  // Section 3, around the patches of Section 5.1.3; once for all groups
  clock.mark("detect.features");
  std::vector<std::vector<Hypothesis>> hypotheses;
  for (const SearchContext& searched : groups) {
    find_posteriors(searched, workspace);  // Section 5.1.2: leaves of every tree
    clock.mark("detect.leaves");
    hypotheses.push_back(find_hypotheses(searched, workspace));  // Section 2: votes and their maxima
    clock.mark("detect.votes");
  }
  std::vector<ScoredHypothesis> candidates = score_hypotheses(groups, frame, hypotheses, workspace);  // scores
  clock.mark("detect.evidence");
  return report_detections(groups.front(), frame, candidates, clock);  // Section 2: non-maximum suppression
}

Detections Detector::detect(const RgbdFrame& frame) const {
  DetectorWorkspace workspace;
  return detect(frame, workspace);
}

}  // namespace houghstream
