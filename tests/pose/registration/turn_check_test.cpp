#include "pose/registration/turn_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream {
namespace {

using world::box;
using world::BoxFaces;

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();
const Eigen::Vector3d kOrigin = Eigen::Vector3d::Zero();

cv::Mat plain(int grey) {
  return {8, 8, CV_8UC3, cv::Scalar(grey, grey, grey)};
}

TEST(TurnCheck, DeviationsUpToTheToleranceFit) {
  // A quarter turn takes a face from 52 to 50 mm off the axis, and 2 mm outside; 2 mm are 0.0062 of the diameter.
  const Mesh mesh = box(Eigen::Vector3d(0.1, 0.104, 0.3), plain(128));
  const double deviation = 0.002 / mesh_diameter(mesh);
  SymmetrySearch settings;
  settings.tolerance = deviation * 1.01;
  EXPECT_TRUE(TurnCheck(mesh, kOrigin, settings).fits(kUp, M_PI / 2));
  settings.tolerance = deviation * 0.99;
  EXPECT_FALSE(TurnCheck(mesh, kOrigin, settings).fits(kUp, M_PI / 2));
  EXPECT_TRUE(TurnCheck(mesh, kOrigin, settings).fits(kUp, M_PI));
}

TEST(TurnCheck, TurnsGoThroughTheCentre) {
  const Mesh mesh = box(Eigen::Vector3d(0.1, 0.2, 0.3), plain(128));
  const Eigen::Vector3d beside(0.01, 0.0, 0.0);
  EXPECT_FALSE(TurnCheck(mesh, beside, {}).fits(kUp, M_PI)) << "moves the box by 0.02 m";
  EXPECT_TRUE((TurnCheck(mesh, beside, {}).turn(kUp, M_PI) * kOrigin).isApprox(2.0 * beside));
}

TEST(TurnCheck, ColoursMayDifferALittleOnMostOrMuchOnFewPoints) {
  BoxFaces faces;
  faces.front = faces.left = faces.right = faces.top = faces.bottom = plain(100);
  faces.back = plain(120);
  const Mesh mesh = box(Eigen::Vector3d(0.1, 0.1, 0.1), faces);
  SymmetrySearch settings;
  settings.compare_colours = true;
  EXPECT_TRUE(TurnCheck(mesh, kOrigin, settings).fits(kUp, M_PI)) << "20 of 255 levels";
  settings.colour_difference = 0.07;
  EXPECT_FALSE(TurnCheck(mesh, kOrigin, settings).fits(kUp, M_PI)) << "on two of six faces";
  settings.largest_differing = 0.4;
  EXPECT_TRUE(TurnCheck(mesh, kOrigin, settings).fits(kUp, M_PI));
  settings.largest_differing = 0.05;
  EXPECT_TRUE(TurnCheck(mesh, kOrigin, settings).fits(Eigen::Vector3d::UnitY(), M_PI)) << "the back stays the back";
}

TEST(TurnCheck, RefusesAMeshWithoutSurface) {
  EXPECT_THROW(TurnCheck(Mesh(), kOrigin, {}), InputError);
}

}  // namespace
}  // namespace houghstream
