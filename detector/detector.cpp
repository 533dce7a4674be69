#include "detector/detector.hpp"

#include <fmt/ranges.h>

#include <memory>
#include <numeric>
#include <set>
#include <stdexcept>
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

/// Returns the indices of the groups that are searched: of all where none is selected.
std::vector<std::size_t> searched_groups(std::vector<std::size_t> selected, std::size_t count) {
  for (std::size_t i = 0; i < selected.size(); ++i) {
    if (selected[i] >= count || (i > 0 && selected[i] <= selected[i - 1]))
      throw std::logic_error(fmt::format("detector: groups {} selected, expected ascending indices below {}",
                                         fmt::join(selected, ", "), count));
  }
  if (!selected.empty()) return selected;
  selected.resize(count);
  std::iota(selected.begin(), selected.end(), 0);
  return selected;
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
  State(std::vector<Forest> given, DetectionSettings how)
      : groups(std::move(given)), indices(make_indices(groups, how.threads)), settings(std::move(how)) {}

  /// Returns the search of each selected group. An object's share of the frame's candidates stays that of all groups,
  /// so that what is found of it does not depend on which of the others are searched.
  std::vector<SearchContext> searches(const std::vector<ChromaPair>& camera_colours,
                                      const std::vector<std::size_t>& selected) const {
    std::vector<SearchContext> contexts;
    std::size_t classes = 0;
    for (const Forest& forest : groups) classes += forest.classes.size();
    for (const std::size_t i : searched_groups(selected, groups.size())) {
      SearchContext& search = contexts.emplace_back(SearchContext{*indices[i], settings});
      search.remembered_colours = camera_colours;
      search.searched_classes = classes;
    }
    return contexts;
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
  state_ = std::make_unique<State>(std::move(groups), std::move(settings));
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
                            const std::vector<ChromaPair>& camera_colours,
                            const std::vector<std::size_t>& selected) const {
  const std::vector<SearchContext> groups = state_->searches(camera_colours, selected);
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
