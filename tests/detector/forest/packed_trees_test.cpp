#include "detector/forest/packed_trees.hpp"

#include <gtest/gtest.h>

#include "tests/detector/forest/random_forest.hpp"

namespace houghstream {
namespace {

/// Returns a node, and the two leaves below it.
Forest one_node(const PixelTest& test) {
  Forest forest;
  forest.roots = {0};
  forest.nodes.push_back({test, -1, -2});
  return forest;
}

TEST(PackedTrees, HoldEveryNodeAndLeafOnce) {
  Random random(21);
  const Forest forest = chance::random_forest(32, random);
  const PackedTrees trees = pack_trees(forest);
  EXPECT_EQ(trees.nodes.size(), forest.roots.size() + 2 * forest.nodes.size());
  std::vector<int> seen(trees.nodes.size() - forest.nodes.size());
  for (const PackedNode& node : trees.nodes) {
    if (node.test == packed::kLeaf) ++seen.at(static_cast<std::size_t>(node.branch));
  }
  EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
}

TEST(PackedTrees, StepsThatAreTooLongDoNotFit) {
  const auto is_packed = [](std::int8_t step) {
    PixelTest first;
    first.dx1 = step;
    PixelTest last;
    last.dy2 = step;
    return !pack_trees(one_node(first)).nodes.empty() && !pack_trees(one_node(last)).nodes.empty();
  };
  EXPECT_TRUE(is_packed(15));
  EXPECT_TRUE(is_packed(-15));
  EXPECT_FALSE(is_packed(16));
  EXPECT_FALSE(is_packed(-16));
  EXPECT_FALSE(is_packed(-128));
}

TEST(PackedTrees, NodesWithSeveralParentsDoNotFit) {
  Forest forest;
  forest.roots = {0};
  constexpr std::int32_t kNodes = 60;  // 2^60 paths
  for (std::int32_t n = 1; n < kNodes; ++n) forest.nodes.push_back({{}, n, n});
  forest.nodes.push_back({{}, -1, -2});
  EXPECT_TRUE(pack_trees(forest).nodes.empty());
}

TEST(PackedTrees, OneStepThatIsTooLongLeavesAllTreesUnpacked) {
  Random random(22);
  Forest forest = chance::random_forest(32, random);
  ASSERT_FALSE(pack_trees(forest).nodes.empty());
  forest.nodes[0].test.dx1 = 100;
  const PackedTrees trees = pack_trees(forest);
  EXPECT_TRUE(trees.nodes.empty());
  EXPECT_TRUE(trees.roots.empty());
}

TEST(PackedTrees, NodesAndPixelsAreFetched) {
  const std::vector<PackedNode> nodes = {{1, 2}, {3, 4}, {5, 6}};
  const std::vector<std::uint8_t> pixels = {10, 20, 30};
  const std::vector<std::int32_t> places = {2, 0, 2};
  std::vector<PackedNode> fetched(3);
  fetch_nodes(nodes.data(), places.data(), places.size(), fetched.data());
  EXPECT_EQ(fetched[0].test, 5U);
  EXPECT_EQ(fetched[1].branch, 2);
  const std::vector<std::int32_t> first = {1, -1, 0};
  const std::vector<std::int32_t> second = {0, 0, 1};
  std::vector<std::uint8_t> first_values(3);
  std::vector<std::uint8_t> second_values(3);
  fetch_pixels(pixels.data() + 1, {first.data(), second.data(), first_values.data(), second_values.data()}, 3);
  EXPECT_EQ(first_values, (std::vector<std::uint8_t>{30, 10, 20}));
  EXPECT_EQ(second_values, (std::vector<std::uint8_t>{20, 20, 30}));
}

}  // namespace
}  // namespace houghstream
