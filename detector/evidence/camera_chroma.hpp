#pragma once

#include <vector>

#include "detector/evidence/hypothesis_scoring.hpp"
#include "pipeline/types/chroma_map.hpp"

namespace houghstream {

/// Returns the candidates of all groups, one group's after another's, as score_by_group() finds them: in colours as
/// taught.
std::vector<ScoredHypothesis> score_in_taught_colours(const std::vector<GroupHypotheses>& groups, int threads,
                                                      ScoringWorkspace& workspace);

/// Scores as score_in_taught_colours() does, with the view templates brought to the colours of the camera (ChromaMap),
/// so that a cast, which all objects of a frame share, of whichever group, speaks against none of them. How the camera
/// renders colours is learnt from earlier frames (`colours`) and from the likely candidates of the frame together, for
/// each class from the other classes alone, so that an object is not evidence for itself. Where the result differs much
/// from the map of earlier frames, or from the taught colours without such, all candidates are scored again. Where no
/// other class is known or likely, scores are as taught; in an image without colours chroma speaks neither for a
/// candidate nor against it. The result is the same for any number of threads.
std::vector<ScoredHypothesis> score_in_camera_colours(const std::vector<GroupHypotheses>& groups,
                                                      const std::vector<ChromaPair>& colours, int threads,
                                                      ScoringWorkspace& workspace);

}  // namespace houghstream
