#include "detector/forest/forest.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(LeafVote, KeepsItsOffsetWithinATenthOfAMillimetre) {
  const Eigen::Vector3f offset(0.1234F, -1.2345F, 0.00004F);
  const LeafVote vote(offset, 0.3F);
  EXPECT_LT((vote.offset() - offset).lpNorm<Eigen::Infinity>(), 0.5F * LeafVote::kStep_m);
  EXPECT_NEAR(vote.weight.value(), 0.3F, 0.5F * Share::kStep);
  EXPECT_EQ(LeafVote(offset, 1.0F).weight.value(), 1.0F);
  EXPECT_EQ(LeafVote({9.0F, -9.0F, 0.0F}, 1.0F).offset(),
            Eigen::Vector3f(LeafVote::kReach_m, -LeafVote::kReach_m, 0.0F));
}

TEST(Forest, ALeafStartsWhereTheOneBeforeItEnds) {
  Forest forest;
  forest.leaves = {0, 2, 2, 3};
  forest.leaf_classes.resize(3);
  forest.leaf_classes[0].vote_count = 3;
  forest.leaf_classes[1].view_count = 2;
  const std::vector<LeafStart> starts = find_leaf_starts(forest);
  ASSERT_EQ(starts.size(), 3U);
  for (const std::size_t leaf : {1U, 2U}) {
    EXPECT_EQ(starts[leaf].vote, 3U);
    EXPECT_EQ(starts[leaf].view, 2U);
  }
}

TEST(RayRotation, TurnsTheOpticalAxisOntoTheRayAndNothingElse) {
  for (const Eigen::Vector3f& ray :
       {Eigen::Vector3f(0, 0, 2), Eigen::Vector3f(0.3F, -0.2F, 1), Eigen::Vector3f(-1, 1, 1)}) {
    const Eigen::Matrix3f rotation = ray_rotation(ray);
    EXPECT_LT((rotation * Eigen::Vector3f::UnitZ() - ray.normalized()).norm(), 1e-6F);
    EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3f::Identity()).norm(), 1e-5F);
    EXPECT_NEAR(rotation.determinant(), 1.0F, 1e-5F);
    const Eigen::Quaternionf smallest = Eigen::Quaternionf::FromTwoVectors(Eigen::Vector3f::UnitZ(), ray);
    EXPECT_LT((rotation - smallest.toRotationMatrix()).norm(), 1e-5F);
  }
}

TEST(PixelTest, DepthNormalisationKeepsTheTestOnTheObject) {
  const PatchSettings patch{0.002F, 10};
  // 10 steps of 2 mm at 1 m with a focal length of 250 px are 5 px, at 2 m 2.5 px.
  EXPECT_EQ(patch_scale(patch, 250.0, 1.0F), 128);
  EXPECT_EQ(patch_scale(patch, 250.0, 2.0F), 64);
  // A patch never reaches beyond the border of a FeatureImage, however near it is.
  EXPECT_LE(patch_scale(patch, 250.0, 0.01F) * patch.radius, FeatureImage::kPad * 256 + 128);
}

TEST(PixelTest, ComparesOnePlaneAtTwoPlacesAndWrapsDepth) {
  FeatureImage image(20, 20, 64);
  image.at(8, 10)[3] = 200;
  image.at(12, 10)[3] = 30;
  image.at(8, 10)[32] = 250;
  image.at(12, 10)[32] = 4;
  PixelTest test;
  test.dx1 = -2;
  test.dx2 = 2;
  test.plane = 3;
  EXPECT_EQ(test_value(test, image.patch(10, 10, 256)), 170);
  test.plane = 32;
  test.kind = PixelTest::kWrapping;
  EXPECT_EQ(test_value(test, image.patch(10, 10, 256)), -10);  // 250 - (256 + 4)
}

TEST(PixelTest, AloneItComparesOnePixelOnly) {
  FeatureImage image(20, 20, 64);
  image.at(8, 10)[3] = 200;
  image.at(12, 10)[3] = 30;
  PixelTest test;
  test.dx1 = -2;
  test.dx2 = 2;
  test.plane = 3;
  test.kind = PixelTest::kSinglePixel;
  EXPECT_EQ(test_value(test, image.patch(10, 10, 256)), 200);
}

TEST(FindLeaf, WalksRightFromTheThresholdOn) {
  Forest forest;
  forest.roots = {0};
  PixelTest test;
  test.dx2 = 1;
  test.threshold = 5;
  forest.nodes = {{test, -1, -2}};
  FeatureImage image(4, 4, 32);
  image.at(1, 1)[0] = 5;
  EXPECT_EQ(find_leaf(forest, 0, image.patch(1, 1, 256)), 1);
  image.at(1, 1)[0] = 4;
  EXPECT_EQ(find_leaf(forest, 0, image.patch(1, 1, 256)), 0);
}

}  // namespace
}  // namespace houghstream
