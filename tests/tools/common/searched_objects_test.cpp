#include "tools/finder/searched_objects.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/store/small_store.hpp"

namespace houghstream {
namespace {

TEST(ObjectArguments, AStoreGivesItsForestAndItsModels) {
  const std::filesystem::path folder = store::whole_store("searched_objects");
  ObjectArguments objects{folder.string(), "", ""};
  const std::optional<store::ObjectStore> store = resolve_store(objects);
  ASSERT_TRUE(store.has_value());
  EXPECT_EQ(store->objects.size(), 2U);
  EXPECT_EQ(objects.forest, store->forest_file(2).string());
  EXPECT_EQ(objects.models, store->models_folder().string());
}

TEST(ObjectArguments, WithoutAStoreNothingChanges) {
  ObjectArguments objects{"", "my.forest", "models"};
  EXPECT_FALSE(resolve_store(objects).has_value());
  EXPECT_EQ(objects.forest, "my.forest");
  EXPECT_EQ(objects.models, "models");
}

TEST(ObjectArguments, AStoreBesideItsPartsIsRefused) {
  for (ObjectArguments objects : {ObjectArguments{"/no/such", "f", ""}, ObjectArguments{"/no/such", "", "m"}}) {
    EXPECT_EQ(error_of([&] { resolve_store(objects); }),
              "expected either --objects STORE or --forest FILE and --models FOLDER");
  }
}

}  // namespace
}  // namespace houghstream
