#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/training/augmentation/camera_randomisation.hpp"

namespace houghstream::training {
namespace {

/// Patches of many colours, none at full scale, 12 pixels each.
cv::Mat chart() {
  constexpr int kPatch = 12;
  cv::Mat colours(6, 6, CV_8UC3);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 6; ++x) {
      colours.at<cv::Vec3b>(y, x) =
          cv::Vec3b(static_cast<std::uint8_t>(40 + 25 * x), static_cast<std::uint8_t>(40 + 25 * y),
                    static_cast<std::uint8_t>(40 + 25 * ((2 * x + 3 * y) % 6)));
    }
  }
  cv::Mat out;
  cv::resize(colours, out, {}, kPatch, kPatch, cv::INTER_NEAREST);
  return out;
}

/// Returns the values at each patch's centre.
cv::Vec3d patch(const cv::Mat& colour, int x, int y) {
  const cv::Scalar mean = cv::mean(colour(cv::Rect(12 * x + 3, 12 * y + 3, 6, 6)));
  return {mean[0], mean[1], mean[2]};
}

cv::Mat taken(const ColourVariation& colour, const cv::Mat& image, std::uint64_t seed = 1) {
  Random random(seed);
  cv::Mat out = image.clone();
  apply_colour({colour, {}}, out, random);
  return out;
}

double grey_of(const cv::Vec3d& bgr) {
  return 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];
}

double linear(double byte) {
  return byte <= 10.31 ? byte / 255.0 / 12.92 : std::pow((byte / 255.0 + 0.055) / 1.055, 2.4);
}

TEST(CameraColour, AWhiteBalanceIsTheSameFactorOfLightEverywhere) {
  ColourVariation camera;
  camera.white_balance_bgr = {0.8, 1.0, 1.25};
  const cv::Mat before = chart();
  const cv::Mat after = taken(camera, before);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 6; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double gain = linear(patch(after, x, y)[c]) / linear(patch(before, x, y)[c]);
        EXPECT_NEAR(gain, camera.white_balance_bgr[static_cast<std::size_t>(c)], 0.06) << x << " " << y << " " << c;
      }
    }
  }
}

TEST(CameraColour, AStopIsTwiceTheLightAndWhatIsTooBrightIsClipped) {
  ColourVariation camera;
  camera.exposure_stops = 1.0;
  const cv::Mat half(20, 20, CV_8UC3, cv::Scalar(100, 140, 230));
  const cv::Mat after = taken(camera, half);
  EXPECT_NEAR(linear(after.at<cv::Vec3b>(10, 10)[0]), 2.0 * linear(100), 0.005);
  EXPECT_NEAR(linear(after.at<cv::Vec3b>(10, 10)[1]), 2.0 * linear(140), 0.01);
  EXPECT_EQ(after.at<cv::Vec3b>(10, 10)[2], 255);
}

TEST(CameraColour, AutomaticExposureBringsImagesCloserTogether) {
  ColourVariation camera;
  camera.exposure_follow = 0.5;
  const auto mean_of = [&](int level) {
    return cv::mean(taken(camera, cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(level))))[0];
  };
  EXPECT_GT(mean_of(70), 80);
  EXPECT_NEAR(mean_of(110), 110, 1.5);
  EXPECT_LT(mean_of(170), 155);
}

TEST(CameraColour, AHueTurnIsCommonToAllColoursAndKeepsGreys) {
  ColourVariation camera;
  camera.hue_rotation = 0.2;
  cv::Mat before(1, 4, CV_8UC3);
  before.at<cv::Vec3b>(0, 0) = {120, 120, 120};
  before.at<cv::Vec3b>(0, 1) = {180, 90, 90};
  before.at<cv::Vec3b>(0, 2) = {90, 180, 90};
  before.at<cv::Vec3b>(0, 3) = {90, 90, 180};
  const cv::Mat after = taken(camera, before);
  EXPECT_EQ(after.at<cv::Vec3b>(0, 0), before.at<cv::Vec3b>(0, 0));
  const auto angle = [](const cv::Vec3b& bgr) {  // about the grey axis
    const cv::Vec3d v(bgr);
    return std::atan2(std::sqrt(3.0) * (v[1] - v[2]), 2.0 * v[0] - v[1] - v[2]);
  };
  for (int i = 1; i < 4; ++i) {
    const double rotated = angle(after.at<cv::Vec3b>(0, i)) - angle(before.at<cv::Vec3b>(0, i));
    EXPECT_NEAR(std::remainder(rotated, 2.0 * M_PI), 0.2, 0.02) << i;
  }
}

