#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "detector/detection_settings.hpp"
#include "detector/evidence/hypothesis_scoring.hpp"
#include "detector/features/features.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/posteriors.hpp"
#include "detector/voting/hypotheses.hpp"
#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// The stages of a search by a depth-normalised forest, as Detector::detect calls them one after another; the trainer
/// and the studies call some of them too. Each reads what those before it have left in the workspace.

/// Everything that frames are searched with.
struct SearchContext {
  const ForestIndex& index;
  const DetectionSettings& settings;
  /// Indices into Forest::views of templates that are not compared with the frame. An image composed for training must
  /// not be recognised by the very views that it shows.
  std::vector<std::uint32_t> excluded_views = {};
  /// Objects that were seen by the frame's camera before: what its colours are learnt from, beside those of the frame.
  std::vector<ChromaPair> remembered_colours = {};
  std::size_t searched_classes = 0;  ///< classes of all forests that share a frame's candidates; 0: of this one alone

  const Forest& forest() const { return index.forest(); }
};

/// The memory of a search, which is used again for the next frame's: a frame asks the system for nothing that grows
/// with the image. For one search at a time; what is in it belongs to the last frame.
struct DetectorWorkspace {
  WorkingImages images;
  PatchGrid patches;
  std::vector<FeatureImage> features;  ///< one for each level
  PatchPosteriors posteriors;
  // Workspaces of the stages:
  FeatureWorkspace feature_workspace;
  LeafWorkspace leaf_workspace;
  VotingWorkspace voting_workspace;
  ScoringWorkspace scoring_workspace;
};

/// Resizes the frame to the sizes at which it is searched (paper, Section 5.1.1): features/working_frame.
void make_working_images(const SearchContext& search, const RgbdFrame& frame, DetectorWorkspace& workspace);

/// Places the patches (Section 5.1.3) and computes the features around them (Section 3): features/patch_grid, features.
void compute_features(const SearchContext& search, DetectorWorkspace& workspace);

/// Finds the leaves that each patch reaches (Section 5.1.2), and the classes that it votes for by them:
/// forest/traversal, posteriors.
void find_posteriors(const SearchContext& search, DetectorWorkspace& workspace);

/// Casts the votes for the objects' centres and finds their maxima (Section 2), class by class: voting/hough_space,
/// hypotheses.
std::vector<Hypothesis> find_hypotheses(const SearchContext& search, DetectorWorkspace& workspace);

/// Compares view templates with the frame at each hypothesis and scores it: evidence/hypothesis_scoring.
std::vector<ScoredHypothesis> score_hypotheses(const SearchContext& search, const RgbdFrame& frame,
                                               const std::vector<Hypothesis>& hypotheses, DetectorWorkspace& workspace);

/// Does so for the hypotheses of several forests that are searched in one frame (can_share_features()), one list for
/// each: how the camera renders colours is learnt of all of them together. The groups' candidates follow one another;
/// those settings and remembered colours count that the first group has.
std::vector<ScoredHypothesis> score_hypotheses(const std::vector<SearchContext>& groups, const RgbdFrame& frame,
                                               const std::vector<std::vector<Hypothesis>>& hypotheses,
                                               DetectorWorkspace& workspace);

/// Returns what is likely enough, and weaker candidates for a pose to confirm; of overlapping boxes the stronger
/// (Section 2): evidence/suppression. It closes the stage "detect.suppression"; the clock's times follow those of the
/// frame.
Detections report_detections(const SearchContext& search, const RgbdFrame& frame,
                             std::vector<ScoredHypothesis>& candidates, StageClock& clock);

/// Returns the inputs of the votes in the workspace.
VotingInput voting_input(const SearchContext& search, const DetectorWorkspace& workspace);

/// Returns whether two forests find their objects in the same working images, patches and features, and score them
/// alike: of the same profile, with the same settings.
bool can_share_features(const Forest& a, const Forest& b);

/// Throws InputError in one line that names `source`, for instance a forest file, what it needs and who has it, unless
/// the stages can search by these settings: depth-normalised, without surface features.
void require_searchable(const FeatureSettings& settings, const std::string& source);

}  // namespace houghstream
