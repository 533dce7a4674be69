#include "drivers/synth/objects.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <set>

#include "drivers/synth/mesh_parts.hpp"
#include "pipeline/checks.hpp"
#include "tests/drivers/synth/closed_surface.hpp"

namespace houghstream {
namespace {

TEST(Objects, TaughtOnesAreClosedCentredAndOfHouseholdSize) {
  std::set<std::string> names;
  for (int id = 1; id <= kTaughtObjectCount; ++id) {
    const TaughtObject object = make_taught_object(id);
    const Mesh& mesh = object.thing->mesh;
    SCOPED_TRACE(object.name);
    names.insert(object.name);
    EXPECT_EQ(taught_object_id(object.name), id);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_GT(signed_volume(mesh), 0.0);
    EXPECT_GT(agreeing_normals(mesh), 0.99);
    EXPECT_LT(mesh_bounds(mesh).center().norm(), 1e-5F);
    EXPECT_GT(mesh_bounds(mesh).sizes().minCoeff(), 0.04F);
    EXPECT_LT(mesh_bounds(mesh).sizes().maxCoeff(), 0.3F);
    EXPECT_EQ(mesh.colours.size(), mesh.vertices.size());
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kTaughtObjectCount));
}

TEST(Objects, SodaCanHasTheSizeOfACan) {
  const Eigen::Vector3f size = mesh_bounds(make_taught_object(4).thing->mesh).sizes();
  EXPECT_NEAR(size.x(), 0.066, 0.001);
  EXPECT_NEAR(size.z(), 0.122, 0.001);
}

TEST(Objects, AreTheSameOnEveryCall) {
  const ThingPtr first = make_taught_object(2).thing;
  const ThingPtr second = make_taught_object(2).thing;
  EXPECT_EQ(cv::norm(first->mesh.texture, second->mesh.texture, cv::NORM_INF), 0.0);
}

TEST(Objects, PrintsAreNotFlatButTheBowlIsPlain) {
  const auto contrast = [](int id) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(make_taught_object(id).thing->mesh.texture, mean, deviation);
    return deviation[0];
  };
  EXPECT_LT(contrast(1), 10.0);
  for (const int id : {2, 3, 4}) EXPECT_GT(contrast(id), 30.0);
}

TEST(Objects, DistractorsAreClosedAndDifferFromSeedToSeed) {
  for (int kind = 0; kind < kDistractorKinds; ++kind) {
    const ThingPtr thing = make_distractor(kind, 2);
    SCOPED_TRACE(thing->name);
    EXPECT_TRUE(is_closed(thing->mesh));
    EXPECT_GT(signed_volume(thing->mesh), 0.0);
    EXPECT_GT(agreeing_normals(thing->mesh), 0.97);
    const cv::Mat& texture = thing->mesh.texture;
    const cv::Mat other = make_distractor(kind, 3)->mesh.texture;
    EXPECT_TRUE(texture.size() != other.size() || cv::norm(texture, other, cv::NORM_INF) > 0.0);
  }
}

TEST(Objects, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(make_taught_object(0), InputError);
  EXPECT_THROW(make_taught_object(kTaughtObjectCount + 1), InputError);
  EXPECT_THROW(taught_object_id("bathtub"), InputError);
  EXPECT_THROW(make_distractor(kDistractorKinds, 1), InputError);
}

}  // namespace
}  // namespace houghstream
