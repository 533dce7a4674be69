#include "detector/training/augmentation/patch_cover.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace houghstream::training {
namespace {

cv::Rect seen_by(const TrainingSample& sample, const PatchSettings& patch) {
  const int reach = max_offset(patch, sample.scale);
  return {sample.x - reach, sample.y - reach, 2 * reach + 1, 2 * reach + 1};
}

cv::Range joined(const cv::Range& a, const cv::Range& b) {
  return {std::min(a.start, b.start), std::max(a.end, b.end)};
}

/// A part of the image that patches read.
struct Part {
  RowSpans spans;
  cv::Rect box;

  const cv::Range& row(int y) const { return spans.columns[static_cast<std::size_t>(y - spans.top)]; }
};

/// Returns how many pixels fewer there are where two parts become one, which then has the gaps between their rows too.
int pixels_saved(const Part& a, const Part& b) {
  if ((a.box & b.box).empty()) return 0;
  int saved = 0;
  for (int y = std::max(a.spans.top, b.spans.top); y < std::min(a.spans.bottom(), b.spans.bottom()); ++y)
    saved += a.row(y).size() + b.row(y).size() - joined(a.row(y), b.row(y)).size();
  return saved;
}

/// Returns one part of two whose boxes overlap: every row then has a pixel of one of them.
Part merged(const Part& a, const Part& b) {
  Part out;
  out.box = a.box | b.box;
  out.spans.top = out.box.y;
  for (int y = out.box.y; y < out.box.y + out.box.height; ++y) {
    const bool in_a = y >= a.spans.top && y < a.spans.bottom();
    const bool in_b = y >= b.spans.top && y < b.spans.bottom();
    out.spans.columns.push_back(in_a && in_b ? joined(a.row(y), b.row(y)) : (in_a ? a : b).row(y));
  }
  return out;
}

/// Merges a part with those by which pixels are saved, those that save most first, and appends what comes of it.
void add_part(Part part, std::vector<Part>& parts) {
  while (true) {
    int most = 0;
    std::size_t best = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const int saved = pixels_saved(parts[i], part);
      if (saved <= most) continue;
      most = saved;
      best = i;
    }
    if (most == 0) break;
    part = merged(parts[best], part);
    parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(best));
  }
  parts.push_back(std::move(part));
}

template <typename Image>
std::vector<Cutout> cut_out(const Image& image, const PatchSettings& patch, std::int32_t first,
                            const std::vector<TrainingSample*>& readers) {
  std::vector<cv::Rect> seen;
  seen.reserve(readers.size());
  for (const TrainingSample* reader : readers) seen.push_back(seen_by(*reader, patch));
  std::vector<RowSpans> cover = cover_patches(seen);
  for (std::size_t i = 0; i < readers.size(); ++i) {
    const auto holds = [&](const RowSpans& part) { return contains(part, seen[i]); };
    readers[i]->cutout =
        first + static_cast<std::int32_t>(std::find_if(cover.begin(), cover.end(), holds) - cover.begin());
  }
  std::vector<Cutout> cutouts;
  cutouts.reserve(cover.size());
  for (RowSpans& part : cover) cutouts.emplace_back(image, std::move(part));
  return cutouts;
}

}  // namespace

std::vector<RowSpans> cover_patches(const std::vector<cv::Rect>& seen) {
  std::vector<Part> parts;
  for (const cv::Rect& rect : seen) add_part({spans_of(rect), rect}, parts);
  std::vector<RowSpans> cover;
  cover.reserve(parts.size());
  for (Part& part : parts) cover.push_back(std::move(part.spans));
  return cover;
}

std::vector<Cutout> cut_out_patches(const FeatureImage& image, const PatchSettings& patch, std::int32_t first,
                                    const std::vector<TrainingSample*>& readers) {
  return cut_out(image, patch, first, readers);
}

std::vector<Cutout> cut_out_patches(const Cutout& image, const PatchSettings& patch, std::int32_t first,
                                    const std::vector<TrainingSample*>& readers) {
  return cut_out(image, patch, first, readers);
}

}  // namespace houghstream::training
