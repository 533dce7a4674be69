#include "drivers/files/json_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

fs::path file_with(const std::string& text) {
  fs::path file = fresh_folder("json_file") / "file.json";
  write_text(file, text);
  return file;
}

TEST(JsonFile, IsWrittenInOrderAndComesBack) {
  const fs::path file = file_with("");
  OrderedJson json;
  json["9"] = 1.5;
  json["10"] = finite_or_null(std::nan(""));
  write_json(json, file);
  const std::string text = read_text(file);
  EXPECT_LT(text.find("\"9\""), text.find("\"10\""));
  EXPECT_EQ(read_json_object(file), nlohmann::json(json));
  EXPECT_TRUE(read_json_object(file).at("10").is_null());
  EXPECT_TRUE(finite_or_null(std::numeric_limits<double>::infinity()).is_null());
  EXPECT_EQ(finite_or_null(2.5), 2.5);
  EXPECT_THROW(write_json(json, "/no/such/folder/file.json"), InputError);
}

TEST(JsonFile, BytesThatAreNoTextAreReplaced) {
  const fs::path file = file_with("");
  OrderedJson json;
  json["name"] = "mug\xff";
  write_json(json, file);
  EXPECT_EQ(read_json_object(file).at("name"), "mug\xef\xbf\xbd");
}

TEST(JsonFile, WhatIsNoObjectIsRefused) {
  for (const std::string text : {"", "[1, 2]", "{\"a\": 1", "{\"a\": 1} more", "text"}) {
    const fs::path file = file_with(text);
    EXPECT_NE(error_of([&] { read_json_object(file); }).find(file.string()), std::string::npos) << text;
  }
  EXPECT_THROW(read_json_object("/no/such/file.json"), InputError);
}

TEST(JsonFile, NumberedEntriesComeByNumber) {
  const auto entries = read_json_by_id(file_with(R"({"10": "b", "9": "a", "100": "c"})"));
  std::string all;
  for (const auto& [id, entry] : entries) all += entry.get<std::string>();
  EXPECT_EQ(all, "abc");
  for (const std::string key : {"-1", "1x", "", "x", "99999999999"}) {
    EXPECT_THROW(read_json_by_id(file_with("{\"" + key + "\": 1}")), InputError) << key;
  }
}

TEST(JsonFile, NamesThatStandTwiceAreRefused) {
  const fs::path file = file_with(R"({"0": "a", "1": {"id": 2}, "0": "b"})");
  EXPECT_EQ(error_of([&] { read_json_by_id(file); }), file.string() + ": duplicate '0' in an object");
  EXPECT_THROW(read_json_list(file_with(R"([{"id": 1, "id": 2}])")), InputError);
  EXPECT_NO_THROW(read_json_list(file_with(R"([{"id": 1}, {"id": {"id": 2}}])")));
}

TEST(JsonValues, AreOfTheTypeAskedForOrNamed) {
  const nlohmann::json object = {{"half", 0.5}, {"two", 2}, {"text", "2"}, {"huge", 1e12}, {"list", {1, 2.5, 3}}};
  EXPECT_EQ(json_number(object, "half", "here"), 0.5);
  EXPECT_EQ(json_integer(object, "two", "here"), 2);
  EXPECT_EQ(json_numbers(object, "list", 3, "here"), (std::vector<double>{1.0, 2.5, 3.0}));
  EXPECT_EQ(error_of([&] { json_number(object, "none", "here"); }), "here: no 'none'");
  EXPECT_NE(error_of([&] { json_number(object, "text", "here"); }).find("'text'"), std::string::npos);
  EXPECT_THROW(json_integer(object, "half", "here"), InputError);
  EXPECT_THROW(json_integer(object, "huge", "here"), InputError);
  EXPECT_THROW(json_numbers(object, "list", 4, "here"), InputError);
  EXPECT_THROW(json_numbers({{"list", {1, nullptr}}}, "list", 2, "here"), InputError);
  EXPECT_THROW(json_number(nlohmann::json::array(), "half", "here"), InputError);
}

TEST(JsonFile, ListsWithinListsWithoutEndAreRefused) {
  const std::string deep = "{\"0\":{\"cam_K\":" + std::string(200'000, '[') + std::string(200'000, ']') + "}}";
  EXPECT_THROW(read_json_object(file_with(deep)), InputError);
  EXPECT_NO_THROW(read_json_object(file_with("{\"a\":" + std::string(60, '[') + std::string(60, ']') + "}")));
  EXPECT_NO_THROW(read_json_object(file_with("{\"a\":\"" + std::string(100, '[') + "\"}")));
}

TEST(JsonFile, LongValuesAreCutInMessages) {
  const nlohmann::json json = {{"cam_K", std::vector<int>(10'000, 1)}};
  const std::string words = error_of([&] { json_numbers(json, "cam_K", 9, "here"); });
  EXPECT_LT(words.size(), 300U);
  EXPECT_NE(words.find("here: 'cam_K' is [1,1,"), std::string::npos) << words;
}

}  // namespace
}  // namespace houghstream
