#include "detector/forest/forest_file.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "detector/features/feature_families.hpp"
#include "detector/training/forest_trainer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/detector/forest/earlier_forest_files.hpp"
#include "tests/detector/toy_data.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

class ForestFile : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    Profile profile = toy::quick_profile();
    profile.training.trees = 2;
    profile.training.max_depth = 8;
    forest = training::train_forest(toy::training_views(), profile, [](const auto&) {});
  }
  void SetUp() override {
    file = std::filesystem::temp_directory_path() / "houghstream_forest_file_test.forest";
    save_forest(forest, file);
    std::ostringstream read;
    read << std::ifstream(file, std::ios::binary).rdbuf();
    whole = read.str();
  }
  void TearDown() override { std::filesystem::remove(file); }

  void rewrite(const std::string& bytes) const { std::ofstream(file, std::ios::binary) << bytes; }

  /// Returns the one line that comes out when the file holds these bytes.
  std::string error_for(const std::string& bytes) const {
    rewrite(bytes);
    try {
      load_forest(file);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
      return error.what();
    }
    return "no error";
  }

  static inline Forest forest;
  std::filesystem::path file;
  std::string whole;
};

TEST_F(ForestFile, ComesBackWhole) {
  const Forest loaded = load_forest(file);
  EXPECT_EQ(loaded.nodes.size(), forest.nodes.size());
  EXPECT_EQ(loaded.leaves, forest.leaves);
  EXPECT_EQ(loaded.classes[1].name, "rings");
  EXPECT_EQ(loaded.patch.radius, forest.patch.radius);
  EXPECT_EQ(loaded.profile, "realtime");
  EXPECT_EQ(loaded.features.families, forest.features.families);
  EXPECT_EQ(loaded.scoring, Scoring::kEvidence);
  save_forest(loaded, file);
  std::ostringstream again;
  again << std::ifstream(file, std::ios::binary).rdbuf();
  EXPECT_TRUE(again.str() == whole);
}

TEST_F(ForestFile, TheVersionsBeforeAreReadAsTheSameForest) {
  for (const std::string& before : {forest_file_of_version_16(forest), forest_file_of_version_17(forest)}) {
    rewrite(before);
    save_forest(load_forest(file), file);
    std::ostringstream again;
    again << std::ifstream(file, std::ios::binary).rdbuf();
    EXPECT_TRUE(again.str() == whole) << before.substr(0, before.find('\n'));
  }
}

TEST_F(ForestFile, IsSmallerThanTheVersionBefore) {
  EXPECT_LT(whole.size(), forest_file_of_version_17(forest).size() * 3 / 4);
}

/// Returns the bytes with a number at a place, and the checksum that goes with it.
template <typename Number>
std::string changed(std::string bytes, std::size_t at, Number number) {
  std::memcpy(&bytes[at], &number, sizeof number);
  const std::size_t payload = bytes.find('\n') + 1 + 12;
  const std::uint32_t crc = libdeflate_crc32(0, bytes.data() + payload, bytes.size() - payload);
  std::memcpy(&bytes[payload - 4], &crc, sizeof crc);
  return bytes;
}

TEST_F(ForestFile, AnEntryOutOfItsPlaceIsRefusedInVersion16) {
  const std::string whole_before = forest_file_of_version_16(forest);
  const std::size_t behind = 8 + forest.votes.size() * 16 + 8 + forest.leaf_views.size() * 8;
  const std::size_t last_entry = whole_before.size() - behind - 16;
  expect_says(error_for(changed(whole_before, last_entry, std::uint32_t{0})), {"an entry of a leaf begins at vote 0"});
}

TEST_F(ForestFile, AVoteThatIsNoNumberIsRefusedInVersion16) {
  const std::string whole_before = forest_file_of_version_16(forest);
  const std::size_t last_weight = whole_before.size() - 8 - forest.leaf_views.size() * 8 - 4;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect_says(error_for(changed(whole_before, last_weight, nan)), {"a vote of weight nan"});
}

TEST_F(ForestFile, MissingFileIsRefused) {
  EXPECT_THROW(load_forest("/nonexistent/a.forest"), InputError);
}

TEST_F(ForestFile, OtherFilesAreRefused) {
  EXPECT_NE(error_for("PNG and so on").find("not a forest file"), std::string::npos);
  EXPECT_NE(error_for("").find("not a forest file"), std::string::npos);
}

TEST_F(ForestFile, AnotherVersionIsRefused) {
  const std::size_t digits = std::to_string(kForestFileVersion).size();
  std::string other = whole;
  other.replace(other.find('\n') - digits, digits, "0");
  EXPECT_NE(error_for(other).find("version '0'"), std::string::npos);
}

TEST_F(ForestFile, EveryTruncationIsRefused) {
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{40}, std::size_t{25}}) {
    EXPECT_NE(error_for(whole.substr(0, size)).find("expected"), std::string::npos) << size << " bytes";
  }
}

TEST_F(ForestFile, ADamagedByteIsNoticed) {
  std::string damaged = whole;
  damaged[damaged.size() / 2] ^= 1;
  EXPECT_NE(error_for(damaged).find("checksum"), std::string::npos);
}

