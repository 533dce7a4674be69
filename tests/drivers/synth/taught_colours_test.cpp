#include "drivers/synth/taught_colours.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "drivers/synth/objects.hpp"
#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

TEST(TaughtColours, NearOnesLookTheSame) {
  Random random(4);
  for (int id = 1; id <= kClassCount; ++id) {
    const Hsv& base = class_colours(id).base;
    for (int i = 0; i < 100; ++i) EXPECT_LT(cv::norm(near_colour(base, random) - bgr(base), cv::NORM_INF), 65.0);
  }
}

TEST(TaughtColours, ThePlainObjectHasItsClassColour) {
  const cv::Scalar mean = cv::mean(make_taught_object(1).thing->mesh.texture);
  EXPECT_LT(cv::norm(mean - bgr(class_colours(1).base), cv::NORM_INF), 12.0);
}

TEST(TaughtColours, DistractorsHaveThemOnlyWhereAsked) {
  constexpr int kJar = 15;
  const cv::Mat plain = make_distractor(kJar, 5)->mesh.texture;
  EXPECT_EQ(cv::norm(plain, make_distractor(kJar, 5, 0.0)->mesh.texture, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(plain, make_distractor(kJar, 5, 1.0)->mesh.texture, cv::NORM_INF), 0.0);
}

TEST(TaughtColours, RefusesAnotherClass) {
  EXPECT_THROW(class_colours(0), InputError);
  EXPECT_THROW(class_colours(kClassCount + 1), InputError);
}

}  // namespace
}  // namespace houghstream
