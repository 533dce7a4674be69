#include "tools/teach/mesh/store_summary.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/drivers/store/small_store.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"
#include "tools/teach/mesh/store_rename.hpp"

namespace houghstream::teach {
namespace {

TEST(StoreSummary, SizesStandInTheListAndInItsJson) {
  const std::filesystem::path folder = fresh_folder("store_summary");
  store::fill_store(folder, "brick");
  const store::ObjectStore listed = store::read_store(folder);
  const std::map<int, Eigen::Vector3d> sizes = object_sizes(listed);
  ASSERT_EQ(sizes.size(), listed.objects.size());
  const std::string text = store_text(listed);
  const OrderedJson json = store_json(listed);
  EXPECT_EQ(json["store"], folder.string());
  ASSERT_EQ(json["objects"].size(), listed.objects.size());
  for (std::size_t i = 0; i < listed.objects.size(); ++i) {
    const store::StoredObject& object = listed.objects[i];
    const Eigen::Vector3d& size_m = sizes.at(object.id);
    EXPECT_GT(size_m.minCoeff(), 0.0);
    EXPECT_NE(text.find(object.name), std::string::npos) << text;
    EXPECT_NE(text.find(size_words(size_m)), std::string::npos) << text;
    EXPECT_EQ(json["objects"][i]["name"], object.name);
    EXPECT_EQ(json["objects"][i]["size_m"][2], size_m.z());
    EXPECT_TRUE(json["objects"][i]["shape_symmetries"].is_null()) << "not looked for";
  }
}

TEST(StoreSummary, PracticeStandsInTheListAndInItsJson) {
  const std::filesystem::path folder = fresh_folder("store_summary_practice");
  store::fill_store(folder, "brick");
  store::ObjectStore listed = store::read_store(folder);
  EXPECT_NE(store_text(listed, 0.98).find("practice: unknown, hs-teach practise learns it\n"), std::string::npos);
  EXPECT_TRUE(store_json(listed)["objects"][0]["practice"].is_null());
  store::PracticeRecord& record = listed.objects[0].practice.emplace();
  EXPECT_NE(store_text(listed).find("practice: seen in none of its rooms\n"), std::string::npos);
  record.shown = 200;
  record.right = 150;
  record.wrong = 1;
  record.scores = {{0.71, 160, 0}, {0.4, 170, 30}};
  record.qualities = {{0.66, 9, 0}};
  record.taken_for = {{"brick", 7}};
  EXPECT_NE(store_text(listed).find("practice: recall 0.75, precision 0.990 of 200 views; taken for brick in 3.5 %\n"),
            std::string::npos)
      << store_text(listed);
  EXPECT_EQ(store_text(listed).find("precision 0.98:"), std::string::npos) << "was not asked for";
  EXPECT_NE(store_text(listed, 0.98)
                .find("precision 0.98: score 0.71, recall 0.80; quality 0.66, recall 0.04 (not "
                      "reached: 0.950 is the best)\n"),
            std::string::npos)
      << store_text(listed, 0.98);
  const OrderedJson practice = store_json(listed, 0.98)["objects"][0]["practice"];
  EXPECT_EQ(practice["views"], 200);
  EXPECT_EQ(practice["recall"], 0.75);
  EXPECT_EQ(practice["taken_for"]["name"], "brick");
  EXPECT_EQ(practice["at_precision"]["score"]["from"], 0.71);
  EXPECT_EQ(practice["at_precision"]["quality"]["reached"], false);
  EXPECT_FALSE(store_json(listed)["objects"][0]["practice"].contains("at_precision"));
  expect_says(error_of([&] { store_text(listed, 1.0); }), {"precision 1, expected 0 to 0.9999"});
}

TEST(StoreSummary, FramesAreNamedMovedAndTakenAway) {
  const std::filesystem::path folder = fresh_folder("store_summary_frames");
  store::fill_store(folder, "brick");
  write_text(folder / "contact_sheet.jpg", "a sheet");
  std::filesystem::create_directories(folder / "views");
  const auto frames = [&] { return store::find_object(store::read_store(folder), "brick").frames; };
  set_frame_in_store(folder, "brick", "top", parse_frame_place("0,0,0.1"));
  set_frame_in_store(folder, "brick", "grasp", parse_frame_place("-0.05,0,0.04,0,0,1,0"));
  ASSERT_EQ(frames().size(), 2U);
  EXPECT_EQ(frames()[0].name, "grasp");
  EXPECT_LT((frames()[0].T_object_frame * Eigen::Vector3d::UnitX() - Eigen::Vector3d(-1.05, 0, 0.04)).norm(), 1e-12);
  EXPECT_NE(store_text(store::read_store(folder)).find("frame grasp "), std::string::npos);
  EXPECT_EQ(store_json(store::read_store(folder))["objects"][1]["frames"]["top"]["translation_m"][2], 0.1);
  EXPECT_EQ(read_text(folder / "contact_sheet.jpg"), "a sheet") << "all else stays as it is";
  EXPECT_EQ(read_text(folder / "forest"), "a forest");

  set_frame_in_store(folder, "brick", "top", parse_frame_place("0,0,0.2"));
  EXPECT_EQ(frames()[1].T_object_frame.translation().z(), 0.2);
  set_frame_in_store(folder, "brick", "top", std::nullopt);
  EXPECT_EQ(frames().size(), 1U);
  expect_says(error_of([&] { set_frame_in_store(folder, "brick", "top", std::nullopt); }),
              {"'brick' has no frame 'top', expected one of grasp"});
  expect_says(error_of([&] { set_frame_in_store(folder, "drill", "top", std::nullopt); }), {"no 'drill'"});
  expect_says(error_of([&] { set_frame_in_store(folder, "brick", "a b", parse_frame_place("0,0,0")); }), {"'a b'"});
  for (const char* none : {"", "1,2", "1,2,x", "1,2,3,4", "0,0,0,2,0,0,0", "0,0,50", "1,2,nan", "1,,3"})
    expect_says(error_of([&] { parse_frame_place(none); }), {"place '" + std::string(none) + "'", "expected"});
}

TEST(StoreSummary, SaysWhatATeachingLeavesAndWhatToTypeNext) {
  const std::filesystem::path folder = fresh_folder("store_summary_taught");
  store::fill_store(folder, "brick");
  store::ObjectStore taught = store::read_store(folder);
  const int id = store::find_object(taught, "brick").id;
  taught.objects[1].practice = store::PracticeRecord();
  EXPECT_NE(teaching_summary(taught, {id}).find("not practised"), std::string::npos);
  taught.objects[1].practice->shown = 40;
  taught.objects[1].practice->right = 30;
  taught.objects[1].practice->wrong = 2;
  const std::string text = teaching_summary(taught, {id});
  for (const std::string& part :
       {taught.contact_sheet().string(), std::string("found in 75 % of 40 practice views, 2 wrong poses\n"),
        "next: hs-stream --source openni2 --objects " + folder.string() + "\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  EXPECT_EQ(text.find("mug"), std::string::npos) << "taught earlier, in\n" << text;
  taught.objects[1].practice.reset();
  EXPECT_NE(teaching_summary(taught, {id}).find("not practised"), std::string::npos);
}

}  // namespace
}  // namespace houghstream::teach
