#include "pose/model/symmetry_search.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"

namespace houghstream {
namespace {

using namespace world;

const cv::Mat kGrey(8, 8, CV_8UC3, cv::Scalar(128, 128, 128));

Mesh grey_box(double x, double y, double z) {
  return box(Eigen::Vector3d(x, y, z), kGrey);
}

Mesh solid_of_revolution(double radius, double top_radius, double height, int segments) {
  return lathe(with_arc_length({{0, 0, 0}, {radius, 0, 0}, {top_radius, height, 0}, {0, height, 0}}), kGrey, segments);
}

Mesh moved(Mesh mesh, const Eigen::Isometry3d& T) {
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = T.cast<float>() * vertex;
  return mesh;
}

Mesh taught(const std::string& name) {
  return make_taught_object(taught_object_id(name)).thing->mesh;
}

constexpr bool kShape = false;
constexpr bool kColour = true;

Symmetries find(const Mesh& mesh, bool compare_colours = kShape) {
  SymmetrySearch settings;
  settings.compare_colours = compare_colours;
  return find_symmetries(mesh, settings);
}

/// Whole degrees of the turns, in order.
std::multiset<int> angles(const Symmetries& symmetries) {
  std::multiset<int> out;
  for (const Eigen::Isometry3d& rotation : symmetries.discrete)
    out.insert(static_cast<int>(std::lround(Eigen::AngleAxisd(rotation.linear()).angle() * 180.0 / M_PI)));
  return out;
}

TEST(SymmetrySearch, ABoxHasThreeHalfTurns) {
  const Symmetries found = find(grey_box(0.1, 0.2, 0.3));
  EXPECT_TRUE(found.continuous.empty());
  EXPECT_EQ(angles(found), (std::multiset<int>{180, 180, 180}));
}

TEST(SymmetrySearch, ASquareBoxHasQuarterTurnsAboutOneAxis) {
  EXPECT_EQ(angles(find(grey_box(0.1, 0.1, 0.3))), (std::multiset<int>{90, 90, 180, 180, 180, 180, 180}));
  EXPECT_EQ(find(grey_box(0.1, 0.11, 0.3)).discrete.size(), 3U) << "sides that differ by more than the tolerance";
}

TEST(SymmetrySearch, ACubeHasTheTwentyThreeTurnsOfItsGroup) {
  const std::multiset<int> rotations = angles(find(grey_box(0.1, 0.1, 0.1)));
  EXPECT_EQ(rotations.size(), 23U);
  EXPECT_EQ(rotations.count(90), 6U);
  EXPECT_EQ(rotations.count(120), 8U);
  EXPECT_EQ(rotations.count(180), 9U);
}

TEST(SymmetrySearch, ACylinderTurnsFreelyAndUpsideDownAConeOnlyFreely) {
  const Symmetries cylinder = find(solid_of_revolution(0.04, 0.04, 0.1, 48));
  ASSERT_EQ(cylinder.continuous.size(), 1U);
  EXPECT_NEAR(std::abs(cylinder.continuous[0].axis.z()), 1.0, 1e-9);
  EXPECT_NEAR(cylinder.continuous[0].offset.head<2>().norm(), 0.0, 1e-6);
  ASSERT_EQ(cylinder.discrete.size(), 1U);
  EXPECT_NEAR((cylinder.discrete[0] * Eigen::Vector3d(0, 0, 0.1)).z(), 0.0, 1e-6) << "top to bottom";
  const Symmetries cone = find(solid_of_revolution(0.04, 0.02, 0.1, 48));
  EXPECT_EQ(cone.continuous.size(), 1U);
  EXPECT_TRUE(cone.discrete.empty());
}

TEST(SymmetrySearch, AHexagonalFrustumHasSixFoldTurns) {
  EXPECT_EQ(angles(find(solid_of_revolution(0.04, 0.02, 0.06, 6))), (std::multiset<int>{60, 60, 120, 120, 180}));
}

TEST(SymmetrySearch, WhereTheMeshLiesDoesNotMatter) {
  Eigen::Isometry3d T(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.5, -0.3, 0.8).normalized()));
  T.pretranslate(Eigen::Vector3d(0.3, -0.1, 0.2));
  EXPECT_EQ(angles(find(moved(grey_box(0.1, 0.2, 0.3), T))), (std::multiset<int>{180, 180, 180}));
  const Symmetries cone = find(moved(solid_of_revolution(0.04, 0.02, 0.1, 48), T));
  ASSERT_EQ(cone.continuous.size(), 1U);
  EXPECT_NEAR(std::abs(cone.continuous[0].axis.dot(T.linear().col(2))), 1.0, 1e-6);
  const Eigen::Vector3d from_axis = T.inverse() * cone.continuous[0].offset;
  EXPECT_NEAR(from_axis.head<2>().norm(), 0.0, 1e-6);
}

