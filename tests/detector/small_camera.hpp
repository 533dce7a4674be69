#pragma once

#include "pipeline/types/camera.hpp"

namespace houghstream::toy {

/// The camera has a quarter of a 640x480 camera's resolution.
inline const Camera kSmallCamera{160, 120, 131.25, 131.25, 79.5, 59.5};

}  // namespace houghstream::toy