TEST(CameraColour, SaturationMovesColoursFromTheirGreyAndKeepsIt) {
  for (const double saturation : {0.5, 1.3}) {
    ColourVariation camera;
    camera.saturation = saturation;
    const cv::Mat before = chart();
    const cv::Mat after = taken(camera, before);
    for (int i = 0; i < 6; ++i) {
      const cv::Vec3d from = patch(before, i, 5 - i);
      const cv::Vec3d to = patch(after, i, 5 - i);
      EXPECT_NEAR(grey_of(to), grey_of(from), 1.0);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(to[c] - grey_of(to), saturation * (from[c] - grey_of(from)), 1.5);
    }
  }
}

TEST(CameraColour, GammaAndContrastKeepTheOrderOfGreys) {
  cv::Mat ramp(1, 256, CV_8UC3);
  for (int v = 0; v < 256; ++v) ramp.at<cv::Vec3b>(0, v) = cv::Vec3b::all(static_cast<std::uint8_t>(v));
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const ColourVariation drawn = sample_camera(1.0, random).colour;
    ColourVariation camera;
    camera.gamma = drawn.gamma;
    camera.contrast = drawn.contrast;
    const cv::Mat after = taken(camera, ramp);
    for (int v = 1; v < 256; ++v) EXPECT_GE(after.at<cv::Vec3b>(0, v)[1], after.at<cv::Vec3b>(0, v - 1)[1]) << seed;
    EXPECT_LE(after.at<cv::Vec3b>(0, 0)[1], 1);
    EXPECT_GE(after.at<cv::Vec3b>(0, 255)[1], 254);
  }
  ColourVariation bright;
  bright.gamma = 0.8;
  EXPECT_GT(taken(bright, ramp).at<cv::Vec3b>(0, 100)[0], 110);
}

TEST(CameraColour, LevelsLoseWhatIsDarkAndBrightAndSpreadTheRest) {
  cv::Mat ramp(1, 256, CV_8UC3);
  for (int v = 0; v < 256; ++v) ramp.at<cv::Vec3b>(0, v) = cv::Vec3b::all(static_cast<std::uint8_t>(v));
  ColourVariation camera;
  camera.black = 0.2;
  camera.white = 0.8;
  const cv::Mat after = taken(camera, ramp);
  EXPECT_EQ(after.at<cv::Vec3b>(0, 50)[0], 0);
  EXPECT_EQ(after.at<cv::Vec3b>(0, 205)[0], 255);
  EXPECT_NEAR(after.at<cv::Vec3b>(0, 153)[0], 170, 2);
  camera.black = -0.1;
  EXPECT_NEAR(taken(camera, ramp).at<cv::Vec3b>(0, 0)[0], 28, 2) << "lifted blacks are grey";
}

TEST(CameraColour, ToneChangesImagesAndNothingWithoutAShare) {
  const cv::Mat before = chart();
  cv::Mat after = before.clone();
  Random random(3);
  jitter_tone(0.0, 1.0, after, random);
  EXPECT_EQ(cv::norm(before, after, cv::NORM_INF), 0.0);
  double change = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    after = before.clone();
    cv::Mat again = before.clone();
    Random first(seed);
    Random second(seed);
    jitter_tone(1.0, 1.0, after, first);
    jitter_tone(1.0, 1.0, again, second);
    EXPECT_EQ(cv::norm(after, again, cv::NORM_INF), 0.0);
    change = std::max(change, cv::norm(before, after, cv::NORM_L1) / (3.0 * static_cast<double>(before.total())));
  }
  EXPECT_GT(change, 15.0);
}

TEST(CameraColour, EveryMosaicGivesItsColoursBack) {
  const cv::Mat before = chart();
  for (int bayer = 0; bayer < 4; ++bayer) {
    for (const bool edge_aware : {false, true}) {
      ColourVariation camera;
      camera.bayer = bayer;
      camera.edge_aware = edge_aware;
      const cv::Mat after = taken(camera, before);
      for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 6; ++x) EXPECT_LT(cv::norm(patch(after, x, y), patch(before, x, y)), 2.0) << bayer;
      }
      EXPECT_GT(cv::norm(after, before, cv::NORM_INF), 5.0) << "edges between patches get colours of their own";
    }
  }
}

