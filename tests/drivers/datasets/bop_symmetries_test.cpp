#include "drivers/datasets/bop_symmetries.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

std::string refusal(const std::string& entry) {
  try {
    symmetries_from_json(nlohmann::json::parse(entry), "info.json object 3");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BopSymmetries, AreReadAsBopWritesThem) {
  const Symmetries read = symmetries_from_json(nlohmann::json::parse(R"({
    "symmetries_discrete": [[-1, 0, 0, 8, 0, -1, 0, 6, 0, 0, 1, 0, 0, 0, 0, 1]],
    "symmetries_continuous": [{"axis": [0, 2, 0], "offset": [5, 0, 0]}]})"),
                                               "test");
  ASSERT_EQ(read.discrete.size(), 1U);
  const Eigen::Vector3d moved = read.discrete[0] * Eigen::Vector3d(0.001, 0.002, 0.003);
  EXPECT_TRUE(moved.isApprox(Eigen::Vector3d(0.007, 0.004, 0.003))) << "half a turn about z through (4, 3) mm";
  ASSERT_EQ(read.continuous.size(), 1U);
  EXPECT_EQ(read.continuous[0].axis, Eigen::Vector3d::UnitY());
  EXPECT_TRUE(read.continuous[0].offset.isApprox(Eigen::Vector3d(0.005, 0.0, 0.0)));
  EXPECT_TRUE(symmetries_from_json(nlohmann::json::object(), "test").empty());
}

TEST(BopSymmetries, AreWrittenInMillimetresRowByRow) {
  Symmetries symmetries;
  symmetries.discrete.emplace_back(Eigen::Translation3d(0.008, 0.006, 0.0) *
                                   Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  symmetries.continuous = {{Eigen::Vector3d::UnitX(), Eigen::Vector3d(0.0, 0.002, 0.0)}};
  OrderedJson entry;
  add_symmetries(symmetries, entry);
  const std::vector<double> expected = {0, -1, 0, 8, 1, 0, 0, 6, 0, 0, 1, 0, 0, 0, 0, 1};
  const auto written = entry["symmetries_discrete"][0].get<std::vector<double>>();
  ASSERT_EQ(written.size(), 16U);
  for (std::size_t i = 0; i < written.size(); ++i) EXPECT_NEAR(written[i], expected[i], 1e-9) << i;
  EXPECT_EQ(entry["symmetries_continuous"].dump(), R"([{"axis":[1.0,0.0,0.0],"offset":[0.0,2.0,0.0]}])");
  OrderedJson without = OrderedJson::object();
  add_symmetries({}, without);
  EXPECT_TRUE(without.empty());
}

TEST(BopSymmetries, WhatIsNoSymmetryIsRefusedWithOneLine) {
  EXPECT_EQ(refusal(R"({"symmetries_continuous": [{"axis": [0, 0, 0], "offset": [0, 0, 0]}]})"),
            "info.json object 3: 'axis' of 'symmetries_continuous' has length 0, expected a direction");
  EXPECT_EQ(refusal(R"({"symmetries_continuous": [{"axis": [0, 0, 1]}]})"), "info.json object 3: no 'offset'");
  EXPECT_EQ(refusal(R"({"symmetries_discrete": 5})"),
            "info.json object 3: 'symmetries_discrete' is 5, expected a list");
  EXPECT_EQ(refusal(R"({"symmetries_discrete": [[1, 0]]})"),
            "info.json object 3: 'symmetries_discrete' is [1,0], expected 16 numbers");
  const std::string mirror = "[-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
  EXPECT_EQ(refusal("{\"symmetries_discrete\": [" + mirror + "]}"),
            "info.json object 3: 'symmetries_discrete' holds " + mirror + ", expected rigid motions");
  const std::string stretched = "[2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
  EXPECT_NE(refusal("{\"symmetries_discrete\": [" + stretched + "]}").find("rigid"), std::string::npos);
  const std::string far_away = "[1,0,0,1e300,0,1,0,0,0,0,1,0,0,0,0,1]";
  EXPECT_NE(refusal("{\"symmetries_discrete\": [" + far_away + "]}").find("rigid"), std::string::npos);
  EXPECT_NE(refusal(R"({"symmetries_continuous": [{"axis": [1e300, 0, 0], "offset": [0, 0, 0]}]})").find("inf"),
            std::string::npos);
  std::string many = "0";
  for (int i = 0; i < 256; ++i) many += ",0";
  EXPECT_EQ(refusal("{\"symmetries_discrete\": [" + many + "]}"),
            "info.json object 3: 'symmetries_discrete' lists 257, expected at most 256");
}

}  // namespace
}  // namespace houghstream
