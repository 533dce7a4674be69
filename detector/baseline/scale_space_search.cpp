#include "detector/baseline/scale_space_search.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/evidence/boxes.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::baseline {
namespace {

/// One size of the frame, classified.
struct SeenLevel {
  PatchGrid grid;  // grid without points and areas, which need depth
  PatchPosteriors posteriors;
  Camera camera;               // camera of the level's image
  float px_per_offset = 0.0F;  // level pixels per unit of a leaf's offset, see ScaleHandling::kScaleSpace
  float size_ratio = 1.0F;
  int size = 0;  // its number
};

/// Classifies the patches of a level; closes its stages on the clock.
SeenLevel see_level(const SearchContext& search, Way way, const RgbdFrame& frame, const FeatureLevel& level,
                    StageClock& clock) {
  const Forest& forest = search.forest();
  const DetectionSettings& settings = search.settings;
  const WorkingFrame working = scale_space_frame(frame, level, forest.features);
  clock.mark("detect.resize");
  FeatureTiles everywhere;
  everywhere.want_all(working.colour.size());
  FeatureWorkspace feature_workspace;
  std::vector<FeatureImage> features(1);
  compute_features_by(way, {working, forest.features, everywhere}, settings.threads, feature_workspace, features[0]);
  clock.mark("detect.features");
  SeenLevel seen;
  seen.camera = working.camera;
  seen.size_ratio = level.size_ratio;
  seen.px_per_offset = static_cast<float>(frame.camera.fx) * forest.features.image_scale;
  add_patches_everywhere(working, level, forest.patch, settings.spacing.stride, seen.grid);
  LeafWorkspace leaf_workspace;
  PosteriorInput input{search.index, features, seen.grid, settings.leaves};
  input.threads = settings.threads;
  find_posteriors_by(way, input, leaf_workspace, seen.posteriors);
  clock.mark("detect.leaves");
  return seen;
}

/// Calls visit(patch, x, y, weight, who) for each vote for a class that falls into the level's image, at its pixel.
template <typename Visit>
void for_votes_of(const Forest& forest, int class_index, const SeenLevel& seen, const Visit& visit) {
  const float fraction = 1.0F / static_cast<float>(forest.roots.size());
  const auto width = static_cast<float>(seen.camera.width);
  const auto height = static_cast<float>(seen.camera.height);
  seen.posteriors.for_each_supporting_patch(
      class_index, [&](std::uint32_t p, const SupportingEntry* entries, std::uint32_t count) {
        for (std::uint32_t e = 0; e < count; ++e) {  // the cache misses below overlap
          hwy::Prefetch(forest.votes.data() + entries[e].start.vote);
        }
        const auto patch_x = static_cast<float>(seen.grid.x[p]);
        const auto patch_y = static_cast<float>(seen.grid.y[p]);
        for (std::uint32_t e = 0; e < count; ++e) {
          const SupportingEntry& entry = entries[e];
          for (std::uint32_t v = entry.start.vote; v < entry.start.vote + entry.leaf_class.vote_count; ++v) {
            const Eigen::Vector3f offset = forest.votes[v].offset();
            // rounded: positions inside the image are positive
            const float x = patch_x + offset.x() * seen.px_per_offset + 0.5F;
            const float y = patch_y + offset.y() * seen.px_per_offset + 0.5F;
            if (x < 0.0F || y < 0.0F || x >= width || y >= height) continue;
            const float weight = entry.leaf_class.probability * forest.votes[v].weight.value() * fraction;
            visit(p, static_cast<int>(x), static_cast<int>(y), weight, entry);
          }
        }
      });
}

/// Returns the vote mass per pixel over the class's expected mass.
cv::Mat hough_image(const SearchContext& search, int class_index, const SeenLevel& seen) {
  const Forest& forest = search.forest();
  const DetectionSettings& settings = search.settings;
  cv::Mat image = cv::Mat::zeros(seen.camera.height, seen.camera.width, CV_32FC1);
  for_votes_of(forest, class_index, seen, [&](std::uint32_t, int x, int y, float weight, const SupportingEntry&) {
    image.at<float>(y, x) += weight;
  });
  const double sigma = static_cast<double>(settings.voting.vote_sigma) * seen.px_per_offset;
  cv::GaussianBlur(image, image, cv::Size(0, 0), sigma, sigma, cv::BORDER_CONSTANT);
  const double patch_side = settings.spacing.stride / static_cast<double>(seen.px_per_offset);
  const double kernel_sum = 2.0 * M_PI * sigma * sigma;  // a vote at the centre counts as 1
  const float expected = forest.classes[static_cast<std::size_t>(class_index)].nominal_vote_mass;
  return image * (kernel_sum * patch_side * patch_side / expected);
}

/// Returns local maxima, strongest first.
std::vector<cv::Point> maxima_of(const cv::Mat& image, int reach_px, float minimum, std::size_t limit) {
  cv::Mat around;
  cv::dilate(image, around, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(2 * reach_px + 1, 2 * reach_px + 1)));
  std::vector<cv::Point> maxima;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const float value = image.at<float>(y, x);
      if (value >= minimum && value >= around.at<float>(y, x)) maxima.emplace_back(x, y);
    }
  }
  std::stable_sort(maxima.begin(), maxima.end(),
                   [&](const cv::Point& a, const cv::Point& b) { return image.at<float>(a) > image.at<float>(b); });
  if (maxima.size() > limit) maxima.resize(limit);
  return maxima;
}

