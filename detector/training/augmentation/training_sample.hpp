#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace houghstream::training {

/// One patch to learn from.
struct TrainingSample {
  std::int32_t image = 0;   ///< number of the composed image, which a tree sees or not
  std::int32_t cutout = 0;  ///< index into TrainingSet::cutouts of the one that holds its pixels
  std::int16_t x = 0;       ///< patch centre, working pixels
  std::int16_t y = 0;
  std::int32_t scale = 0;                            ///< patch_scale of its depth
  std::uint32_t view = 0;                            ///< index into TrainingSet::views; meaningless for background
  std::uint16_t label = 0;                           ///< 0 = background, else class index + 1
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< offset to the object's centre in the patch's ray frame, metres
};

}  // namespace houghstream::training
