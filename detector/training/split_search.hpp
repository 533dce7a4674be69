#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "detector/training/augmentation/training_set.hpp"
#include "detector/training/training_settings.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream::training {

/// Objective of a node's test (Gall et al. 2011, Section 3.2): pure classes or agreeing offsets.
enum class Objective { kClass, kOffset };

/// Finds the best of many random tests for a node. They look at few pixels of a patch, drawn anew for every node, so
/// that a patch costs few cache misses. All tests are judged on a few of the samples, the best of
/// them on all (successive halving, Jamieson & Talwalkar 2016): a tenth of the work at nearly the same gain. Holds
/// scratch memory; one per thread.
class SplitSearch {
 public:
  SplitSearch(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings,
              std::vector<float> label_weights, bool allow_single_pixel_intensity);

  /// Returns the best test for these samples, or nothing where none leaves at least kMinSide samples on both sides.
  std::optional<PixelTest> best_test(const std::vector<std::uint32_t>& samples, Objective objective, Random& random);

  static constexpr int kMinSide = 10;
  static constexpr int kBins = 16;
  static constexpr std::size_t kPrescreenSamples = 128;  ///< samples on which all tests are judged
  static constexpr int kPlaces = 64;                     ///< pixels of a patch among which a node's tests choose
  static constexpr std::size_t kFinalists = 64;          ///< tests that are judged on all samples

 private:
  /// Weighted sums of some samples of one label: of 1 and of the offset's coordinates.
  struct alignas(16) Sums {
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

  struct Judged {
    float gain = 0.0F;
    std::uint32_t test = 0;
    int threshold = 0;
  };
  /// Place that tests of the current node may read.
  struct Place {
    std::int8_t dx = 0;
    std::int8_t dy = 0;
  };
  struct PlacePair {
    std::uint8_t first = 0;  // index into places_
    std::uint8_t second = 0;
  };
  /// A PixelTest as evaluate_tests wants it.
  struct Prepared {
    std::uint16_t first = 0;  // index into pixels_
    std::uint16_t second = 0;
    std::uint16_t shift = 0;
    std::uint16_t mask = 0;  // mask of the second pixel
  };

  using Planes = std::vector<std::uint8_t>;
  /// Draws the planes of a node's tests: the point histograms or all others, where there are both.
  const Planes& draw_planes(Random& random) const;
  void draw_tests(std::size_t test_count, Random& random);
  /// Returns the fraction of the tests on a plane of this kind that read a single pixel, see TrainingSettings.
  double single_pixel_fraction(PlaneKind kind) const;
  PixelTest random_test(const Planes& planes, PlacePair& pair, Random& random) const;
  void prepare_tests(std::size_t test_count, int pixel_stride);
  void load_pixels(const CutoutPatch& patch, const CutoutPatch& next);
  void keep_finalists(const std::vector<Judged>& judged, std::size_t count);
  void load_items(const std::vector<std::uint32_t>& samples);
  void evaluate_tests(std::size_t test_count, const std::vector<std::uint32_t>& samples);
  /// Sorts the samples into kBins bins by the value of test t; false where all values are equal.
  bool fill_bins(std::size_t t, Objective objective, int& first, int& range);
  std::vector<Judged> judge_tests(std::size_t test_count, const std::vector<std::uint32_t>& samples,
                                  Objective objective, int min_side);
  /// Returns the best threshold of test t that leaves at least `min_side` samples on both sides.
  std::optional<Split> search_thresholds(std::size_t t, Objective objective, int min_side);
  float class_gain() const;
  float offset_gain() const;

  const TrainingSet& set_;
  const PatchSettings& patch_;
  const TrainingSettings& settings_;
  std::vector<float> label_weights_;
  Planes histograms_;
  Planes others_;
  bool allow_single_pixel_intensity_;  // true where a single pixel's lightness and colour may decide
  std::vector<PixelTest> tests_;
  std::vector<Prepared> prepared_;
  std::vector<PlacePair> drawn_;  // per test
  std::array<Place, kPlaces> places_{};
  std::vector<std::uint8_t> pixels_;  // pixels of one patch, place by place
  std::vector<std::int16_t> values_;  // tests x samples
  std::vector<std::int16_t> block_;   // some samples x tests
  std::vector<Item> items_;           // per sample
  std::array<int, kBins> bin_counts_{};
  std::vector<int> label_counts_;  // kBins x labels
  std::vector<Sums> bins_;         // kBins x labels
  std::vector<Sums> left_;         // per label
  std::vector<Sums> all_;          // per label
};

}  // namespace houghstream::training
