#include "detector/scale_space_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/features/features.hpp"
#include "detector/hypotheses.hpp"
#include "detector/voting.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

/// One size of the frame, classified.
struct SeenLevel {
  PatchGrid grid;  // without points and areas, which need depth
  PatchLeaves leaves;
  Camera camera;               // of the level's image
  float px_per_offset = 0.0F;  // level pixels per unit of a leaf's offset, see ScaleHandling::kScaleSpace
  float size_ratio = 1.0F;
};

SeenLevel see_level(const Forest& forest, const RgbdFrame& frame, const FeatureLevel& level,
                    const DetectionSettings& settings, StageClock& clock) {
  const WorkingFrame working = make_working_frame(frame, level, forest.features);
  clock.mark("detect.resize");
  std::vector<FeatureImage> features;
  features.push_back(compute_features(working, forest.features, settings.threads));
  clock.mark("detect.features");
  SeenLevel seen;
  seen.camera = working.camera;
  seen.size_ratio = level.size_ratio;
  seen.px_per_offset = static_cast<float>(frame.camera.fx) * forest.features.image_scale;
  add_patches_everywhere(working, level, forest.patch, settings.stride, seen.grid);
  seen.leaves.leaves = settings.readable ? assign_leaves_readably(forest, features, seen.grid)
                                         : assign_leaves(forest, features, seen.grid, settings.threads);
  seen.leaves.probabilities = class_probabilities(forest, seen.leaves.leaves, settings.threads);
  clock.mark("detect.forest");
  return seen;
}

/// Calls visit(x, y, weight) for each vote of a patch for a class, in level pixels.
template <typename Visit>
void for_votes_of(const Forest& forest, int class_index, const SeenLevel& seen, std::size_t patch, const Visit& visit) {
  const std::size_t trees = forest.roots.size();
  const float share = 1.0F / static_cast<float>(trees);
  for (std::size_t tree = 0; tree < trees; ++tree) {
    const auto leaf = static_cast<std::size_t>(seen.leaves.leaves[patch * trees + tree]);
    for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
      const LeafClass& entry = forest.leaf_classes[e];
      if (entry.class_index != class_index) continue;
      for (std::uint32_t v = entry.first_vote; v < entry.first_vote + entry.vote_count; ++v) {
        const LeafVote& vote = forest.votes[v];
        visit(static_cast<float>(seen.grid.x[patch]) + vote.offset.x() * seen.px_per_offset,
              static_cast<float>(seen.grid.y[patch]) + vote.offset.y() * seen.px_per_offset,
              entry.probability * vote.weight * share, entry);
      }
    }
  }
}

bool believes(const Forest& forest, int class_index, const SeenLevel& seen, std::size_t patch, float least) {
  const std::size_t belief = patch * forest.classes.size() + static_cast<std::size_t>(class_index);
  return seen.leaves.probabilities[belief] >= least;
}

/// Vote mass per pixel over the class's expected mass.
cv::Mat hough_image(const Forest& forest, int class_index, const SeenLevel& seen, const DetectionSettings& settings) {
  cv::Mat image = cv::Mat::zeros(seen.camera.height, seen.camera.width, CV_32FC1);
  for (std::size_t p = 0; p < seen.grid.size(); ++p) {
    if (!believes(forest, class_index, seen, p, settings.min_class_share)) continue;
    for_votes_of(forest, class_index, seen, p, [&](float x, float y, float weight, const LeafClass&) {
      const int column = static_cast<int>(std::lround(x));
      const int row = static_cast<int>(std::lround(y));
      if (column >= 0 && row >= 0 && column < image.cols && row < image.rows) image.at<float>(row, column) += weight;
    });
  }
  const double sigma = static_cast<double>(settings.vote_sigma) * seen.px_per_offset;
  cv::GaussianBlur(image, image, cv::Size(0, 0), sigma, sigma, cv::BORDER_CONSTANT);
  const double patch_side = settings.stride / static_cast<double>(seen.px_per_offset);
  const double kernel_sum = 2.0 * M_PI * sigma * sigma;  // a vote at the centre counts as 1
  const float expected = forest.classes[static_cast<std::size_t>(class_index)].expected_mass;
  return image * (kernel_sum * patch_side * patch_side / expected);
}

/// Local maxima, strongest first.
std::vector<cv::Point> maxima_of(const cv::Mat& image, int reach_px, float least, std::size_t limit) {
  cv::Mat around;
  cv::dilate(image, around, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * reach_px + 1, 2 * reach_px + 1)));
  std::vector<cv::Point> maxima;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const float value = image.at<float>(y, x);
      if (value >= least && value >= around.at<float>(y, x)) maxima.emplace_back(x, y);
    }
  }
  std::stable_sort(maxima.begin(), maxima.end(),
                   [&](const cv::Point& a, const cv::Point& b) { return image.at<float>(a) > image.at<float>(b); });
  if (maxima.size() > limit) maxima.resize(limit);
  return maxima;
}

