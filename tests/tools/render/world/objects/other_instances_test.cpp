#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "tests/tools/render/world/closed_surface.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"

namespace houghstream::world {
namespace {

double height_ratio(const Asset& other, const Asset& taught) {
  return mesh_bounds(other.mesh).sizes().z() / mesh_bounds(taught.mesh).sizes().z();
}

/// Returns the distance of the mean colours in the a*b* plane.
double colour_distance(const Asset& a, const Asset& b) {
  const auto mean = [](const Asset& thing) {
    cv::Mat lab;
    cv::cvtColor(thing.mip_levels.front(), lab, cv::COLOR_BGR2Lab);
    return cv::mean(lab);
  };
  const cv::Scalar difference = mean(a) - mean(b);
  return std::hypot(difference[1], difference[2]);
}

TEST(OtherInstances, DifferFromTheTaughtOneInSizeOrInColour) {
  for (int id = 1; id <= kClassCount; ++id) {
    const AssetPtr taught = make_taught_object(id).thing;
    int of_other_size = 0;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const AssetPtr other = make_other_instance(id, seed);
      const double ratio = height_ratio(*other, *taught);
      const bool other_size = ratio < 0.86 || ratio > 1.18;
      of_other_size += other_size ? 1 : 0;
      EXPECT_TRUE(other_size || colour_distance(*other, *taught) > 8.0) << "class " << id << ", seed " << seed;
    }
    EXPECT_GT(of_other_size, 1) << "class " << id;
    EXPECT_LT(of_other_size, 11) << "class " << id;
  }
}

TEST(OtherInstances, AreClosedAndFollowTheSeed) {
  for (int id = 1; id <= kClassCount; ++id) {
    const AssetPtr first = make_other_instance(id, 5);
    EXPECT_TRUE(is_closed(first->mesh)) << first->name;
    EXPECT_EQ(first->mesh.vertices, make_other_instance(id, 5)->mesh.vertices);
    EXPECT_NE(first->mesh.vertices, make_other_instance(id, 6)->mesh.vertices);
  }
}

TEST(OtherInstances, ThereAreNoneOfOtherClasses) {
  EXPECT_THROW(make_other_instance(0, 1), InputError);
  EXPECT_THROW(make_other_instance(kClassCount + 1, 1), InputError);
}

}  // namespace
}  // namespace houghstream::world
