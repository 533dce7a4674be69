#include "detector/training/augmentation/camera_randomisation.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream::training {
namespace {

/// Draws what a camera departs from one that changes nothing, in parts of the strength.
class Draw {
 public:
  Draw(double strength, Random& random) : strength_(strength), random_(random) {}

  double part(double low, double high) { return strength_ * random_.uniform(low, high); }
  double factor(double low_stops, double high_stops) { return std::exp2(part(low_stops, high_stops)); }
  int whole(int low, int high) { return static_cast<int>(std::lround(part(low - 0.49, high + 0.49))); }
  bool happens(double fraction) { return random_.uniform() < fraction * std::min(1.0, strength_); }
  Random& random() { return random_; }

 private:
  double strength_;
  Random& random_;
};

ColourVariation draw_colour(Draw draw) {
  Random& random = draw.random();
  ColourVariation colour;
  colour.blur_px = draw.part(0.0, 1.1) * random.uniform();
  if (draw.happens(0.3)) colour.motion_px = draw.part(2.0, 7.0);
  colour.motion_angle = random.uniform(0.0, M_PI);
  colour.exposure_stops = draw.part(-1.2, 0.8);
  colour.exposure_follow = std::min(1.0, draw.part(0.0, 0.5));
  colour.vignetting = std::min(0.9, draw.part(0.0, 0.45));
  colour.vignette_centre = {random.uniform(0.1, 0.9), random.uniform(0.1, 0.9)};
  colour.shot_noise = draw.part(0.0, 0.03);
  colour.read_noise = draw.part(0.0, 0.008);
  colour.flare = std::max(0.0, draw.part(-0.02, 0.02));
  const double warmth = draw.part(-0.45, 0.45);  // stops, along the colours of daylight and lamps
  const double tint = draw.part(-0.12, 0.12);    // across them
  colour.white_balance_bgr = {std::exp2(-warmth), std::exp2(tint), std::exp2(warmth)};
  if (draw.happens(0.6)) colour.bayer = random.below(4);
  colour.edge_aware = random.uniform() < 0.5;
  colour.gamma = draw.factor(-0.4, 0.4);
  colour.contrast = draw.part(-0.35, 0.7);
  colour.saturation = draw.factor(-0.9, 0.5);
  colour.hue_rotation = draw.part(-0.12, 0.12);
  colour.sharpening = std::max(0.0, draw.part(-0.5, 1.4));
  colour.sharpening_px = random.uniform(0.6, 1.6);
  colour.half_chroma = draw.happens(0.4);
  if (draw.happens(0.5)) colour.jpeg_quality = random.between(30, 95);
  return colour;
}

DepthVariation draw_depth(Draw draw) {
  Random& random = draw.random();
  DepthVariation depth;
  depth.kind = random.uniform() < 0.6 ? DepthKind::kStructuredLight : DepthKind::kTimeOfFlight;
  depth.scale = 1.0 + draw.part(-0.01, 0.01);
  depth.offset_px = {draw.whole(-3, 3), draw.whole(-3, 3)};
  if (depth.kind == DepthKind::kStructuredLight) {
    depth.grown_px = {std::max(0, draw.whole(0, 2)), std::max(0, draw.whole(0, 2))};
    depth.jitter_px = draw.part(0.0, 1.0);
    depth.flying_pixel_fraction = std::min(1.0, draw.part(0.0, 0.3));
    depth.noise = draw.part(0.0, 1.3);
    depth.disparity_step_px =
        draw.part(0.0, 1.0) < 0.15 ? 0.0 : draw.part(1.0, 1.0) * std::exp2(random.uniform(-4.0, -1.5));
    if (draw.happens(0.5)) depth.shadow_m = draw.part(-0.075, 0.075);
  } else {
    depth.flying_pixel_fraction = std::min(1.0, draw.part(0.1, 0.8));
    depth.noise_floor = draw.part(0.0, 0.0015);
    depth.noise_light = draw.part(0.0, 0.0008);
    depth.wiggle = draw.part(0.0, 0.004);
    depth.wiggle_wave = random.uniform(0.4, 2.0);
    depth.wiggle_phase = random.uniform(0.0, 2.0 * M_PI);
    depth.dark_bias = draw.part(-0.004, 0.008);
  }
  if (draw.happens(0.5)) {
    depth.smoothing = random.uniform() < 0.5 ? DepthSmoothing::kMedian : DepthSmoothing::kBilateral;
  }
  depth.smoothing_px = random.uniform() < 0.5 ? 3 : 5;
  depth.edge_loss = std::min(1.0, draw.part(0.0, 0.6));
  depth.min_cosine = std::min(0.5, draw.part(0.0, 0.3));
  depth.min_signal = std::max(0.0, draw.part(-0.01, 0.015));
  return depth;
}

}  // namespace

CameraRandomisation sample_camera(double strength, Random& random) {
  if (strength <= 0.0) return {};
  const Draw draw(strength, random);
  CameraRandomisation camera;
  camera.colour = draw_colour(draw);
  camera.depth = draw_depth(draw);
  return camera;
}

void randomise_camera(double fraction, double strength, RgbdFrame& frame, Random& random) {
  if (fraction <= 0.0 || strength <= 0.0 || random.uniform() >= fraction) return;
  const double amount = random.uniform();  // most cameras differ little
  const CameraRandomisation camera = sample_camera(strength * amount, random);
  apply_depth(camera, frame.camera, frame.depth, random, frame.colour);
  apply_colour(camera, frame.colour, random);
}

void jitter_tone(double fraction, double strength, cv::Mat& colour, Random& random) {
  if (fraction <= 0.0 || strength <= 0.0 || random.uniform() >= fraction) return;
  Draw draw(strength * random.uniform(), random);
  CameraRandomisation camera;
  camera.colour.gamma = draw.factor(-0.4, 0.4);
  camera.colour.contrast = draw.part(-0.35, 0.7);
  camera.colour.black = draw.part(-0.06, 0.14);
  camera.colour.white = 1.0 - draw.part(-0.04, 0.22);
  camera.colour.saturation = draw.factor(-0.9, 0.9);
  camera.colour.hue_rotation = draw.part(-0.12, 0.12);
  apply_colour(camera, colour, random);
}

}  // namespace houghstream::training