/// Number of the maximum that the votes at a pixel support, or kNobody. The stronger of two near ones counts.
constexpr std::int16_t kNobody = -1;
cv::Mat supported_maximum(const std::vector<cv::Point>& maxima, cv::Size size, float reach_px) {
  cv::Mat number(size, CV_16SC1, cv::Scalar(kNobody));
  for (std::size_t i = maxima.size(); i-- > 0;) {
    cv::circle(number, maxima[i], static_cast<int>(reach_px), cv::Scalar(static_cast<double>(i)), cv::FILLED);
  }
  return number;
}

/// Gathers the patches, and the views that they support, whose votes meet at each maximum.
std::vector<Hypothesis> gather_supporters(const SearchContext& search, int class_index, const SeenLevel& seen,
                                          const std::vector<cv::Point>& maxima) {
  const Forest& forest = search.forest();
  const float sigma = search.settings.voting.vote_sigma * seen.px_per_offset;
  const cv::Mat number = supported_maximum(maxima, cv::Size(seen.camera.width, seen.camera.height), kVoteReach * sigma);
  std::vector<Hypothesis> hypotheses(maxima.size());
  if (maxima.empty()) return hypotheses;
  std::vector<std::vector<float>> by_view(maxima.size(), std::vector<float>(forest.views.size(), 0.0F));
  for_votes_of(forest, class_index, seen,
               [&](std::uint32_t p, int x, int y, float weight, const SupportingEntry& entry) {
                 const std::int16_t supported = number.at<std::int16_t>(y, x);
                 if (supported == kNobody) return;
                 const auto m = static_cast<std::size_t>(supported);
                 const auto dx = static_cast<float>(x - maxima[m].x);
                 const auto dy = static_cast<float>(y - maxima[m].y);
                 const float fraction = weight * vote_kernel(dx * dx + dy * dy, sigma);
                 Hypothesis& hypothesis = hypotheses[m];
                 hypothesis.weight += fraction;
                 ++hypothesis.vote_count;
                 if (hypothesis.patches.empty() || hypothesis.patches.back().first != p)
                   hypothesis.patches.emplace_back(p, 0.0F);
                 hypothesis.patches.back().second += fraction;
                 for (std::uint32_t v = entry.start.view; v < entry.start.view + entry.leaf_class.view_count; ++v) {
                   by_view[m][forest.leaf_views[v].view] += fraction * forest.leaf_views[v].weight.value();
                 }
               });
  for (std::size_t m = 0; m < maxima.size(); ++m) {
    for (std::uint32_t v = 0; v < by_view[m].size(); ++v) {
      if (by_view[m][v] > 0.0F) hypotheses[m].views.emplace_back(v, by_view[m][v]);
    }
  }
  return hypotheses;
}

ScoredHypothesis make_candidate(const ObjectClass& object, const Hypothesis& hypothesis, float relative_vote_mass,
                                cv::Rect2f box_px) {
  ScoredHypothesis candidate;
  candidate.evidence.relative_vote_mass = relative_vote_mass;
  Detection& detection = candidate.detection;
  detection.class_id = object.class_id;
  detection.class_name = object.name;
  detection.score = vote_score(relative_vote_mass);
  detection.box_px = box_px;
  detection.centre_camera.setConstant(std::numeric_limits<float>::quiet_NaN());
  detection.vote_weight = hypothesis.weight;
  detection.vote_count = hypothesis.vote_count;
  return candidate;
}

