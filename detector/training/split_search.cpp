#include "detector/training/split_search.hpp"

#include <algorithm>
#include <cmath>

#include "detector/features/features.hpp"

namespace houghstream {

SplitSearch::SplitSearch(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings,
                         std::vector<float> label_weights, bool trusts_light)
    : set_(set),
      patch_(patch),
      settings_(settings),
      label_weights_(std::move(label_weights)),
      trusts_light_(trusts_light) {
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
  test.plane = static_cast<std::uint8_t>(random.below(set_.layout.planes()));
  const PlaneKind kind = set_.layout.kind(test.plane);
  // The scaled depth rules out what has the wrong size for its distance, which a difference cannot do.
  const double alone_share = kind == PlaneKind::kScaledDepth ? 0.5 : settings_.alone_share;
  if (kind == PlaneKind::kWrappedDepth) {
    test.kind = PixelTest::kWrapping;
  } else if ((trusts_light_ || kind != PlaneKind::kLight) && random.uniform() < alone_share) {
    test.kind = PixelTest::kAlone;
    test.dx2 = test.dx1;
    test.dy2 = test.dy1;
  }
  return test;
}

SplitSearch::Sums& SplitSearch::Sums::operator+=(const Sums& other) {
  weight += other.weight;
  x += other.x;
  y += other.y;
  z += other.z;
  return *this;
}

void SplitSearch::load_items(const std::vector<std::uint32_t>& samples) {
  items_.clear();
  std::fill(all_.begin(), all_.end(), Sums{});
  for (const std::uint32_t s : samples) {
    const TrainingSample& sample = set_.samples[s];
    const float w = label_weights_[sample.label];
    items_.push_back({{w, w * sample.offset.x(), w * sample.offset.y(), w * sample.offset.z()}, sample.label});
    all_[sample.label] += items_.back().sums;
  }
}

/// Sample by sample, so that a patch is in the cache for all tests; in blocks, so that the values, which are read test
/// by test, are not written one cache line each.
void SplitSearch::evaluate_tests(std::size_t test_count, const std::vector<std::uint32_t>& samples) {
  constexpr std::size_t kBlock = 32;
  const std::size_t count = samples.size();
  values_.resize(test_count * count);
  block_.resize(test_count * kBlock);
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, count - begin);
    for (std::size_t s = 0; s < size; ++s) {
      const TrainingSample& sample = set_.samples[samples[begin + s]];
      const PatchView patch =
          set_.pictures[static_cast<std::size_t>(sample.picture)].patch(sample.x, sample.y, sample.scale);
      for (std::size_t t = 0; t < test_count; ++t) {
        block_[s * test_count + t] = static_cast<std::int16_t>(test_value(tests_[t], patch));
      }
    }
    for (std::size_t t = 0; t < test_count; ++t) {
      std::int16_t* out = values_.data() + t * count + begin;
      for (std::size_t s = 0; s < size; ++s) out[s] = block_[s * test_count + t];
    }
  }
}

/// Information gain up to a constant: minus the weighted entropy of both sides.
float SplitSearch::class_gain() const {
  float left_sum = 0.0F;
  float right_sum = 0.0F;
  float gain = 0.0F;
  const auto term = [](float w) { return w > 0.0F ? w * std::log2(w) : 0.0F; };
  for (std::size_t l = 0; l < left_.size(); ++l) {
    const float right = all_[l].weight - left_[l].weight;
    gain += term(left_[l].weight) + term(right);
    left_sum += left_[l].weight;
    right_sum += right;
  }
  return gain - term(left_sum) - term(right_sum);
}

/// Reduction of the offsets' variance up to a constant, per class, background left out.
float SplitSearch::offset_gain() const {
  const auto term = [](float w, float x, float y, float z) { return w > 0.0F ? (x * x + y * y + z * z) / w : 0.0F; };
  float gain = 0.0F;
  for (std::size_t l = 1; l < left_.size(); ++l) {
    const Sums& a = left_[l];
    gain += term(a.weight, a.x, a.y, a.z);
    gain += term(all_[l].weight - a.weight, all_[l].x - a.x, all_[l].y - a.y, all_[l].z - a.z);
  }
  return gain;
}

