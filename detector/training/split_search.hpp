#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "detector/training/training_set.hpp"
#include "pipeline/random.hpp"

namespace houghstream {

/// What a node's test should bring (Gall et al. 2011, Section 3.2): pure classes or agreeing offsets.
enum class Objective { kClass, kOffset };

/// Finds the best of many random tests for a node. All tests are judged on a few of the samples, the best of
/// them on all (successive halving, Jamieson & Talwalkar 2016): a tenth of the work at nearly the same gain. Holds
/// scratch memory; one per thread.
class SplitSearch {
 public:
  SplitSearch(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings,
              std::vector<float> label_weights, bool trusts_light);

  /// The best test for these samples, or nothing where none leaves at least kMinSide samples on both sides.
  std::optional<PixelTest> best_test(const std::vector<std::uint32_t>& samples, Objective objective, Random& random);

  static constexpr int kMinSide = 10;
  static constexpr int kBins = 16;
  static constexpr std::size_t kFirstLook = 256;  ///< samples on which all tests are judged
  static constexpr std::size_t kFinalists = 128;  ///< tests that are judged on all samples

 private:
  /// Weighted sums of some samples of one label: of 1 and of the offset's coordinates.
  struct Sums {
    float weight = 0.0F;
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
    Sums& operator+=(const Sums& other);
  };
  /// A sample as the thresholds see it, laid out in order.
  struct Item {
    Sums sums;
    std::uint32_t label = 0;
  };
  struct Split {
    float gain = 0.0F;
    int threshold = 0;
  };

  PixelTest random_test(Random& random) const;
  void load_items(const std::vector<std::uint32_t>& samples);
  void evaluate_tests(std::size_t test_count, const std::vector<std::uint32_t>& samples);
  /// Sorts the samples into kBins bins by the value of test t; false where all values are equal.
  bool fill_bins(std::size_t t, Objective objective, int& first, int& range);
  struct Judged {
    float gain = 0.0F;
    std::uint32_t test = 0;
    int threshold = 0;
  };
  std::vector<Judged> judge_tests(std::size_t test_count, const std::vector<std::uint32_t>& samples,
                                  Objective objective, int min_side);
  /// Best threshold of test t that leaves at least `min_side` samples on both sides.
  std::optional<Split> search_thresholds(std::size_t t, Objective objective, int min_side);
  float class_gain() const;
  float offset_gain() const;

  const TrainingSet& set_;
  const PatchSettings& patch_;
  const TrainingSettings& settings_;
  std::vector<float> label_weights_;
  bool trusts_light_;  // whether a single pixel's lightness and colour may decide
  std::vector<PixelTest> tests_;
  std::vector<std::int16_t> values_;  // tests x samples
  std::vector<std::int16_t> block_;   // some samples x tests
  std::vector<Item> items_;           // per sample
  std::array<int, kBins> bin_counts_{};
  std::vector<Sums> bins_;  // kBins x labels
  std::vector<Sums> left_;  // per label
  std::vector<Sums> all_;   // per label
};

}  // namespace houghstream