/// Patches up to so many pixels away; they stand in rows, every `stride` pixels.
std::vector<std::uint32_t> patches_around(const SeenLevel& seen, cv::Point centre, int reach_px, int stride) {
  const int first = stride / 2;
  const int columns = (seen.camera.width - first + stride - 1) / stride;
  const int rows = (seen.camera.height - first + stride - 1) / stride;
  const auto index = [&](int px) { return (px - first) / stride; };
  std::vector<std::uint32_t> patches;
  for (int y = std::max(0, index(centre.y - reach_px)); y <= std::min(rows - 1, index(centre.y + reach_px)); ++y) {
    for (int x = std::max(0, index(centre.x - reach_px)); x <= std::min(columns - 1, index(centre.x + reach_px)); ++x) {
      patches.push_back(static_cast<std::uint32_t>(y * columns + x));
    }
  }
  return patches;
}

/// The patches, and the views that they remember, whose votes meet at a maximum.
Hypothesis gather_supporters(const Forest& forest, int class_index, const SeenLevel& seen, cv::Point centre,
                             const DetectionSettings& settings) {
  Hypothesis hypothesis;
  const float sigma = settings.vote_sigma * seen.px_per_offset;
  const float reach = forest.classes[static_cast<std::size_t>(class_index)].radius * seen.px_per_offset + 3.0F * sigma;
  const int reach_px = static_cast<int>(std::ceil(reach));
  std::vector<float> by_view(forest.views.size(), 0.0F);
  for (const std::uint32_t p : patches_around(seen, centre, reach_px, settings.stride)) {
    if (!believes(forest, class_index, seen, p, settings.min_class_share)) continue;
    float support = 0.0F;
    for_votes_of(forest, class_index, seen, p, [&](float x, float y, float weight, const LeafClass& entry) {
      const float dx = x - static_cast<float>(centre.x);
      const float dy = y - static_cast<float>(centre.y);
      const float share = weight * vote_kernel(dx * dx + dy * dy, sigma);
      if (share <= 0.0F) return;
      support += share;
      ++hypothesis.vote_count;
      for (std::uint32_t v = entry.first_view; v < entry.first_view + entry.view_count; ++v) {
        by_view[forest.leaf_views[v].view] += share * forest.leaf_views[v].weight;
      }
    });
    hypothesis.weight += support;
    if (support > 0.0F) hypothesis.patches.emplace_back(p, support);
  }
  for (std::uint32_t v = 0; v < by_view.size(); ++v) {
    if (by_view[v] > 0.0F) hypothesis.views.emplace_back(v, by_view[v]);
  }
  return hypothesis;
}

/// All maxima of one class in one size.
std::vector<Candidate> level_candidates(const Forest& forest, int class_index, const SeenLevel& seen,
                                        const Camera& camera, const DetectionSettings& settings) {
  const ObjectClass& object = forest.classes[static_cast<std::size_t>(class_index)];
  const cv::Mat image = hough_image(forest, class_index, seen, settings);
  const std::size_t limit = static_cast<std::size_t>(settings.max_per_class) / kMaxScales;
  const int reach_px = static_cast<int>(std::lround(2.0F * settings.vote_sigma * seen.px_per_offset));
  std::vector<Candidate> candidates;
  for (const cv::Point& at : maxima_of(image, reach_px, settings.min_mass_share, limit)) {
    Hypothesis hypothesis = gather_supporters(forest, class_index, seen, at, settings);
    hypothesis.centre_camera = seen.camera.backproject(at.x, at.y, seen.size_ratio).cast<float>();
    Candidate candidate;
    candidate.evidence.mass_share = image.at<float>(at);
    Detection& detection = candidate.detection;
    detection.class_id = object.class_id;
    detection.class_name = object.name;
    detection.score = vote_score(candidate.evidence.mass_share);
    detection.box_px = backprojected_box(forest, hypothesis, seen.grid, camera);
    detection.centre_camera.setConstant(std::numeric_limits<float>::quiet_NaN());
    detection.vote_weight = hypothesis.weight;
    detection.vote_count = hypothesis.vote_count;
    if (!detection.box_px.empty()) candidates.push_back(std::move(candidate));
  }
  return candidates;
}

}  // namespace

std::vector<Candidate> search_scale_space(const Forest& forest, const RgbdFrame& frame,
                                          const DetectionSettings& settings, StageClock& clock) {
  std::vector<Candidate> all;
  for (const FeatureLevel& level : feature_levels(forest.features)) {
    const SeenLevel seen = see_level(forest, frame, level, settings, clock);
    std::vector<std::vector<Candidate>> by_class(forest.classes.size());
    parallel_for(settings.threads, static_cast<int>(by_class.size()), [&](int c) {
      by_class[static_cast<std::size_t>(c)] = level_candidates(forest, c, seen, frame.camera, settings);
    });
    for (std::vector<Candidate>& part : by_class) std::move(part.begin(), part.end(), std::back_inserter(all));
    clock.mark("detect.voting");
  }
  return all;
}

std::vector<cv::Mat> scale_space_hough_images(const Forest& forest, int class_index, const RgbdFrame& frame,
                                              const DetectionSettings& settings) {
  std::vector<cv::Mat> images;
  StageClock clock;
  for (const FeatureLevel& level : feature_levels(forest.features)) {
    images.push_back(hough_image(forest, class_index, see_level(forest, frame, level, settings, clock), settings));
  }
  return images;
}

}  // namespace houghstream
