#pragma once

#include <string>
#include <vector>

#include "detector/training/augmentation/camera_randomisation.hpp"

namespace houghstream::colours {

/// A camera whose colours are not those of the images that taught.
struct StrangeCamera {
  double white_balance_k = 0.0;  ///< temperature of the light, which the camera takes for one of 5500 K
  training::CameraRandomisation camera;
  std::string name() const;
};

/// Returns `count` cameras: the light from 3000 to 8000 K, evenly in mired, saturation from 0.6 to 1.6 and gamma from
/// 0.7 to 1.5, evenly in their logarithms. The same arguments give the same cameras.
std::vector<StrangeCamera> strange_cameras(int count, std::uint64_t seed);

}  // namespace houghstream::colours
