#pragma once

namespace houghstream {

/// How patches are tested. Stored in the forest file.
struct PatchSettings {
  /// Metres per step of a test offset on the object (depth normalisation, Section 5.1.2); in a scale space, working
  /// pixels per step.
  float unit = 0.002F;
  int radius = 10;  ///< test offsets reach from -radius to +radius steps
};

/// How far apart the patches of a frame stand.
struct PatchSpacing {
  int stride = 2;  ///< working pixels (paper, Section 5.1.3)
  /// On a surface that faces the camera: where the stride puts patches nearer to each other, some are left out, see
  /// add_patches. 0 = none are. With depth normalisation only.
  float metres = 0.022F;
};

/// How patches walk down the forest, and for what they vote.
struct LeafSettings {
  /// A patch walks down so many trees first, and down the rest only if the mean of what their leaves are most certain
  /// of reaches min_first_posterior; 0 = every patch walks down all trees.
  int first_trees = 3;
  float min_first_posterior = 0.1F;
  float min_class_share = 0.1F;  ///< posterior, p(class | patch), from which a patch votes for a class
};

}  // namespace houghstream
