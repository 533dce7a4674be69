#include "detector/training/split_search.hpp"

#include <algorithm>
#include <cstring>

#include "detector/features/features.hpp"

namespace houghstream::training {

SplitSearch::SplitSearch(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings,
                         std::vector<float> label_weights, bool allow_single_pixel_intensity)
    : set_(set),
      patch_(patch),
      settings_(settings),
      label_weights_(std::move(label_weights)),
      allow_single_pixel_intensity_(allow_single_pixel_intensity) {
  for (int plane = 0; plane < set.layout.planes(); ++plane) {
    const bool is_histogram = set.layout.kind(plane) == PlaneKind::kHistogram;
    (is_histogram ? histogram_planes_ : pixel_planes_).push_back(static_cast<std::uint8_t>(plane));
  }
  tests_.resize(static_cast<std::size_t>(settings.tests_per_node));
  bins_.resize(kBins * label_weights_.size());
  label_counts_.resize(bins_.size());
  left_.resize(label_weights_.size());
  total_.resize(label_weights_.size());
}

const SplitSearch::Planes& SplitSearch::draw_planes(Random& random) const {
  if (histogram_planes_.empty()) return pixel_planes_;
  if (pixel_planes_.empty()) return histogram_planes_;
  return random.uniform() < settings_.histogram_fraction ? histogram_planes_ : pixel_planes_;
}

void SplitSearch::draw_tests(std::size_t test_count, Random& random) {
  const auto coordinate = [&] { return static_cast<std::int8_t>(random.between(-patch_.radius, patch_.radius)); };
  for (PatchPixel& pixel : patch_pixels_) pixel = {coordinate(), coordinate()};
  const Planes& planes = draw_planes(random);
  pixel_pairs_.resize(test_count);
  for (std::size_t t = 0; t < test_count; ++t) {
    pixel_pairs_[t].first = static_cast<std::uint8_t>(random.below(kPatchPixels));
    pixel_pairs_[t].second = static_cast<std::uint8_t>(random.below(kPatchPixels));
    tests_[t] = random_test(planes, pixel_pairs_[t], random);
  }
}

double SplitSearch::single_pixel_fraction(PlaneKind kind) const {
  const double of_shape = std::max(settings_.single_pixel_fraction, settings_.shape_single_pixel_fraction);
  if (kind == PlaneKind::kSurface) return of_shape;
  // The scaled depth rules out what has the wrong size for its distance, which a difference cannot do.
  return kind == PlaneKind::kScaledDepth ? std::max(of_shape, 0.5) : settings_.single_pixel_fraction;
}

PixelTest SplitSearch::random_test(const Planes& planes, PixelPair& pair, Random& random) const {
  PixelTest test;
  test.plane = planes[static_cast<std::size_t>(random.below(static_cast<int>(planes.size())))];
  const PlaneKind kind = set_.layout.kind(test.plane);
  if (kind == PlaneKind::kWrappedDepth) {
    test.kind = PixelTest::kWrapping;
  } else if ((allow_single_pixel_intensity_ || kind != PlaneKind::kIntensity) &&
             random.uniform() < single_pixel_fraction(kind)) {
    test.kind = PixelTest::kSinglePixel;
    pair.second = pair.first;
  }
  test.dx1 = patch_pixels_[pair.first].dx;
  test.dy1 = patch_pixels_[pair.first].dy;
  test.dx2 = patch_pixels_[pair.second].dx;
  test.dy2 = patch_pixels_[pair.second].dy;
  return test;
}

SplitSearch::Sums& SplitSearch::Sums::operator+=(const Sums& other) {
  weight += other.weight;
  x += other.x;
  y += other.y;
  z += other.z;
  return *this;
}

void SplitSearch::load_sample_sums(const std::vector<std::uint32_t>& samples) {
  sample_sums_.clear();
  std::fill(total_.begin(), total_.end(), Sums{});
  for (const std::uint32_t s : samples) {
    const TrainingSample& sample = set_.samples[s];
    const float w = label_weights_[sample.label];
    sample_sums_.push_back({{w, w * sample.offset.x(), w * sample.offset.y(), w * sample.offset.z()}, sample.label});
    total_[sample.label] += sample_sums_.back().sums;
  }
}

void SplitSearch::prepare_tests(std::size_t test_count, int pixel_stride) {
  prepared_.resize(test_count);
  for (std::size_t t = 0; t < test_count; ++t) {
    const PixelTest& test = tests_[t];
    prepared_[t] = {static_cast<std::uint16_t>(pixel_pairs_[t].first * pixel_stride + test.plane),
                    static_cast<std::uint16_t>(pixel_pairs_[t].second * pixel_stride + test.plane),
                    static_cast<std::uint16_t>(test.kind & 31), static_cast<std::uint16_t>((test.kind >> 7) - 1)};
  }
}

/// Copies the values of the node's pixels side by side. Patches are far apart in memory, so that the next one is
/// prefetched meanwhile.
void SplitSearch::load_pixels(const CutoutPatch& patch, const CutoutPatch& next) {
  const auto stride = static_cast<std::size_t>(patch.pixel_stride);
  pixels_.resize(kPatchPixels * stride);
  for (std::size_t i = 0; i < kPatchPixels; ++i) {
    __builtin_prefetch(next.at(patch_pixels_[i].dx, patch_pixels_[i].dy));
    std::memcpy(pixels_.data() + i * stride, patch.at(patch_pixels_[i].dx, patch_pixels_[i].dy), stride);
  }
}

/// Evaluates the tests sample by sample, in blocks, so that the values, which are read test by test, are not written
/// one cache line each. The values are those of test_value.
void SplitSearch::evaluate_tests(std::size_t test_count, const std::vector<std::uint32_t>& samples) {
  constexpr std::size_t kBlock = 32;
  const std::size_t count = samples.size();
  values_.resize(test_count * count);
  block_.resize(test_count * kBlock);
  const auto patch_of = [&](std::size_t s) { return set_.patch(set_.samples[samples[s]]); };
  prepare_tests(test_count, patch_of(0).pixel_stride);
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t size = std::min(kBlock, count - begin);
    for (std::size_t s = 0; s < size; ++s) {
      load_pixels(patch_of(begin + s), patch_of(std::min(begin + s + 1, count - 1)));
      std::int16_t* out = block_.data() + s * test_count;
      for (std::size_t t = 0; t < test_count; ++t) {
        const PreparedTest& test = prepared_[t];
        const int difference = pixels_[test.first] - (pixels_[test.second] & test.mask);
        out[t] = static_cast<std::int16_t>(
            static_cast<std::int32_t>(static_cast<std::uint32_t>(difference) << test.shift) >> test.shift);
      }
    }
    for (std::size_t t = 0; t < test_count; ++t) {
      std::int16_t* out = values_.data() + t * count + begin;
      for (std::size_t s = 0; s < size; ++s) out[s] = block_[s * test_count + t];
    }
  }
}

