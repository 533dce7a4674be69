#pragma once

#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// Errors of a depth camera. Images composed of training views agree with these better than any camera's images: equal
/// depth and colour, cut along the same boundary. Scores that are learnt from composed images must therefore see
/// harmless deviations.

/// Registers depth to colour only within two pixels either way, and grows its nearer surfaces by up to as many, as the
/// windows do that a structured-light camera matches. CV_32FC1, metres, NaN = none: holes stay holes. The errors are
/// smaller or larger with `strength`, 0 = none.
void misregister(double strength, cv::Mat& depth, Random& random);

/// Returns the view as of an object that leans by up to 4 degrees to any side, and whose depth is wrong by up to a few
/// millimetres here and there; its colours and its outline stay. The changes are smaller or larger with `strength`, 0 =
/// none.
TrainingView perturb_shape(const TrainingView& view, double strength, Random& random);

/// Returns the view as of another object of its kind, in a light of its own: a taught image's colours are what one
/// camera, lamp and printer made of the object. Light varies smoothly over it; a cast, tone and strength of its colours
/// change, and it may be less sharp. The changes are smaller or larger with `strength`, 0 = none.
TrainingView perturb_appearance(const TrainingView& view, double strength, Random& random);

/// Changes the object's appearance within an image: `colour` is CV_8UC3, `mask` CV_8UC1 of its size and not 0 on the
/// object.
void perturb_appearance_in(const cv::Mat& mask, double strength, Random& random, cv::Mat& colour);

/// Simulates the depth dropout of a structured-light camera at short range, where its pattern saturates. Surfaces
/// nearer than `limit` metres keep their depth in patches of random size only, together a fraction `kept`, 0 to 1.
/// `depth` is CV_32FC1, metres, NaN = none.
void drop_near_depth(double limit, double kept, cv::Mat& depth, Random& random);

/// Adds the noise of a larger distance. A scale space shows an object `ratio` times as far away as taught in an
/// enlarged image: its size is the same then, but not the sensor's noise, which is that of the larger distance and as
/// much coarser. What is missing of it is added to an image taken at `distance` metres; `depth` is CV_32FC1, metres.
/// Without it, normals of the smooth surfaces nearby would be learnt, which do not hold for the rougher ones far away.
void add_far_noise(double distance, double ratio, cv::Mat& depth, Random& random);

}  // namespace houghstream::training
