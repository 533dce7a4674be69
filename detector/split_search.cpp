#include "detector/split_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "detector/features.hpp"

namespace houghstream {

SplitSearch::SplitSearch(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings,
                         std::vector<float> label_weights)
    : set_(set), patch_(patch), settings_(settings), label_weights_(std::move(label_weights)) {
  tests_.resize(static_cast<std::size_t>(settings.tests_per_node));
  bins_.resize(kBins * label_weights_.size());
  left_.resize(label_weights_.size());
  all_.resize(label_weights_.size());
}

PixelTest SplitSearch::random_test(Random& random) const {
  PixelTest test;
  const auto coordinate = [&] { return static_cast<std::int8_t>(random.between(-patch_.radius, patch_.radius)); };
  test.dx1 = coordinate();
  test.dy1 = coordinate();
  test.dx2 = coordinate();
  test.dy2 = coordinate();
  test.plane = static_cast<std::uint8_t>(random.below(FeatureLayout::kPlanes));
  test.wrap_shift = FeatureLayout::wraps(test.plane) ? 24 : 0;
  return test;
}

/// Sample by sample, so that a patch is in the cache for all tests.
void SplitSearch::evaluate_tests(const std::vector<std::uint32_t>& samples) {
  const std::size_t count = samples.size();
  values_.resize(tests_.size() * count);
  for (std::size_t s = 0; s < count; ++s) {
    const TrainingSample& sample = set_.samples[samples[s]];
    const FeatureImage& picture = set_.pictures[static_cast<std::size_t>(sample.picture)];
    const std::uint8_t* centre = picture.at(sample.x, sample.y);
    const int stride = picture.row_stride();
    for (std::size_t t = 0; t < tests_.size(); ++t) {
      values_[t * count + s] = static_cast<std::int16_t>(test_value(tests_[t], centre, sample.scale, stride));
    }
  }
}

/// Information gain up to a constant: minus the weighted entropy of both sides.
float SplitSearch::class_gain(const std::vector<BinSums>& left, const std::vector<BinSums>& all) const {
  float left_sum = 0.0F;
  float right_sum = 0.0F;
  float gain = 0.0F;
  const auto term = [](float w) { return w > 0.0F ? w * std::log2(w) : 0.0F; };
  for (std::size_t l = 0; l < left.size(); ++l) {
    const float right = all[l].weight - left[l].weight;
    gain += term(left[l].weight) + term(right);
    left_sum += left[l].weight;
    right_sum += right;
  }
  return gain - term(left_sum) - term(right_sum);
}

/// Reduction of the offsets' variance up to a constant, per class, background left out.
float SplitSearch::offset_gain(const std::vector<BinSums>& left, const std::vector<BinSums>& all) const {
  const auto term = [](float w, float x, float y, float z) { return w > 0.0F ? (x * x + y * y + z * z) / w : 0.0F; };
  float gain = 0.0F;
  for (std::size_t l = 1; l < left.size(); ++l) {
    const BinSums& a = left[l];
    gain += term(a.weight, a.x, a.y, a.z);
    gain += term(all[l].weight - a.weight, all[l].x - a.x, all[l].y - a.y, all[l].z - a.z);
  }
  return gain;
}

void SplitSearch::search_thresholds(std::size_t t, const std::vector<std::uint32_t>& samples, Objective objective,
                                    float& gain, int& threshold) {
  const std::size_t count = samples.size();
  const std::size_t labels = label_weights_.size();
  const std::int16_t* values = values_.data() + t * count;
  const auto [low, high] = std::minmax_element(values, values + count);
  const int first = *low;
  const int range = *high - first + 1;
  if (range < 2) return;
  std::fill(bins_.begin(), bins_.end(), BinSums{});
  std::array<int, kBins> bin_counts{};
  for (std::size_t s = 0; s < count; ++s) {
    const auto bin = static_cast<std::size_t>((values[s] - first) * kBins / range);
    const TrainingSample& sample = set_.samples[samples[s]];
    BinSums& sums = bins_[bin * labels + sample.label];
    const float w = label_weights_[sample.label];
    sums.weight += w;
    sums.x += w * sample.offset.x();
    sums.y += w * sample.offset.y();
    sums.z += w * sample.offset.z();
    ++bin_counts[bin];
  }
  std::fill(left_.begin(), left_.end(), BinSums{});
  int left_count = 0;
  for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
    for (std::size_t l = 0; l < labels; ++l) {
      const BinSums& sums = bins_[bin * labels + l];
      left_[l].weight += sums.weight;
      left_[l].x += sums.x;
      left_[l].y += sums.y;
      left_[l].z += sums.z;
    }
    left_count += bin_counts[bin];
    const int right_count = static_cast<int>(count) - left_count;
    if (bin_counts[bin] == 0 || left_count < kMinSide || right_count < kMinSide) continue;
    const float g = objective == Objective::kClass ? class_gain(left_, all_) : offset_gain(left_, all_);
    if (g > gain) {
      gain = g;
      // smallest value of the next bin: (value - first) * kBins / range >= bin + 1
      threshold = first + ((static_cast<int>(bin) + 1) * range + kBins - 1) / kBins;
    }
  }
}

std::optional<PixelTest> SplitSearch::best_test(const std::vector<std::uint32_t>& samples, Objective objective,
                                                Random& random) {
  for (PixelTest& test : tests_) test = random_test(random);
  evaluate_tests(samples);
  std::fill(all_.begin(), all_.end(), BinSums{});
  for (const std::uint32_t s : samples) {
    const TrainingSample& sample = set_.samples[s];
    const float w = label_weights_[sample.label];
    BinSums& sums = all_[sample.label];
    sums.weight += w;
    sums.x += w * sample.offset.x();
    sums.y += w * sample.offset.y();
    sums.z += w * sample.offset.z();
  }
  float best_gain = -std::numeric_limits<float>::infinity();
  std::optional<PixelTest> best;
  for (std::size_t t = 0; t < tests_.size(); ++t) {
    float gain = best_gain;
    int threshold = 0;
    search_thresholds(t, samples, objective, gain, threshold);
    if (gain > best_gain) {
      best_gain = gain;
      best = tests_[t];
      best->threshold = static_cast<std::int16_t>(threshold);
    }
  }
  return best;
}

}  // namespace houghstream
