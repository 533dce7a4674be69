#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"
#include "pipeline/types/frame.hpp"

// Domain randomisation (Tobin et al. 2017) of RGB-D cameras for composed or rendered images. A score that is learnt
// from one camera's images would rely on what is specific to that camera.
//
// Colour goes through the steps of a camera in their order (Karaimer & Brown, "A Software Platform for Manipulating the
// Camera Imaging Pipeline", ECCV 2016): lens, exposure, sensor noise, white balance, demosaicing, tone curve, colour
// rendering, sharpening, compression; makes differ in each of them (Kim, Lin, Lu, Suesstrunk, Lin & Brown, "A New
// In-Camera Imaging Model for Color Computer Vision and Its Application", PAMI 34(12), 2012).
//
// Depth is that of structured light or of a time-of-flight camera:
// - Nguyen, Izadi & Lovell, "Modeling Kinect Sensor Noise for Improved 3D Reconstruction and Tracking", 3DIMPVT 2012:
// axial noise with distance and slant, outlines that are uncertain by about a pixel.
// - Khoshelham & Elberink, "Accuracy and Resolution of Kinect Depth Data for Indoor Mapping Applications", Sensors
// 12(2), 2012: disparity is measured in steps of 1/8 pixel, other cameras' steps are finer or coarser.
// - Foix, Alenya & Torras, "Lock-in Time-of-Flight (ToF) Cameras: A Survey", IEEE Sensors Journal 11(9), 2011: depth
// distortion that changes periodically with distance ("wiggling"), errors that depend on the amplitude of the light
// that returns, flying pixels between the surfaces at an edge.
//
// The ranges were chosen for this project.

namespace houghstream::training {

enum class DepthKind : std::uint8_t { kStructuredLight, kTimeOfFlight };
enum class DepthSmoothing : std::uint8_t { kNone, kMedian, kBilateral };

/// A colour camera. As it stands, it changes nothing.
struct ColourVariation {
  double blur_px = 0.0;    ///< blur of the lens: standard deviation
  double motion_px = 0.0;  ///< way of the image while the shutter is open
  double motion_angle = 0.0;
  double exposure_stops = 0.0;                             ///< change of exposure; brighter values are clipped
  double exposure_follow = 0.0;                            ///< automatic: 1 = every image as bright as others
  double vignetting = 0.0;                                 ///< light lost in the farthest corner, 0 to 1
  std::array<double, 2> vignette_centre{0.5, 0.5};         ///< centre in image sizes: images are parts of frames
  double shot_noise = 0.0;                                 ///< deviation of full light, 1 = full scale
  double read_noise = 0.0;                                 ///< deviation without light, 1 = full scale
  double flare = 0.0;                                      ///< light from everywhere, 1 = full scale
  std::array<double, 3> white_balance_bgr{1.0, 1.0, 1.0};  ///< gain on linear light
  int bayer = -1;                                          ///< 0 to 3: what lies at the first pixel, -1 = none
  bool edge_aware = false;                                 ///< demosaicing along edges
  double gamma = 1.0;                                      ///< on coded values; below 1 brightens
  double contrast = 0.0;                                   ///< share of an S curve; below 0 flattens
  double black = 0.0;          ///< coded value, 0 to 1, that becomes black; below 0 greys it
  double white = 1.0;          ///< coded value that becomes white
  double saturation = 1.0;     ///< factor on what a colour differs from its grey
  double hue_rotation = 0.0;   ///< radians, of all colours about grey
  double sharpening = 0.0;     ///< share of the unsharp mask that is added
  double sharpening_px = 1.0;  ///< its standard deviation
  bool half_chroma = false;    ///< one colour for two neighbours (4:2:2)
  int jpeg_quality = 0;        ///< 0 = not compressed
};

/// A depth camera and its registration to colour. As it stands, it changes nothing.
struct DepthVariation {
  DepthKind kind = DepthKind::kStructuredLight;
  double scale = 1.0;                                ///< measured over true depth
  std::array<int, 2> offset_px{0, 0};                ///< depth lies by so much to the right and down of colour
  std::array<int, 2> grown_px{0, 0};                 ///< nearer surfaces, to both sides, up and down
  double jitter_px = 0.0;                            ///< deviation of outlines
  double flying_pixel_fraction = 0.0;                ///< fraction of the pixels at edges that get a depth in between
  double noise = 0.0;                                ///< structured light: in axial deviations (Nguyen et al.)
  double noise_floor = 0.0;                          ///< time of flight: deviation however much light returns, metres
  double noise_light = 0.0;                          ///< deviation where 1 m^-2 returns, inverse to it, metres
  double wiggle = 0.0;                               ///< depth distortion that comes and goes with distance, metres
  double wiggle_wave = 1.0;                          ///< its length, metres
  double wiggle_phase = 0.0;                         ///< radians
  double dark_bias = 0.0;                            ///< metres that black is measured too far away
  double disparity_step_px = 0.0;                    ///< step of a camera of 580 px with 75 mm baseline, 0 = none
  DepthSmoothing smoothing = DepthSmoothing::kNone;  ///< filter that some cameras apply to their depth
  int smoothing_px = 3;                              ///< window
  double edge_loss = 0.0;                            ///< share of pixels at edges that get no depth, 0 to 1
  double shadow_m = 0.0;                             ///< projector to the right (or left: negative) of the camera
  double min_cosine = 0.0;                           ///< surfaces seen flatter than this get no depth
  double min_signal = 0.0;                           ///< reflectance * cosine / z^2, m^-2: less gets no depth
};

struct CameraRandomisation {
  ColourVariation colour;
  DepthVariation depth;
};

/// Draws a camera. `strength` 0 gives one that changes nothing, 1 one that varies as widely as real ones do; more is
/// allowed.
CameraRandomisation sample_camera(double strength, Random& random);

/// Changes a fraction of all images to those of another camera, one that differs by anything up to `strength`.
void randomise_camera(double fraction, double strength, RgbdFrame& frame, Random& random);

/// Applies the camera's colour processing in place: CV_8UC3 BGR. `random` gives the noise.
void apply_colour(const CameraRandomisation& camera, cv::Mat& colour, Random& random);

/// Applies the camera's depth errors in place: CV_32FC1, metres, NaN = none; `view` is the image's camera. `colour`
/// (CV_8UC3 BGR, as it was before apply_colour()) gives the brightness; without it all pixels count as middle grey.
/// Holes stay holes.
void apply_depth(const CameraRandomisation& camera, const Camera& view, cv::Mat& depth, Random& random,
                 const cv::Mat& colour = cv::Mat());

/// Samples a camera's processing of coded values alone: gamma, contrast, levels, saturation, hue. The ranges are wider
/// than those of sample_camera(): trees may learn from less realistic images than scores, which would only trust
/// colours less.
void jitter_tone(double fraction, double strength, cv::Mat& colour, Random& random);

}  // namespace houghstream::training