TEST_F(ForestFile, ABlockThatIsNoZstdIsRefused) {
  // The file ends with the last block of the leaves' views, and a frame of zstd begins with its magic number.
  const std::size_t frame = whole.rfind("\x28\xb5\x2f\xfd");
  ASSERT_NE(frame, std::string::npos);
  expect_says(error_for(changed(whole, frame, std::uint32_t{0})), {"forest payload cannot be decompressed"});
}

TEST_F(ForestFile, AListThatItsBlocksCannotHoldIsRefused) {
  const std::size_t last_list = whole.rfind("\x28\xb5\x2f\xfd") - 2 * sizeof(std::uint64_t);
  expect_says(error_for(changed(whole, last_list, std::uint64_t{1} << 60U)), {"a list of 1152921504606846976 items"});
  const auto fewer = static_cast<std::uint64_t>(forest.leaf_views.size() - 1);
  expect_says(error_for(changed(whole, last_list, fewer)), {"decompresse"});
}

TEST_F(ForestFile, AnIndexThatPointsNowhereIsRefused) {
  Forest bad = forest;
  bad.nodes[0].right = 1 << 30;
  save_forest(bad, file);
  EXPECT_THROW(load_forest(file), InputError);
  bad = forest;
  bad.leaf_classes[0].vote_count += 1;
  save_forest(bad, file);
  EXPECT_THROW(load_forest(file), InputError);
}

TEST_F(ForestFile, AnObjectBesideTheBoxOfItsViewIsRefused) {
  Forest bad = forest;
  ASSERT_FALSE(bad.views.empty());
  bad.views.back().appearance.mm[TemplateGrid::depth_index(7, TemplateGrid::kSide - 1)] = 0;
  save_forest(bad, file);
  EXPECT_THROW(load_forest(file), InputError);
}

TEST_F(ForestFile, ALeafThatKnowsAClassTwiceIsRefused) {
  Forest bad = forest;
  bad.leaf_classes.insert(bad.leaf_classes.begin(), bad.leaf_classes[0]);
  for (std::uint32_t& end : bad.leaves) end += end > 0 ? 1 : 0;  // the first non-empty leaf gets the inserted entry
  save_forest(bad, file);
  EXPECT_THROW(load_forest(file), InputError);
}

TEST_F(ForestFile, SettingsThatNoProfileHasAreRefused) {
  const auto expect_refused = [&](const std::string& what, const auto& change) {
    Forest bad = forest;
    change(bad);
    save_forest(bad, file);
    expect_says(error_of([&] { load_forest(file); }), {what});
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect_refused("features: families 0x0", [](Forest& f) { f.features.families = 0; });
  expect_refused("features: families 0x101", [](Forest& f) { f.features.families = 0x101; });
  expect_refused("features: handling 2", [](Forest& f) { f.features.handling = static_cast<ScaleHandling>(2); });
  expect_refused("a scale space without scales", [](Forest& f) { f.features.handling = ScaleHandling::kScaleSpace; });
  expect_refused("scoring 7", [](Forest& f) { f.scoring = static_cast<Scoring>(7); });
  for (const float scale : {nan, -1.0F, 0.001F, 100.0F}) {
    expect_refused("features: scales hold", [&](Forest& f) { f.features.scales[2] = scale; });
    expect_refused("features: image_scale", [&](Forest& f) { f.features.image_scale = scale; });
  }
  expect_refused("features: depth_sobel_px 8, expected an odd number",
                 [](Forest& f) { f.features.depth_sobel_px = 8; });
  expect_refused("features: min_max_px 0, expected 1 to 31 working pixels",
                 [](Forest& f) { f.features.min_max_px = 0; });
  expect_refused("features: fill_distance_px nan, expected 0 to 1000",
                 [&](Forest& f) { f.features.fill_distance_px = nan; });
  expect_refused("features: fill_distance -1, expected 0 to 1 m", [](Forest& f) { f.features.fill_distance = -1.0F; });
  expect_refused("features: tone: least_mean 140, expected no more than the most_mean of 130", [](Forest& f) {
    f.features.tone = {140.0F, 130.0F, 50.0F};
  });
  expect_refused("features: tone: most_deviation 0, expected 1 to 255",
                 [](Forest& f) { f.features.tone.max_deviation = 0.0F; });
  expect_refused("features: tone: least_mean nan", [&](Forest& f) { f.features.tone.min_mean = nan; });
  expect_refused("patch: radius 0, expected 1 to 127 steps", [](Forest& f) { f.patch.radius = 0; });
  expect_refused("patch: unit nan, expected", [&](Forest& f) { f.patch.unit = nan; });
}

TEST_F(ForestFile, TestsOfPlanesThatTheFamiliesLackAreRefused) {
  Forest bad = forest;
  bad.features.families = kDepthValue;  // two planes; the forest reads more
  save_forest(bad, file);
  EXPECT_THROW(load_forest(file), InputError);
  bad = forest;
  bad.nodes[0].test.dy2 = static_cast<std::int8_t>(-forest.patch.radius - 1);
  save_forest(bad, file);
  EXPECT_THROW(load_forest(file), InputError);
  bad = forest;
  bad.nodes[0].test.kind = 3;
  save_forest(bad, file);
  EXPECT_THROW(load_forest(file), InputError);
}

TEST_F(ForestFile, AGoodFileSurvivesAFailedWrite) {
  EXPECT_THROW(save_forest(forest, "/nonexistent/folder/a.forest"), InputError);
  EXPECT_NO_THROW(load_forest(file));
}

}  // namespace
}  // namespace houghstream
