#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/feature_settings.hpp"
#include "detector/features/hole_filling.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// A frame at the size the detector works at.
struct WorkingFrame {
  cv::Mat colour;           ///< CV_8UC3 BGR
  cv::Mat filled_depth;     ///< CV_32FC1, metres; holes borrow the nearest measured depth, NaN where it is too far away
  Camera camera;            ///< camera of these images
  float size_ratio = 1.0F;  ///< size of everything in this image over its size as taught, in a scale space
};

/// A size at which features are computed, and the range of depth that is searched in it. The support of a feature is
/// fixed in pixels, as in the paper (Section 5.1.2); two sizes an octave apart keep it within a factor of two in metres
/// too, and give far objects enough pixels. Each level of a scale space contains all depths.
struct FeatureLevel {
  float scale = 1.0F;         ///< working size over frame size
  float size_ratio = 1.0F;    ///< entry of FeatureSettings::scales, in a scale space
  float min_distance = 0.0F;  ///< metres
  float max_distance = 0.0F;  ///< metres

  bool contains(float depth) const { return depth > min_distance && depth <= max_distance; }  // false for NaN
};
/// Focal length of the 640x480 cameras that the paper's patches, and all supports in pixels, were counted in.
constexpr float kReferenceFocal_px = 525.0F;

/// Returns the levels of a depth-normalised search, for cameras with the focal length for which supports in pixels were
/// chosen.
std::vector<FeatureLevel> feature_levels(const FeatureSettings& settings);
/// Returns the levels for a camera, scaled by focal_octave_scale(): with a longer focal length an object has more
/// pixels, and supports in pixels would cover less of it. Images are an octave smaller, or larger, for each octave of a
/// longer, or shorter, focal length. The paper's cameras have equal focal lengths.
std::vector<FeatureLevel> feature_levels(const FeatureSettings& settings, const Camera& camera);

/// Returns the power of two that brings a camera's focal length nearest to kReferenceFocal_px.
float focal_octave_scale(const Camera& camera);

/// Resizes (paper, Section 5.1.1) and closes small holes, over the pixels or metres of FeatureSettings. Of each 2x2
/// block the nearest surface counts, so that foreground and background are never averaged into a surface that is not
/// there.
WorkingFrame make_working_frame(const RgbdFrame& frame, float scale, const FeatureSettings& settings);

/// Makes the working frame of one level of a scale space.
WorkingFrame make_working_frame(const RgbdFrame& frame, const FeatureLevel& level, const FeatureSettings& settings);

/// An image, and this at half the size, a quarter and an eighth.
using LabLevels = std::array<cv::Mat, 4>;

/// Makes the colours of a BGR image with which view templates are compared: CV_8UC3, CIE L*a*b*, each pixel the mean of
/// 3x3, since dim light is noisy. `blurred` is overwritten.
void make_smoothed_lab(const cv::Mat& colour, cv::Mat& blurred, LabLevels& lab);

/// The images that the stages of a search look at, with the memory that is kept for the next frame's.
struct WorkingImages {
  std::vector<FeatureLevel> levels;  ///< levels for the frame's camera
  std::vector<WorkingFrame> frames;  ///< one for each level
  LabLevels lab;                     ///< make_smoothed_lab of the first level
  std::vector<HoleWorkspace> holes;  ///< one for each level
  cv::Mat blurred;
  cv::Mat toned;  ///< colours of the level that has the frame's own size
};

/// Makes the depth-normalised levels of a frame. `images` is overwritten, and its memory is reused where it
/// is not shared.
void make_working_images(const RgbdFrame& frame, const FeatureSettings& settings, int threads, WorkingImages& images);

}  // namespace houghstream