bool SplitSearch::fill_bins(std::size_t t, Objective objective, int& first, int& range) {
  const std::size_t count = items_.size();
  const std::size_t labels = label_weights_.size();
  const std::int16_t* values = values_.data() + t * count;
  const auto [low, high] = std::minmax_element(values, values + count);
  first = *low;
  range = *high - first + 1;
  if (range < 2) return false;
  std::fill(bins_.begin(), bins_.end(), Sums{});
  bin_counts_.fill(0);
  const std::uint32_t scale = (static_cast<std::uint32_t>(kBins) << 16U) / static_cast<std::uint32_t>(range);
  for (std::size_t s = 0; s < count; ++s) {
    const std::size_t bin = (static_cast<std::uint32_t>(values[s] - first) * scale) >> 16U;
    const Item& item = items_[s];
    Sums& sums = bins_[bin * labels + item.label];
    if (objective == Objective::kClass) {
      sums.weight += item.sums.weight;
    } else {
      sums += item.sums;
    }
    ++bin_counts_[bin];
  }
  return true;
}

std::optional<SplitSearch::Split> SplitSearch::search_thresholds(std::size_t t, Objective objective, int min_side) {
  int first = 0;
  int range = 0;
  if (!fill_bins(t, objective, first, range)) return std::nullopt;
  const std::size_t labels = label_weights_.size();
  const std::uint32_t scale = (static_cast<std::uint32_t>(kBins) << 16U) / static_cast<std::uint32_t>(range);
  std::optional<Split> best;
  std::fill(left_.begin(), left_.end(), Sums{});
  int left_count = 0;
  for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
    if (bin_counts_[bin] == 0) continue;
    for (std::size_t l = 0; l < labels; ++l) left_[l] += bins_[bin * labels + l];
    left_count += bin_counts_[bin];
    if (left_count < min_side || static_cast<int>(items_.size()) - left_count < min_side) continue;
    const float gain = objective == Objective::kClass ? class_gain() : offset_gain();
    if (best && gain <= best->gain) continue;
    // the smallest value of the next bin: value * scale >> 16 > bin
    const std::uint32_t next = ((static_cast<std::uint32_t>(bin) + 1) << 16U) + scale - 1;
    best = Split{gain, first + static_cast<int>(next / scale)};
  }
  return best;
}

/// The best threshold of each of the first `test_count` tests, on `samples`; tests that split nothing are left out.
std::vector<SplitSearch::Judged> SplitSearch::judge_tests(std::size_t test_count,
                                                          const std::vector<std::uint32_t>& samples,
                                                          Objective objective, int min_side) {
  load_items(samples);
  evaluate_tests(test_count, samples);
  std::vector<Judged> judged;
  for (std::size_t t = 0; t < test_count; ++t) {
    const std::optional<Split> split = search_thresholds(t, objective, min_side);
    if (split) judged.push_back({split->gain, static_cast<std::uint32_t>(t), split->threshold});
  }
  // equal gains in the order of drawing, so that the order is the same everywhere
  std::sort(judged.begin(), judged.end(),
            [](const Judged& a, const Judged& b) { return a.gain != b.gain ? a.gain > b.gain : a.test < b.test; });
  return judged;
}

/// Every k-th sample, so that about `count` are left.
static std::vector<std::uint32_t> thinned(const std::vector<std::uint32_t>& samples, std::size_t count) {
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(samples[i * samples.size() / count]);
  return out;
}

std::optional<PixelTest> SplitSearch::best_test(const std::vector<std::uint32_t>& samples, Objective objective,
                                                Random& random) {
  // Few samples are told apart by few tests; trying more would only fit their noise.
  std::size_t test_count = std::min(tests_.size(), std::max<std::size_t>(64, 2 * samples.size()));
  for (std::size_t t = 0; t < test_count; ++t) tests_[t] = random_test(random);
  if (samples.size() >= 2 * kFirstLook && test_count > kFinalists) {
    const std::vector<Judged> first = judge_tests(test_count, thinned(samples, kFirstLook), objective, 2);
    test_count = std::min(first.size(), kFinalists);
    std::vector<PixelTest> finalists;
    for (std::size_t i = 0; i < test_count; ++i) finalists.push_back(tests_[first[i].test]);
    std::copy(finalists.begin(), finalists.end(), tests_.begin());
  }
  const std::vector<Judged> judged = judge_tests(test_count, samples, objective, kMinSide);
  if (judged.empty()) return std::nullopt;
  PixelTest best = tests_[judged.front().test];
  best.threshold = static_cast<std::int16_t>(judged.front().threshold);
  return best;
}

}  // namespace houghstream
