#include "pose/following/colour_statistics.hpp"

namespace houghstream {
namespace {

constexpr std::size_t kColourBins = 4096;

void move_histogram(const std::vector<std::size_t>& bins, float rate, std::vector<float>& histogram) {
  if (bins.empty()) return;
  for (float& value : histogram) value *= 1.0F - rate;
  const float each = rate / static_cast<float>(bins.size());
  for (const std::size_t bin : bins) histogram[bin] += each;
}

}  // namespace

ColourStatistics::ColourStatistics() : on_(kColourBins, 0.0F), beside_(kColourBins, 0.0F), ratio_(kColourBins, 0.5F) {}

void ColourStatistics::learn(const std::vector<cv::Vec3b>& on, const std::vector<cv::Vec3b>& beside, double rate) {
  // Fraction of the pixels that is too small to tell anything; it keeps the ratio off 0 and 1.
  constexpr float kRare = 1e-4F;
  const auto bins_of = [](const std::vector<cv::Vec3b>& colours) {
    std::vector<std::size_t> bins;
    bins.reserve(colours.size());
    for (const cv::Vec3b& colour : colours) bins.push_back(bin_of(colour));
    return bins;
  };
  if (on.empty() && beside.empty()) return;
  const float used = empty_ ? 1.0F : static_cast<float>(rate);
  move_histogram(bins_of(on), used, on_);
  move_histogram(bins_of(beside), used, beside_);
  for (std::size_t i = 0; i < kColourBins; ++i) ratio_[i] = (on_[i] + kRare) / (on_[i] + beside_[i] + 2.0F * kRare);
  empty_ = false;
}

}  // namespace houghstream