/// Returns all maxima of one class in one size.
std::vector<ScalePeak> level_peaks(const SearchContext& search, int class_index, const SeenLevel& seen,
                                   const Camera& camera) {
  const ObjectClass& object = search.forest().classes[static_cast<std::size_t>(class_index)];
  const VotingSettings& settings = search.settings.voting;
  const cv::Mat image = hough_image(search, class_index, seen);
  const int reach_px = static_cast<int>(std::lround(kVoteReach * settings.vote_sigma * seen.px_per_offset));
  const auto limit = static_cast<std::size_t>(settings.maxima_per_class);
  const std::vector<cv::Point> maxima = maxima_of(image, reach_px, settings.min_mass_fraction, limit);
  std::vector<Hypothesis> hypotheses = gather_supporters(search, class_index, seen, maxima);
  BoxWorkspace box_workspace;
  const float to_frame = static_cast<float>(camera.width) / static_cast<float>(seen.camera.width);
  const cv::Point2f half(0.5F, 0.5F);
  std::vector<ScalePeak> peaks;
  for (std::size_t m = 0; m < maxima.size(); ++m) {
    const cv::Point at = maxima[m];
    Hypothesis& hypothesis = hypotheses[m];
    hypothesis.centre_camera = seen.camera.backproject(at.x, at.y, seen.size_ratio).cast<float>();
    const cv::Rect2f box_px = backproject_box(search.forest(), hypothesis, seen.grid, camera, box_workspace);
    if (box_px.empty()) continue;
    peaks.push_back({make_candidate(object, hypothesis, image.at<float>(at), box_px),
                     (cv::Point2f(at) + half) * to_frame - half, static_cast<float>(reach_px) * to_frame, seen.size});
  }
  return peaks;
}

bool beside(const ScalePeak& a, const ScalePeak& b) {
  if (a.candidate.detection.class_id != b.candidate.detection.class_id || std::abs(a.size - b.size) != 1) return false;
  const cv::Point2f way = a.at_px - b.at_px;
  return std::max(std::abs(way.x), std::abs(way.y)) <= std::max(a.reach_px, b.reach_px);
}

bool is_slope(const std::vector<ScalePeak>& peaks, std::size_t i) {
  const float mass = peaks[i].candidate.evidence.relative_vote_mass;
  for (std::size_t j = 0; j < peaks.size(); ++j) {
    const float other = peaks[j].candidate.evidence.relative_vote_mass;
    if ((other > mass || (other == mass && j < i)) && beside(peaks[i], peaks[j])) return true;
  }
  return false;
}

}  // namespace

std::vector<FeatureLevel> scale_space_levels(const FeatureSettings& settings) {
  constexpr float kAnywhere = std::numeric_limits<float>::infinity();
  std::vector<FeatureLevel> levels;
  for (const float ratio : settings.scales) {
    if (ratio > 0.0F) levels.push_back({settings.image_scale * ratio, ratio, 0.0F, kAnywhere});
  }
  return levels;
}

WorkingFrame scale_space_frame(const RgbdFrame& frame, const FeatureLevel& level, const FeatureSettings& settings) {
  FeatureSettings in_pixels = settings;
  in_pixels.fill_distance = 0.0F;
  return make_working_frame(frame, level, in_pixels);
}

std::vector<ScoredHypothesis> maxima_over_sizes(const std::vector<ScalePeak>& peaks) {
  std::vector<ScoredHypothesis> candidates;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    if (!is_slope(peaks, i)) candidates.push_back(peaks[i].candidate);
  }
  return candidates;
}

std::vector<ScoredHypothesis> search_scale_space(const SearchContext& search, Way way, const RgbdFrame& frame,
                                                 StageClock& clock) {
  std::vector<ScalePeak> all;
  int sizes = 0;
  for (const FeatureLevel& level : scale_space_levels(search.forest().features)) {
    SeenLevel seen = see_level(search, way, frame, level, clock);
    seen.size = sizes++;
    std::vector<std::vector<ScalePeak>> by_class(search.forest().classes.size());
    parallel_for(search.settings.threads, static_cast<int>(by_class.size()),
                 [&](int c) { by_class[static_cast<std::size_t>(c)] = level_peaks(search, c, seen, frame.camera); });
    for (std::vector<ScalePeak>& part : by_class) std::move(part.begin(), part.end(), std::back_inserter(all));
    clock.mark("detect.votes");
  }
  return maxima_over_sizes(all);
}

std::vector<cv::Mat> scale_space_hough_images(const SearchContext& search, int class_index, const RgbdFrame& frame) {
  std::vector<cv::Mat> images;
  StageClock clock;
  for (const FeatureLevel& level : scale_space_levels(search.forest().features)) {
    images.push_back(hough_image(search, class_index, see_level(search, Way::kFast, frame, level, clock)));
  }
  return images;
}

}  // namespace houghstream::baseline
