#pragma once

#include <vector>

#include "detector/evidence/hypothesis_scoring.hpp"
#include "pipeline/types/chroma_map.hpp"

namespace houghstream {

/// Returns the candidates of all groups, one group's after another's, as score_by_group() finds them: in colours as
/// taught.
std::vector<ScoredHypothesis> score_groups(const std::vector<GroupHypotheses>& groups, int threads,
                                           ScoringWorkspace& workspace);

/// Scores as score_groups() does, with the view templates brought to the colours of the camera (ChromaMap), so that a
/// cast, which all objects of a frame share, of whichever group, speaks against none of them. How the camera renders
/// colours is learnt of what earlier frames told (`colours`) and of the likely candidates of the frame together, for
/// each class without itself, since an object may not be judged by what it taught. Where the camera turns out to be far
/// from what was remembered of it, or from what was taught if nothing was, all candidates are scored again. Where no
/// other class is known or likely, scores are as taught; in an image without colours chroma speaks neither for a
/// candidate nor against it. The result is the same for any number of threads.
std::vector<ScoredHypothesis> score_in_camera_colours(const std::vector<GroupHypotheses>& groups,
                                                      const std::vector<ChromaPair>& colours, int threads,
                                                      ScoringWorkspace& workspace);

}  // namespace houghstream
