#include "pipeline/types/chroma_map.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace houghstream {
namespace {

/// A warm camera that shows colours more weakly.
const ChromaMap::Parameters kWarm = (ChromaMap::Parameters() << 0.8, 0.05, 0.0, 0.7, 4.0, 18.0).finished();

ChromaPair pair_of(const std::string& name, const Eigen::Vector2d& model, const Eigen::Vector2d& measured) {
  ChromaPair pair;
  pair.class_name = name;
  pair.model = model;
  pair.measured = measured;
  pair.lightness = 50.0;
  pair.probability = 0.9;
  return pair;
}

ChromaPair seen_by_warm(const std::string& name, double a, double b, double lightness) {
  const ChromaMap camera(kWarm, ChromaMap::Covariance::Zero(), 1.0);
  ChromaPair pair = pair_of(name, {a, b}, camera.apply({a, b}, lightness));
  pair.lightness = lightness;
  return pair;
}

std::vector<ChromaPair> six_objects() {
  return {seen_by_warm("cracker", 36.0, 30.0, 41.0), seen_by_warm("soup", -2.0, 22.0, 68.0),
          seen_by_warm("sugar", 10.0, 10.0, 45.0),   seen_by_warm("mustard", 2.0, 55.0, 60.0),
          seen_by_warm("meat", -12.0, -20.0, 39.0),  seen_by_warm("bowl", 45.0, 5.0, 30.0)};
}

double chroma_error(const ChromaMap& map, const ChromaPair& pair) {
  return (map.apply(pair.model, pair.lightness) - pair.measured).norm();
}

TEST(ChromaMap, AsItStandsItIsTheIdentity) {
  const ChromaMap map;
  EXPECT_EQ(map.apply({12.0, -7.0}, 50.0), Eigen::Vector2d(12.0, -7.0));
  EXPECT_FALSE(map.is_learnt());
  EXPECT_GT(map.uncertainty({0.0, 0.0}, 80.0).trace(), 60.0);
  EXPECT_FALSE(fit_chroma_map({}).is_learnt());
}

TEST(ChromaMap, ACamerasColoursAreLearntOfSixObjects) {
  const std::vector<ChromaPair> pairs = six_objects();
  const ChromaMap map = fit_chroma_map(pairs);
  EXPECT_GT(map.objects(), 5.0);
  const ChromaPair other = seen_by_warm("banana", -5.0, 60.0, 65.0);
  EXPECT_GT(chroma_error(ChromaMap(), other), 8.0);
  EXPECT_LT(chroma_error(map, other), 4.0);
  for (const ChromaPair& pair : pairs) EXPECT_LT(chroma_error(map, pair), 7.5) << pair.class_name;
  EXPECT_LT(map.uncertainty(other.model, 65.0).trace(), 0.4 * ChromaMap().uncertainty(other.model, 65.0).trace());
}

TEST(ChromaMap, AWrongObjectDoesNotDragIt) {
  std::vector<ChromaPair> pairs = six_objects();
  const ChromaPair other = seen_by_warm("banana", -5.0, 60.0, 65.0);
  const double before = chroma_error(fit_chroma_map(pairs), other);
  pairs.push_back(pair_of("bleach", {5.0, 50.0}, {-20.0, -30.0}));
  const ChromaMap map = fit_chroma_map(pairs);
  EXPECT_LT(chroma_error(map, other), before + 1.5);
  EXPECT_GT(chroma_error(map, pairs.back()), 40.0) << "nor is it explained away";
}

TEST(ChromaMap, AnObjectIsJudgedByTheOthersAlone) {
  std::vector<ChromaPair> pairs = {seen_by_warm("cracker", 36.0, 30.0, 41.0)};
  EXPECT_FALSE(fit_chroma_maps_without_each(pairs).front().is_learnt()) << "there is no other";
  pairs.push_back(seen_by_warm("cracker", 30.0, 20.0, 41.0));
  EXPECT_FALSE(fit_chroma_maps_without_each(pairs).front().is_learnt()) << "nor one of another class";
  pairs = six_objects();
  const std::vector<ChromaMap> without = fit_chroma_maps_without_each(pairs);
  ASSERT_EQ(without.size(), pairs.size());
  std::vector<ChromaPair> others(pairs.begin() + 1, pairs.end());
  EXPECT_EQ(without.front().parameters(), fit_chroma_map(others).parameters());
}

TEST(ChromaMap, WhatIsNoNumberHasNoSay) {
  std::vector<ChromaPair> pairs = six_objects();
  const ChromaMap before = fit_chroma_map(pairs);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  pairs.push_back(pair_of("bleach", {kNaN, 0.0}, {10.0, 10.0}));
  pairs.push_back(pair_of("drill", {5.0, 5.0}, {10.0, std::numeric_limits<double>::infinity()}));
  pairs.push_back(pair_of("marker", {5.0, 5.0}, {10.0, 10.0}));
  pairs.back().probability = kNaN;
  pairs.push_back(pair_of("block", {5.0, 5.0}, {10.0, 10.0}));
  pairs.back().lightness = kNaN;
  pairs.push_back(pair_of("clamp", {5.0, 5.0}, {10.0, 10.0}));
  pairs.back().probability = 0.0;
  EXPECT_EQ(fit_chroma_map(pairs).parameters(), before.parameters());
  for (const ChromaMap& map : fit_chroma_maps_without_each(pairs)) EXPECT_TRUE(map.parameters().allFinite());
}

TEST(ChromaMap, FarFromAllThatIsExpectedItStaysFinite) {
  std::vector<ChromaPair> pairs;
  for (const double far : {1e3, 1e5, 1e8}) pairs.push_back(pair_of("far", {10.0, 10.0}, {far, -far}));
  EXPECT_TRUE(fit_chroma_map(pairs).parameters().allFinite());
}

TEST(ChromaMap, AnImageInBlackAndWhiteIsColourless) {
  cv::Mat image(480, 640, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) image.row(y).setTo(cv::Scalar::all(y % 250));
  EXPECT_TRUE(is_colourless(image));
  image(cv::Rect(100, 100, 60, 60)).setTo(cv::Scalar(40, 40, 160));
  EXPECT_FALSE(is_colourless(image));
  EXPECT_EQ(colourless_camera().apply({40.0, 30.0}, 50.0), Eigen::Vector2d::Zero());
}

}  // namespace
}  // namespace houghstream