/// Returns the reduction of the Gini impurity up to a constant (Breiman et al. 1984); it orders tests as the entropy
/// does and needs no logarithms.
float SplitSearch::class_gain() const {
  float left_sum = 0.0F;
  float right_sum = 0.0F;
  float left_sq = 0.0F;
  float right_sq = 0.0F;
  for (std::size_t l = 0; l < left_.size(); ++l) {
    const float left = left_[l].weight;
    const float right = total_[l].weight - left;
    left_sum += left;
    right_sum += right;
    left_sq += left * left;
    right_sq += right * right;
  }
  return (left_sum > 0.0F ? left_sq / left_sum : 0.0F) + (right_sum > 0.0F ? right_sq / right_sum : 0.0F);
}

/// Returns the reduction of the offsets' variance up to a constant, per class, background left out.
float SplitSearch::offset_gain() const {
  const auto term = [](float w, float x, float y, float z) { return w > 0.0F ? (x * x + y * y + z * z) / w : 0.0F; };
  float gain = 0.0F;
  for (std::size_t l = 1; l < left_.size(); ++l) {
    const Sums& a = left_[l];
    gain += term(a.weight, a.x, a.y, a.z);
    gain += term(total_[l].weight - a.weight, total_[l].x - a.x, total_[l].y - a.y, total_[l].z - a.z);
  }
  return gain;
}

