#pragma once

#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream {

/// Pictures put together from training views fit these better than any camera's: the same depth beside the same colour,
/// cut out along the same outline. Who learns from them what a misfit means must have seen such as do no harm.

/// Depth that is registered to colour only within two pixels either way, its nearer surfaces grown by up to as many, as
/// the windows make them that a structured-light camera matches. CV_32FC1, metres, NaN = none: holes stay holes.
/// Smaller or larger with `strength`, 0 = none.
void misregister(double strength, cv::Mat& depth, Random& random);

/// The view as of a thing that leans by up to 4 degrees to any side, and whose depth is wrong by up to a few
/// millimetres here and there; its colours and its outline stay. Less or more with `strength`, 0 = none.
TrainingView bent(const TrainingView& view, double strength, Random& random);

}  // namespace houghstream