TEST(SymmetrySearch, ABallHasTwoFreeAxes) {
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= 24; ++i) profile.push_back({0.05 * std::sin(M_PI * i / 24), -0.05 * std::cos(M_PI * i / 24), 0});
  profile.front().radius = profile.back().radius = 0.0;
  EXPECT_EQ(find(lathe(with_arc_length(profile), kGrey)).continuous.size(), 2U);
}

TEST(SymmetrySearch, ABowlIsFreeAboutItsAxisInShapeAndColour) {
  for (const bool compare : {kShape, kColour}) {
    const Symmetries bowl = find(taught("bowl"), compare);
    ASSERT_EQ(bowl.continuous.size(), 1U);
    EXPECT_NEAR(bowl.continuous[0].axis.z(), 1.0, 1e-9);
    EXPECT_TRUE(bowl.discrete.empty()) << "a bowl upside down is another";
  }
}

TEST(SymmetrySearch, ALabelBreaksTheSymmetryOfACan) {
  EXPECT_EQ(find(taught("soda_can")).continuous.size(), 1U);
  EXPECT_TRUE(find(taught("soda_can"), kColour).continuous.empty());
}

TEST(SymmetrySearch, ATextureBreaksTheSymmetriesOfACarton) {
  EXPECT_EQ(angles(find(taught("cereal_box"))), (std::multiset<int>{180, 180, 180}));
  EXPECT_TRUE(find(taught("cereal_box"), kColour).empty());
}

TEST(SymmetrySearch, AHandleLeavesAMugNone) {
  EXPECT_TRUE(find(taught("coffee_mug")).empty());
}

TEST(SymmetrySearch, VertexColoursCountWhereThereIsNoTexture) {
  Mesh mesh = grey_box(0.1, 0.2, 0.3);
  mesh.texture.release();
  mesh.uvs.clear();
  EXPECT_EQ(find(mesh, kColour).discrete.size(), 3U) << "nothing to compare";
  // The mesh is red at the top and blue at the bottom, so that only half a turn about z is left.
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    mesh.colours.push_back(vertex.z() > 0.0F ? cv::Vec3b(0, 0, 255) : cv::Vec3b(255, 0, 0));
  const Symmetries found = find(mesh, kColour);
  ASSERT_EQ(found.discrete.size(), 1U);
  EXPECT_NEAR(found.discrete[0].linear()(2, 2), 1.0, 1e-9);
}

TEST(SymmetrySearch, RefusesAMeshWithoutSurface) {
  EXPECT_THROW(find(Mesh()), InputError);
}

Eigen::Isometry3d anyhow() {
  Eigen::Isometry3d T(Eigen::Quaterniond(0.4, 0.3, -0.5, 0.7).normalized());
  T.pretranslate(Eigen::Vector3d(0.2, -0.1, 0.05));
  return T;
}

Mesh tilted(const Mesh& mesh) {
  return moved(mesh, anyhow());
}

