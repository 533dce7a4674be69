#include "tools/common/searched_objects.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/store/small_store.hpp"

namespace houghstream {
namespace {

TEST(SearchedObjects, AStoreGivesItsForestItsModelsAndTheScoreOfItsObjects) {
  const std::filesystem::path folder = store::whole_store("searched_objects");
  SearchedObjects objects{folder.string(), "", ""};
  EXPECT_EQ(reported_from(objects), kStoreThreshold);
  SearchOptions search;
  const std::optional<store::ObjectStore> store = take_store(objects, search);
  ASSERT_TRUE(store.has_value());
  EXPECT_EQ(store->objects.size(), 2U);
  EXPECT_EQ(objects.forest, store->forest_file().string());
  EXPECT_EQ(objects.models, store->models_folder().string());
  EXPECT_EQ(search.threshold, kStoreThreshold);
}

TEST(SearchedObjects, AScoreThatWasAskedForStays) {
  SearchedObjects objects{store::whole_store("searched_objects_score").string(), "", ""};
  SearchOptions search;
  search.threshold = 0.1F;
  EXPECT_TRUE(take_store(objects, search).has_value());
  EXPECT_EQ(search.threshold, 0.1F);
}

TEST(SearchedObjects, WithoutAStoreNothingChanges) {
  SearchedObjects objects{"", "my.forest", "models"};
  SearchOptions search;
  EXPECT_FALSE(take_store(objects, search).has_value());
  EXPECT_EQ(objects.forest, "my.forest");
  EXPECT_EQ(objects.models, "models");
  EXPECT_FALSE(search.threshold.has_value());
  EXPECT_EQ(reported_from(objects), EvidenceSettings{}.threshold);
}

TEST(SearchedObjects, AStoreBesideItsPartsIsRefused) {
  SearchOptions search;
  for (SearchedObjects objects : {SearchedObjects{"/no/such", "f", ""}, SearchedObjects{"/no/such", "", "m"}}) {
    EXPECT_EQ(error_of([&] { take_store(objects, search); }),
              "expected either --objects STORE or --forest FILE and --models FOLDER");
  }
}

}  // namespace
}  // namespace houghstream
