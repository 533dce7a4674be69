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

/// Finds the best of many random tests for a node. They read few pixels of a patch, which are drawn for every node, so
/// that a patch costs few cache misses. All tests are scored on a few of the samples, the best of
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
  static constexpr std::size_t kPrescreenSamples = 128;  ///< samples on which all tests are scored
  static constexpr int kPatchPixels = 64;        ///< number of pixels of a patch from which a node's tests are drawn
  static constexpr std::size_t kFinalists = 64;  ///< tests that are scored on all samples

 private:
  /// Weighted sums of some samples of one label: of 1 and of the offset's coordinates.
  struct alignas(16) Sums {
    float weight = 0.0F;
    float x = 0.0F;
    float y = 0.0F;
    float z = 0.0F;
    Sums& operator+=(const Sums& other);
  };
  /// The sums of a single sample with its label, in the order of the samples.
  struct LabelledSums {
    Sums sums;
    std::uint32_t label = 0;
  };
  struct Split {
    float gain = 0.0F;
    int threshold = 0;
  };

  struct ScoredTest {
    float gain = 0.0F;
    std::uint32_t test = 0;
    int threshold = 0;
  };
  /// A pixel that tests of the current node may read, relative to the patch's centre.
  struct PatchPixel {
    std::int8_t dx = 0;
    std::int8_t dy = 0;
  };
  struct PixelPair {
    std::uint8_t first = 0;  // index into patch_pixels_
    std::uint8_t second = 0;
  };
  /// A PixelTest in the form for evaluate_tests().
  struct PreparedTest {
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
  PixelTest random_test(const Planes& planes, PixelPair& pair, Random& random) const;
  void prepare_tests(std::size_t test_count, int pixel_stride);
  void load_pixels(const CutoutPatch& patch, const CutoutPatch& next);
  void select_finalists(const std::vector<ScoredTest>& scored, std::size_t count);
  void load_sample_sums(const std::vector<std::uint32_t>& samples);
  void evaluate_tests(std::size_t test_count, const std::vector<std::uint32_t>& samples);
  /// Sorts the samples into kBins bins by the value of test t; false where all values are equal.
  bool fill_bins(std::size_t t, Objective objective, int& first, int& range);
  std::vector<ScoredTest> score_tests(std::size_t test_count, const std::vector<std::uint32_t>& samples,
                                      Objective objective, int min_side);
  /// Returns the best threshold of test t that leaves at least `min_side` samples on both sides.
  std::optional<Split> search_thresholds(std::size_t t, Objective objective, int min_side);
  float class_gain() const;
  float offset_gain() const;

  const TrainingSet& set_;
  const PatchSettings& patch_;
  const TrainingSettings& settings_;
  std::vector<float> label_weights_;
  Planes histogram_planes_;
  Planes pixel_planes_;
  bool allow_single_pixel_intensity_;  // true where a single pixel's lightness and colour may decide
  std::vector<PixelTest> tests_;
  std::vector<PreparedTest> prepared_;
  std::vector<PixelPair> pixel_pairs_;  // per test
  std::array<PatchPixel, kPatchPixels> patch_pixels_{};
  std::vector<std::uint8_t> pixels_;       // values of one patch, pixel by pixel
  std::vector<std::int16_t> values_;       // tests x samples
  std::vector<std::int16_t> block_;        // some samples x tests
  std::vector<LabelledSums> sample_sums_;  // per sample
  std::array<int, kBins> bin_counts_{};
  std::vector<int> label_counts_;  // kBins x labels
  std::vector<Sums> bins_;         // kBins x labels
  std::vector<Sums> left_;         // per label
  std::vector<Sums> total_;        // per label
};

}  // namespace houghstream::training
