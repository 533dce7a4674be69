#include "tools/studies/failures/failures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "tools/view/drawing/overlay.hpp"
#include "tools/view/drawing/tiles.hpp"

namespace houghstream {
namespace {

constexpr int kTileWidth = 240;
constexpr int kTileHeight = 180;
constexpr int kCaptionHeight = 20;

std::size_t distance(std::size_t a, std::size_t b) {
  return a < b ? b - a : a - b;
}

/// Returns the gravest first, without those near a graver one.
std::vector<Failure> thinned(std::vector<Failure> failures, std::size_t apart) {
  std::stable_sort(failures.begin(), failures.end(),
                   [](const Failure& a, const Failure& b) { return a.weight > b.weight; });
  std::vector<Failure> kept;
  for (const Failure& failure : failures) {
    const auto near = [&](const Failure& other) { return distance(other.frame, failure.frame) < apart; };
    if (std::none_of(kept.begin(), kept.end(), near)) kept.push_back(failure);
  }
  return kept;
}

std::vector<Failure> false_positives(const std::vector<EvaluatedFrame>& frames, const ClassResult& result,
                                     float minimum) {
  std::vector<Failure> out;
  for (const MatchedDetection& judged : result.judged) {
    if (judged.outcome != MatchOutcome::kFalsePositive || judged.score < minimum) continue;
    const Detection& detection = frames[judged.frame].detections->detections[judged.index];
    Failure& failure = out.emplace_back();
    failure.class_name = result.class_name;
    failure.frame = judged.frame;
    failure.box_px = detection.box_px;
    failure.weight = judged.score;
  }
  return out;
}

std::vector<Failure> missed_ones(const std::vector<EvaluatedFrame>& frames, const ClassResult& result,
                                 const FailureRules& rules) {
  std::vector<Failure> out;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t o = 0; o < frames[f].objects.size(); ++o) {
      const NamedObject& object = frames[f].objects[o];
      if (object.class_name != result.class_name || object.truth.visible_fraction < rules.detection.min_visible)
        continue;
      const auto finds = [&](const MatchedDetection& judged) {
        return judged.outcome == MatchOutcome::kTruePositive && judged.score >= rules.operating_score &&
               judged.frame == f && judged.object == o;
      };
      if (std::any_of(result.judged.begin(), result.judged.end(), finds)) continue;
      Failure& failure = out.emplace_back();
      failure.kind = Failure::Kind::kMissed;
      failure.class_name = result.class_name;
      failure.frame = f;
      failure.box_px = cv::Rect2f(object.truth.box_visible_px);
      failure.weight = object.truth.visible_fraction;
    }
  }
  return out;
}

}  // namespace

std::vector<Failure> choose_failures(const std::vector<EvaluatedFrame>& frames, const std::vector<std::string>& classes,
                                     const FailureRules& rules) {
  std::vector<std::vector<Failure>> groups;
  for (const std::string& name : classes) {
    const ClassResult result = evaluate_class(frames, name, rules.detection);
    groups.push_back(thinned(false_positives(frames, result, rules.operating_score), rules.apart));
    groups.push_back(thinned(missed_ones(frames, result, rules), rules.apart));
  }
  std::vector<Failure> selected;
  std::size_t max_length = 0;
  for (const auto& group : groups) max_length = std::max(max_length, group.size());
  for (std::size_t rank = 0; rank < max_length; ++rank) {
    for (const auto& group : groups) {
      if (rank < group.size() && selected.size() < rules.count) selected.push_back(group[rank]);
    }
  }
  return selected;
}

cv::Rect surroundings(const cv::Rect2f& box, const cv::Size& frame) {
  const float height = std::max({2.2F * box.height, 2.2F * box.width * kTileHeight / kTileWidth, 90.0F});
  const int rows = std::min(static_cast<int>(height), frame.height);
  const int columns = std::min(rows * kTileWidth / kTileHeight, frame.width);
  const cv::Point2f middle = 0.5F * (box.tl() + box.br());
  const int left = std::clamp(static_cast<int>(middle.x) - columns / 2, 0, frame.width - columns);
  const int top = std::clamp(static_cast<int>(middle.y) - rows / 2, 0, frame.height - rows);
  return {left, top, columns, rows};
}

cv::Mat draw_failure(const Failure& failure, const cv::Mat& colour) {
  const cv::Rect part = surroundings(failure.box_px, colour.size());
  const double scale = static_cast<double>(kTileWidth) / part.width;
  const bool missed = failure.kind == Failure::Kind::kMissed;
  cv::Mat tile(kCaptionHeight + kTileHeight, kTileWidth, CV_8UC3, cv::Scalar(0, 0, 0));
  cv::Mat image = tile.rowRange(kCaptionHeight, tile.rows);
  cv::resize(colour(part), image, image.size(), 0, 0, cv::INTER_LINEAR);
  const cv::Point2f corner = scale * (failure.box_px.tl() - cv::Point2f(part.tl()));
  const cv::Rect box(corner, cv::Size2f(static_cast<float>(scale) * failure.box_px.width,
                                        static_cast<float>(scale) * failure.box_px.height));
  cv::rectangle(image, box, cv::Scalar(20, 20, 20), 4);
  cv::rectangle(image, box, missed ? cv::Scalar(60, 220, 255) : cv::Scalar(80, 80, 255), 2);
  const std::string words = missed
                                ? fmt::format("missed: {}, {:.0f} % visible", failure.class_name, 100 * failure.weight)
                                : fmt::format("false: {} {:.2f}", failure.class_name, failure.weight);
  view::draw_text(tile, words, {4, kCaptionHeight - 6}, 0.4);
  return tile;
}

cv::Mat join_tiles(const std::vector<cv::Mat>& tiles, int columns) {
  if (tiles.empty()) {
    cv::Mat none(kCaptionHeight + kTileHeight, kTileWidth, CV_8UC3, cv::Scalar(0, 0, 0));
    view::draw_text(none, "no failures", {4, kCaptionHeight - 6}, 0.4);
    return none;
  }
  return view::tiled(tiles, columns);
}

}  // namespace houghstream
