#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "detector/training_set.hpp"
#include "pipeline/random.hpp"

namespace houghstream {

/// What a node's test should bring (Gall et al. 2011, Section 3.2): pure classes or agreeing offsets.
enum class Objective { kClass, kOffset };

/// Finds the best of many random tests for a node. Holds scratch memory; one per thread.
class SplitSearch {
 public:
  SplitSearch(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings,
              std::vector<float> label_weights);

  /// The best test for these samples, or nothing where none leaves at least kMinSide samples on both sides.
  std::optional<PixelTest> best_test(const std::vector<std::uint32_t>& samples, Objective objective, Random& random);

  static constexpr int kMinSide = 10;
  static constexpr int kBins = 16;

 private:
  struct BinSums {
    float weight = 0.0F;
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
  };

  PixelTest random_test(Random& random) const;
  void evaluate_tests(const std::vector<std::uint32_t>& samples);
  /// Best threshold of test t; `gain` is left at -infinity where no threshold is allowed.
  void search_thresholds(std::size_t t, const std::vector<std::uint32_t>& samples, Objective objective, float& gain,
                         int& threshold);
  float class_gain(const std::vector<BinSums>& left, const std::vector<BinSums>& all) const;
  float offset_gain(const std::vector<BinSums>& left, const std::vector<BinSums>& all) const;

  const TrainingSet& set_;
  const PatchSettings& patch_;
  const TrainingSettings& settings_;
  std::vector<float> label_weights_;
  std::vector<PixelTest> tests_;
  std::vector<std::int16_t> values_;  // tests x samples
  std::vector<BinSums> bins_;         // kBins x labels
  std::vector<BinSums> left_;
  std::vector<BinSums> all_;
};

}  // namespace houghstream