bool SplitSearch::fill_bins(std::size_t t, Objective objective, int& first, int& range) {
  const std::size_t count = sample_sums_.size();
  const std::size_t labels = label_weights_.size();
  const std::int16_t* values = values_.data() + t * count;
  std::int16_t low = values[0];
  std::int16_t high = values[0];
  for (std::size_t s = 1; s < count; ++s) {
    low = std::min(low, values[s]);
    high = std::max(high, values[s]);
  }
  first = low;
  range = high - low + 1;
  if (range < 2) return false;
  const std::uint32_t scale = (static_cast<std::uint32_t>(kBins) << 16U) / static_cast<std::uint32_t>(range);
  std::fill(label_counts_.begin(), label_counts_.end(), 0);
  const bool needs_offsets = objective == Objective::kOffset;
  if (needs_offsets) std::fill(bins_.begin(), bins_.end(), Sums{});
  for (std::size_t s = 0; s < count; ++s) {
    const std::size_t bin = (static_cast<std::uint32_t>(values[s] - low) * scale) >> 16U;
    const std::size_t label_bin = bin * labels + sample_sums_[s].label;
    ++label_counts_[label_bin];
    if (needs_offsets) bins_[label_bin] += sample_sums_[s].sums;
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    bin_counts_[bin] = 0;
    for (std::size_t l = 0; l < labels; ++l) {
      const int n = label_counts_[bin * labels + l];
      bin_counts_[bin] += n;
      if (!needs_offsets) bins_[bin * labels + l].weight = label_weights_[l] * static_cast<float>(n);
    }
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
    if (objective == Objective::kClass) {
      for (std::size_t l = 0; l < labels; ++l) left_[l].weight += bins_[bin * labels + l].weight;
    } else {
      for (std::size_t l = 0; l < labels; ++l) left_[l] += bins_[bin * labels + l];
    }
    left_count += bin_counts_[bin];
    if (left_count < min_side || static_cast<int>(sample_sums_.size()) - left_count < min_side) continue;
    const float gain = objective == Objective::kClass ? class_gain() : offset_gain();
    if (best && gain <= best->gain) continue;
    // the smallest value of the next bin: value * scale >> 16 > bin
    const std::uint32_t next = ((static_cast<std::uint32_t>(bin) + 1) << 16U) + scale - 1;
    best = Split{gain, first + static_cast<int>(next / scale)};
  }
  return best;
}

/// Returns the best threshold of each of the first `test_count` tests, on `samples`; tests that split nothing are left
/// out.
std::vector<SplitSearch::ScoredTest> SplitSearch::score_tests(std::size_t test_count,
                                                              const std::vector<std::uint32_t>& samples,
                                                              Objective objective, int min_side) {
  load_sample_sums(samples);
  evaluate_tests(test_count, samples);
  std::vector<ScoredTest> scored;
  for (std::size_t t = 0; t < test_count; ++t) {
    const std::optional<Split> split = search_thresholds(t, objective, min_side);
    if (split) scored.push_back({split->gain, static_cast<std::uint32_t>(t), split->threshold});
  }
  // equal gains in the order of drawing, so that the order is the same everywhere
  std::sort(scored.begin(), scored.end(), [](const ScoredTest& a, const ScoredTest& b) {
    return a.gain != b.gain ? a.gain > b.gain : a.test < b.test;
  });
  return scored;
}

/// Returns every k-th sample, so that about `count` are left.
static std::vector<std::uint32_t> thin_out(const std::vector<std::uint32_t>& samples, std::size_t count) {
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(samples[i * samples.size() / count]);
  return out;
}

/// Moves the best tests to the front.
void SplitSearch::select_finalists(const std::vector<ScoredTest>& scored, std::size_t count) {
  std::vector<PixelTest> tests;
  std::vector<PixelPair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    tests.push_back(tests_[scored[i].test]);
    pairs.push_back(pixel_pairs_[scored[i].test]);
  }
  std::copy(tests.begin(), tests.end(), tests_.begin());
  std::copy(pairs.begin(), pairs.end(), pixel_pairs_.begin());
}

std::optional<PixelTest> SplitSearch::best_test(const std::vector<std::uint32_t>& samples, Objective objective,
                                                Random& random) {
  // A few tests separate a few samples; more would only fit their noise.
  std::size_t test_count = std::min(tests_.size(), std::max<std::size_t>(64, samples.size()));
  draw_tests(test_count, random);
  if (samples.size() >= 2 * kPrescreenSamples && test_count > kFinalists) {
    const std::vector<ScoredTest> first = score_tests(test_count, thin_out(samples, kPrescreenSamples), objective, 2);
    test_count = std::min(first.size(), kFinalists);
    select_finalists(first, test_count);
  }
  const std::vector<ScoredTest> scored = score_tests(test_count, samples, objective, kMinSide);
  if (scored.empty()) return std::nullopt;
  PixelTest best = tests_[scored.front().test];
  best.threshold = static_cast<std::int16_t>(scored.front().threshold);
  return best;
}

}  // namespace houghstream::training