TEST(CameraColour, VignettingDarkensCornersOnly) {
  ColourVariation camera;
  camera.vignetting = 0.4;
  const cv::Mat after = taken(camera, cv::Mat(60, 80, CV_8UC3, cv::Scalar::all(150)));
  EXPECT_NEAR(after.at<cv::Vec3b>(30, 40)[0], 150, 1);
  EXPECT_NEAR(linear(after.at<cv::Vec3b>(0, 0)[0]) / linear(150), 0.6, 0.02);
  EXPECT_NEAR(linear(after.at<cv::Vec3b>(59, 79)[0]) / linear(150), 0.6, 0.03);
}

TEST(CameraColour, NoiseHasItsDeviationAndNoBias) {
  ColourVariation camera;
  camera.shot_noise = 0.02;
  camera.read_noise = 0.004;
  const cv::Mat after = taken(camera, cv::Mat(120, 120, CV_8UC3, cv::Scalar::all(150)));
  cv::Mat light(after.size(), CV_64FC3);
  for (int y = 0; y < after.rows; ++y) {
    for (int x = 0; x < after.cols; ++x) {
      for (int c = 0; c < 3; ++c) light.at<cv::Vec3d>(y, x)[c] = linear(after.at<cv::Vec3b>(y, x)[c]);
    }
  }
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(light, mean, deviation);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(mean[c], linear(150), 0.002);
    EXPECT_NEAR(deviation[c], std::sqrt(0.02 * 0.02 * linear(150) + 0.004 * 0.004), 0.0006);
  }
  EXPECT_GT(cv::norm(after, taken(camera, cv::Mat(120, 120, CV_8UC3, cv::Scalar::all(150)), 2), cv::NORM_INF), 0.0);
}

double steepest(const cv::Mat& image) {
  cv::Mat difference;
  cv::absdiff(image.colRange(1, image.cols), image.colRange(0, image.cols - 1), difference);
  double maximum = 0.0;
  cv::minMaxLoc(difference.reshape(1), nullptr, &maximum);
  return maximum;
}

TEST(CameraColour, BlurAndMotionSoftenAndSharpeningSteepens) {
  cv::Mat edge(40, 40, CV_8UC3, cv::Scalar::all(80));
  edge.colRange(20, 40).setTo(cv::Scalar::all(160));
  ColourVariation soft;
  soft.blur_px = 1.0;
  ColourVariation across;
  across.motion_px = 6.0;
  ColourVariation along = across;
  along.motion_angle = M_PI_2;
  ColourVariation sharp;
  sharp.sharpening = 1.0;
  EXPECT_LT(steepest(taken(soft, edge)), 50);
  EXPECT_LT(steepest(taken(across, edge)), 25);
  EXPECT_GT(steepest(taken(along, edge)), 75) << "nothing moves along an edge";
  EXPECT_GT(steepest(taken(sharp, edge)), 100);
  for (const ColourVariation& camera : {soft, across, sharp}) {
    EXPECT_NEAR(cv::mean(taken(camera, edge))[0], 120.0, 1.0) << "no light is lost";
  }
}

TEST(CameraColour, HalfTheChromaKeepsBrightness) {
  cv::Mat before(4, 4, CV_8UC3, cv::Scalar(60, 60, 160));
  before.col(1).setTo(cv::Scalar(160, 60, 60));
  before.col(3).setTo(cv::Scalar(160, 60, 60));
  ColourVariation camera;
  camera.half_chroma = true;
  const cv::Mat after = taken(camera, before);
  const cv::Vec3d left(after.at<cv::Vec3b>(1, 0));
  const cv::Vec3d right(after.at<cv::Vec3b>(1, 1));
  EXPECT_NEAR(grey_of(left), grey_of(cv::Vec3d(60, 60, 160)), 2.0);
  EXPECT_NEAR(grey_of(right), grey_of(cv::Vec3d(160, 60, 60)), 2.0);
  EXPECT_NEAR(left[0] - left[2], right[0] - right[2], 1.0) << "one colour for both";
}

TEST(CameraColour, CompressionLosesMoreAtLowQuality) {
  Random random(4);
  cv::Mat before = chart();
  for (int y = 0; y < before.rows; ++y) {
    for (int x = 0; x < before.cols; ++x)
      before.at<cv::Vec3b>(y, x) += cv::Vec3b::all(static_cast<std::uint8_t>(random.below(30)));
  }
  const auto loss = [&](int quality) {
    ColourVariation camera;
    camera.jpeg_quality = quality;
    return cv::norm(taken(camera, before), before, cv::NORM_L1) / static_cast<double>(before.total());
  };
  EXPECT_GT(loss(95), 0.0);
  EXPECT_GT(loss(30), 1.5 * loss(95));
}

}  // namespace
}  // namespace houghstream::training
