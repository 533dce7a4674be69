#include "tools/render/world/objects/taught_colours.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/objects.hpp"

namespace houghstream::world {
namespace {

/// Returns the fraction of a jar's surface, of several jars, that has about a colour of the four classes.
double taught_share_of_jars(double taught_colours) {
  constexpr int kJar = 15;  // two plain surfaces
  constexpr int kJars = 20;
  double fraction = 0.0;
  for (std::uint64_t seed = 1; seed <= kJars; ++seed) {
    const cv::Mat texture = make_distractor(kJar, seed, taught_colours)->mesh.texture;
    cv::Mat taught = cv::Mat::zeros(texture.size(), CV_8UC1);
    for (int id = 1; id <= kClassCount; ++id) {
      for (const Hsv& colour : {class_colours(id).base, class_colours(id).accent}) {
        constexpr double kNear = 75.0;
        cv::Mat near;
        cv::inRange(texture, bgr(colour) - cv::Scalar::all(kNear), bgr(colour) + cv::Scalar::all(kNear), near);
        taught |= near;
      }
    }
    fraction += static_cast<double>(cv::countNonZero(taught)) / static_cast<double>(taught.total()) / kJars;
  }
  return fraction;
}

TEST(TaughtColours, JarsHaveThemAsOftenAsAsked) {
  EXPECT_GT(taught_share_of_jars(1.0), taught_share_of_jars(0.0) + 0.3);
}

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
}  // namespace houghstream::world
