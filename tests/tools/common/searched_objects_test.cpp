#include "tools/common/searched_objects.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/store/small_store.hpp"

namespace houghstream {
namespace {

TEST(SearchedObjects, AStoreGivesItsForestAndItsModels) {
  const std::filesystem::path folder = store::whole_store("searched_objects");
  SearchedObjects objects{folder.string(), "", ""};
  const std::optional<store::ObjectStore> store = take_store(objects);
  ASSERT_TRUE(store.has_value());
  EXPECT_EQ(store->objects.size(), 2U);
  EXPECT_EQ(objects.forest, store->forest_file().string());
  EXPECT_EQ(objects.models, store->models_folder().string());
}

TEST(SearchedObjects, WithoutAStoreNothingChanges) {
  SearchedObjects objects{"", "my.forest", "models"};
  EXPECT_FALSE(take_store(objects).has_value());
  EXPECT_EQ(objects.forest, "my.forest");
  EXPECT_EQ(objects.models, "models");
}

TEST(SearchedObjects, AStoreBesideItsPartsIsRefused) {
  for (SearchedObjects objects : {SearchedObjects{"/no/such", "f", ""}, SearchedObjects{"/no/such", "", "m"}}) {
    EXPECT_EQ(error_of([&] { take_store(objects); }),
              "expected either --objects STORE or --forest FILE and --models FOLDER");
  }
}

}  // namespace
}  // namespace houghstream