/// Each triangle becomes four, so many times over.
Mesh subdivided(const Mesh& mesh, int times) {
  if (times == 0) return mesh;
  Mesh fine;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<Eigen::Vector3f, 3> corners = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    const auto first = static_cast<std::uint32_t>(fine.vertices.size());
    for (std::size_t i = 0; i < 3; ++i) fine.vertices.push_back(corners[i]);
    for (std::size_t i = 0; i < 3; ++i) fine.vertices.emplace_back(0.5F * (corners[i] + corners[(i + 1) % 3]));
    for (const std::array<std::uint32_t, 3>& t :
         {std::array<std::uint32_t, 3>{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
      fine.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return subdivided(fine, times - 1);
}

/// Returns the shape symmetry of a tilted mesh, without axes that only a handle breaks.
Symmetries of_shape(const Mesh& mesh) {
  return find_shape_symmetry(tilted(mesh)).symmetries;
}

TEST(ShapeSymmetry, OfABoxAreThreeHalfTurnsHoweverItLies) {
  const Symmetries found = of_shape(grey_box(0.085, 0.073, 0.028));
  EXPECT_TRUE(found.continuous.empty());
  EXPECT_EQ(angles(found), (std::multiset<int>{180, 180, 180}));
}

TEST(ShapeSymmetry, OfACubeAreTheTwentyThreeOfItsGroupHoweverItLies) {
  const Mesh cube = grey_box(0.1, 0.1, 0.1);
  std::vector<Mesh> lying = {tilted(cube)};
  Random random(5);
  for (int i = 0; i < 5; ++i) {
    Eigen::Isometry3d T(
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized());
    T.pretranslate(Eigen::Vector3d(0.1, -0.2, 0.05));
    lying.push_back(moved(cube, T));
  }
  for (const Mesh& mesh : lying) {
    const std::multiset<int> rotations = angles(find_shape_symmetry(mesh).symmetries);
    EXPECT_EQ(rotations.size(), 23U);
    EXPECT_EQ(rotations.count(90), 6U);
    EXPECT_EQ(rotations.count(120), 8U);
    EXPECT_EQ(rotations.count(180), 9U);
  }
}

TEST(ShapeSymmetry, OfATiltedSquarePrismAreFoundThoughTwoMomentsAreEqual) {
  for (const double height : {0.04, 0.3})
    EXPECT_EQ(angles(of_shape(grey_box(0.1, 0.1, height))), (std::multiset<int>{90, 90, 180, 180, 180, 180, 180}));
}

TEST(ShapeSymmetry, OfATiltedCanAreASpinAndAHalfTurn) {
  constexpr double kEqualMoments = 1.67;  // radii of height for which all three moments are equal
  for (const double height : {0.1, 0.04 * kEqualMoments}) {
    const Symmetries found = of_shape(solid_of_revolution(0.04, 0.04, height, 48));
    ASSERT_EQ(found.continuous.size(), 1U) << height;
    EXPECT_GT(std::abs(found.continuous[0].axis.dot(anyhow().linear().col(2))), 0.9998) << height;
    const Eigen::Vector3d offset = anyhow().inverse() * found.continuous[0].offset;
    EXPECT_LT(offset.head<2>().norm(), 0.0005) << height;
    ASSERT_EQ(found.discrete.size(), 1U) << height;
    const Eigen::Vector3d top = anyhow() * Eigen::Vector3d(0.0, 0.0, height);
    EXPECT_LT((anyhow().inverse() * (found.discrete[0] * top)).norm(), 0.001) << "top to bottom";
  }
}

TEST(ShapeSymmetry, ALipWithinTheNoiseOfDepthBreaksNone) {
  const auto can = [](double lip) {
    return lathe(
        with_arc_length(
            {{0, 0, 0}, {0.033, 0, 0}, {0.033, 0.1, 0}, {0.033 + lip, 0.1, 0}, {0.033 + lip, 0.102, 0}, {0, 0.102, 0}}),
        kGrey, 64);
  };
  EXPECT_EQ(of_shape(can(0.0015)).continuous.size(), 1U);
  EXPECT_EQ(of_shape(can(0.0015)).discrete.size(), 1U);
  EXPECT_EQ(of_shape(can(0.01)).continuous.size(), 1U);
  EXPECT_TRUE(of_shape(can(0.01)).discrete.empty()) << "a brim";
}

TEST(ShapeSymmetry, OfABoxThatIsScannedUnevenlyAreItsHalfTurns) {
  Mesh mesh = subdivided(grey_box(0.16, 0.21, 0.07), 4);
  Random random(3);
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    for (int i = 0; i < 3; ++i) vertex[i] += static_cast<float>(random.uniform(-0.0004, 0.0004));
  }
  EXPECT_EQ(angles(of_shape(mesh)), (std::multiset<int>{180, 180, 180}));
}

TEST(ShapeSymmetry, OfATiltedBallAreAll) {
  std::vector<ProfilePoint> profile;
  for (int i = 0; i <= 24; ++i) profile.push_back({0.05 * std::sin(M_PI * i / 24), -0.05 * std::cos(M_PI * i / 24), 0});
  profile.front().radius = profile.back().radius = 0.0;
  EXPECT_EQ(of_shape(lathe(with_arc_length(profile), kGrey)).continuous.size(), 2U);
}

TEST(ShapeSymmetry, AMugIsRoundButForItsHandle) {
  const std::vector<ProfilePoint> wall = {{0, 0, 0},       {0.04, 0, 0},      {0.04, 0.1, 0},
                                          {0.037, 0.1, 0}, {0.037, 0.003, 0}, {0, 0.003, 0}};
  const Mesh handle = tube({{0.039, 0, 0.08}, {0.065, 0, 0.07}, {0.065, 0, 0.03}, {0.039, 0, 0.02}}, 0.006, kGrey);
  const Mesh mug = compose({{lathe(with_arc_length(wall), kGrey)}, {handle}});
  const ShapeSymmetry found = find_shape_symmetry(tilted(mug));
  EXPECT_TRUE(found.symmetries.empty());
  ASSERT_TRUE(found.nearly_round.has_value());
  EXPECT_GT(std::abs(found.nearly_round->axis.dot(anyhow().linear().col(2))), 0.9994) << "2 degrees";
  const Eigen::Vector3d offset = anyhow().inverse() * found.nearly_round->offset;
  EXPECT_LT(offset.head<2>().norm(), 0.0015) << "the axis of its wall, not of its mass";
}

TEST(ShapeSymmetry, WhatIsRoundOrFarFromItIsNotNearlyRound) {
  EXPECT_FALSE(find_shape_symmetry(solid_of_revolution(0.04, 0.03, 0.1, 48)).nearly_round.has_value());
  EXPECT_FALSE(find_shape_symmetry(grey_box(0.1, 0.1, 0.1)).nearly_round.has_value());
  EXPECT_FALSE(find_shape_symmetry(grey_box(0.3, 0.3, 0.004)).nearly_round.has_value())
      << "most of a square sheet stays where it is when it spins";
}

TEST(ShapeSymmetry, ASheetWithoutThicknessHasSome) {
  Mesh sheet;
  sheet.vertices = {{-0.1F, -0.05F, 0.0F}, {0.1F, -0.05F, 0.0F}, {0.1F, 0.05F, 0.0F}, {-0.1F, 0.05F, 0.0F}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(angles(of_shape(sheet)), (std::multiset<int>{180, 180, 180}));
  EXPECT_THROW(find_shape_symmetry(Mesh()), InputError);
}

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();
const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

cv::Mat plain(int grey) {
  return {8, 8, CV_8UC3, cv::Scalar(grey, grey, grey)};
}

TEST(RotationSymmetryTest, DeviationsUpToTheToleranceFit) {
  // A quarter turn takes a face from 52 to 50 mm off the axis, and 2 mm outside; 2 mm are 0.0062 of the diameter.
  const Mesh mesh = box(Eigen::Vector3d(0.1, 0.104, 0.3), plain(128));
  const double deviation = 0.002 / mesh_diameter(mesh);
  SymmetrySearch settings;
  settings.tolerance = deviation * 1.01;
  EXPECT_TRUE(RotationSymmetryTest(MeasuredMesh(mesh), kOrigin, settings).is_symmetric_under(kUp, M_PI / 2));
  settings.tolerance = deviation * 0.99;
  EXPECT_FALSE(RotationSymmetryTest(MeasuredMesh(mesh), kOrigin, settings).is_symmetric_under(kUp, M_PI / 2));
  EXPECT_TRUE(RotationSymmetryTest(MeasuredMesh(mesh), kOrigin, settings).is_symmetric_under(kUp, M_PI));
}

TEST(RotationSymmetryTest, TurnsGoThroughTheCentre) {
  const Mesh mesh = box(Eigen::Vector3d(0.1, 0.2, 0.3), plain(128));
  const Eigen::Vector3d beside(0.01, 0.0, 0.0);
  EXPECT_FALSE(RotationSymmetryTest(MeasuredMesh(mesh), beside, {}).is_symmetric_under(kUp, M_PI))
      << "moves the box by 0.02 m";
  EXPECT_TRUE((RotationSymmetryTest(MeasuredMesh(mesh), beside, {}).rotation_about_axis(kUp, M_PI) * kOrigin)
                  .isApprox(2.0 * beside));
}

TEST(RotationSymmetryTest, ColoursMayDifferALittleOnMostOrMuchOnFewPoints) {
  BoxFaces faces;
  faces.front = faces.left = faces.right = faces.top = faces.bottom = plain(100);
  faces.back = plain(120);
  const Mesh mesh = box(Eigen::Vector3d(0.1, 0.1, 0.1), faces);
  SymmetrySearch settings;
  settings.compare_colours = true;
  EXPECT_TRUE(RotationSymmetryTest(MeasuredMesh(mesh), kOrigin, settings).is_symmetric_under(kUp, M_PI))
      << "20 of 255 levels";
  settings.colour_difference = 0.07;
  EXPECT_FALSE(RotationSymmetryTest(MeasuredMesh(mesh), kOrigin, settings).is_symmetric_under(kUp, M_PI))
      << "on two of six faces";
  settings.max_differing_fraction = 0.4;
  EXPECT_TRUE(RotationSymmetryTest(MeasuredMesh(mesh), kOrigin, settings).is_symmetric_under(kUp, M_PI));
  settings.max_differing_fraction = 0.05;
  EXPECT_TRUE(
      RotationSymmetryTest(MeasuredMesh(mesh), kOrigin, settings).is_symmetric_under(Eigen::Vector3d::UnitY(), M_PI))
      << "the back stays the back";
}

TEST(RotationSymmetryTest, RefusesAMeshWithoutSurface) {
  EXPECT_THROW(RotationSymmetryTest(MeasuredMesh(Mesh()), kOrigin, {}), InputError);
}

}  // namespace
}  // namespace houghstream
