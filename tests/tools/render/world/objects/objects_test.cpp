#include "tools/render/world/objects/objects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <set>

#include "pipeline/base/checks.hpp"
#include "tests/tools/render/world/closed_surface.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

// Returns objects that can be taught: the four classes, their hard negatives and the sixteen further ones.
std::vector<int> taught_ids() {
  std::vector<int> ids = twenty_class_ids();
  for (int id = kClassCount + 1; id <= kTaughtObjectCount; ++id) ids.push_back(id);
  return ids;
}

// Returns whether a rotation by one of the lathe's 48 steps about z maps every vertex onto another.
bool turns_onto_itself(const Mesh& mesh) {
  const Eigen::AngleAxisf step(static_cast<float>(2.0 * M_PI / 48.0), Eigen::Vector3f::UnitZ());
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Eigen::Vector3f& vertex) {
    const Eigen::Vector3f there = step * vertex;
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                       [&](const Eigen::Vector3f& other) { return (other - there).norm() < 1e-5F; });
  });
}

TEST(Objects, TaughtOnesAreClosedCentredAndOfHouseholdSize) {
  std::set<std::string> names;
  for (const int id : taught_ids()) {
    const TaughtObject object = make_taught_object(id);
    const Mesh& mesh = object.thing->mesh;
    SCOPED_TRACE(object.name);
    names.insert(object.name);
    EXPECT_EQ(object.id, id);
    EXPECT_EQ(object.thing->name, object.name);
    EXPECT_EQ(taught_object_id(object.name), id);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_GT(signed_volume(mesh), 0.0);
    EXPECT_GT(agreeing_normals(mesh), 0.99);
    EXPECT_LT(mesh_bounds(mesh).center().norm(), 1e-5F);
    EXPECT_GT(mesh_bounds(mesh).sizes().minCoeff(), id < kFirstFurtherId ? 0.04F : 0.03F);
    EXPECT_GT(mesh_bounds(mesh).sizes().maxCoeff(), 0.06F);
    EXPECT_LT(mesh_bounds(mesh).sizes().maxCoeff(), 0.3F);
    EXPECT_EQ(mesh.colours.size(), mesh.vertices.size());
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kTaughtObjectCount + kFurtherClassCount));
}

TEST(Objects, FortyAreTwentyClassesAndTwentyNamedInstances) {
  const std::vector<int> ids = forty_object_ids();
  EXPECT_EQ(std::set<int>(ids.begin(), ids.end()).size(), 40U);
  std::set<std::string> names;
  for (const int id : ids) {
    const TaughtObject object = make_taught_object(id);
    names.insert(object.name);
    EXPECT_EQ(taught_object_id(object.name), id);
    EXPECT_FALSE(object.thing->mesh.vertices.empty());
  }
  EXPECT_EQ(names.size(), 40U);
}

TEST(Objects, TwentyClassesAreTheFourAndSixteenMore) {
  const std::vector<int> ids = twenty_class_ids();
  ASSERT_EQ(ids.size(), 20U);
  EXPECT_EQ(std::set<int>(ids.begin(), ids.end()).size(), 20U);
  EXPECT_EQ(std::vector<int>(ids.begin(), ids.begin() + 5), (std::vector<int>{1, 2, 3, 4, 101}));
  EXPECT_EQ(ids.back(), 116);
}

TEST(Objects, OnlyBodiesOfRevolutionAreCalledSymmetric) {
  for (const int id : taught_ids()) {
    const TaughtObject object = make_taught_object(id);
    EXPECT_EQ(turns_onto_itself(object.thing->mesh), object.symmetric_about_z) << object.name;
  }
}

TEST(Objects, SodaCanHasTheSizeOfACan) {
  const Eigen::Vector3f size = mesh_bounds(make_taught_object(4).thing->mesh).sizes();
  EXPECT_NEAR(size.x(), 0.066, 0.001);
  EXPECT_NEAR(size.z(), 0.122, 0.001);
}

TEST(Objects, AreTheSameOnEveryCall) {
  for (const int id : {2, 101, 111, 116}) {
    const AssetPtr first = make_taught_object(id).thing;
    const AssetPtr second = make_taught_object(id).thing;
    EXPECT_EQ(cv::norm(first->mesh.texture, second->mesh.texture, cv::NORM_INF), 0.0);
  }
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
    const AssetPtr thing = make_distractor(kind, 2);
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
  for (const int id : {kTaughtObjectCount + 1, kFirstFurtherId - 1, kFirstFurtherId + kFurtherClassCount})
    EXPECT_THROW(make_taught_object(id), InputError);
  EXPECT_THROW(taught_object_id("bathtub"), InputError);
  EXPECT_THROW(make_distractor(kDistractorKinds, 1), InputError);
}

}  // namespace
}  // namespace houghstream::world
