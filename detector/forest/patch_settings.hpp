#pragma once

#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// How patches are tested. Stored in the forest file.
struct PatchSettings {
  /// Metres per step of a test offset on the object (depth normalisation, Section 5.1.2); in a scale space, working
  /// pixels per step.
  float unit = 0.002F;
  int radius = 10;  ///< test offsets reach from -radius to +radius steps
};

template <typename Visit>
void fields(const PatchSettings& /*settings*/, const Visit& visit) {
  using S = PatchSettings;
  visit(number("unit", &S::unit, 1e-6, 1, "m or working pixels"));
  visit(number("radius", &S::radius, 1, 127, "steps"));
}

/// How far apart the patches of a frame stand.
struct PatchSpacing {
  int stride = 2;  ///< working pixels (paper, Section 5.1.3)
  /// On a surface that faces the camera: where the stride puts patches nearer to each other, some are left out, see
  /// add_patches. 0 = none are. With depth normalisation only.
  float metres = 0.022F;
};

template <typename Visit>
void fields(const PatchSpacing& /*settings*/, const Visit& visit) {
  using S = PatchSpacing;
  visit(number("stride", &S::stride, 1, 64, "working pixels"));
  visit(number("metres", &S::metres, 0, 10, "m"));
}

/// How patches walk down the forest, and for what they vote.
struct LeafSettings {
  /// A patch walks down so many trees first, and down the rest only if the mean of what their leaves are most certain
  /// of reaches min_first_posterior; 0 = every patch walks down all trees.
  int first_trees = 3;
  float min_first_posterior = 0.1F;
  float min_class_share = 0.1F;  ///< posterior, p(class | patch), from which a patch votes for a class
};

template <typename Visit>
void fields(const LeafSettings& /*settings*/, const Visit& visit) {
  using S = LeafSettings;
  visit(number("first_trees", &S::first_trees, 0, 1000));
  visit(number("min_first_posterior", &S::min_first_posterior, 0, 1));
  visit(number("min_class_share", &S::min_class_share, 0, 1));
}

}  // namespace houghstream
