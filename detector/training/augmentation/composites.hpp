#pragma once

#include <optional>

#include "detector/training/augmentation/augmentation_settings.hpp"
#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::training {

/// Change of a view's depth at another position: another distance, and off the axis (OffAxisSlope).
struct DepthChange {
  float shift = 0.0F;      ///< metres, at the object's centre
  cv::Point2d tilt;        ///< metres per pixel of the composite right and down from there
  cv::Point2d centre_px;   ///< there, in the composite
  double extra_sigma = 0;  ///< deviation of the noise that the other distance adds, metres

  /// Metres added to the view's depth at a pixel of the composite, but for noise.
  float at(const cv::Point2d& px) const { return shift + static_cast<float>(tilt.dot(px - centre_px)); }
};

/// A training view put into a background at another distance, in another light, as the camera could have seen it. Made
/// from training data only.
struct Composite {
  RgbdFrame frame;           ///< part of the background frame around the object; its camera is the part's
  cv::Mat mask;              ///< CV_8UC1, 255 where the object is seen
  cv::Mat occluder;          ///< CV_8UC1, 255 where something was put in front; empty where nothing was
  int whole_px = 0;          ///< pixels of the object, hidden ones included
  double scale = 1.0;        ///< size in the composite over size in the view
  cv::Point2d origin_px;     ///< pixel p of the composite shows pixel (p - origin_px) / scale of the view
  DepthChange depth_change;  ///< change of the view's depth
};

/// Makes a composite; nothing where the object would not fit the frame. `background` is a whole frame, of any camera:
/// the composite is as that camera would see it.
std::optional<Composite> make_composite(const TrainingView& view, const RgbdFrame& background, double distance,
                                        const AugmentationSettings& settings, Random& random);

/// Returns the standard deviation of a structured-light camera's depth at depth z, metres (Nguyen, Izadi & Lovell 2012,
/// axial noise).
double axial_noise(double z);

/// Changes an image's light in place: gain between two limits in stops (powers of two), contrast, colour cast, haze,
/// noise.
void jitter_lighting(cv::Mat& colour, double strength, double darkest_stops, double brightest_stops, Random& random);

/// Jitters the exposure within a camera's limits: dim images are more frequent than overexposed ones.
void jitter_exposure(cv::Mat& colour, double strength, Random& random);

/// Puts something in front of the composite's object: a patch of the room, nearer than the object, of random shape
/// and place, that hides between a tenth and four fifths of it, with the infrared shadow that a structured-light
/// camera sees to its left. Nothing where no try hides as much as that.
void add_occluder(const RgbdFrame& room, double object_distance, Composite& composite, Random& random);

}  // namespace houghstream::training
