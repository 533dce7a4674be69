#include "tools/studies/baselines/linemod_detector.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

Detection to_detection(const LinemodMatch& match, const cv::Rect& seen_px, const Camera& camera) {
  const cv::Point2f origin = match.shape->origin_px + cv::Point2f(match.at_px);
  Detection out;
  out.class_id = match.shape->class_id;
  out.class_name = match.shape->class_name;
  out.score = match.similarity / 100.0F;
  out.box_px = seen_px;
  out.centre_camera = camera.backproject(origin.x, origin.y, match.shape->distance).cast<float>();
  return out;
}

void check_selection(const LinemodSelection& selection) {
  require(selection.match_threshold >= 0.0F && selection.match_threshold <= 100.0F,
          "linemod: match threshold {}, expected 0 to 100 percent", selection.match_threshold);
  require(selection.depth_tolerance > 0.0F, "linemod: depth tolerance {}, expected more than 0",
          selection.depth_tolerance);
}

}  // namespace

bool depth_agrees(const LinemodMatch& match, const cv::Mat& depth, float tolerance) {
  const cv::Rect inside({0, 0}, depth.size());
  std::vector<float> differences;
  differences.reserve(match.shape->samples.size());
  for (const LinemodTemplate::DepthSample& sample : match.shape->samples) {
    const cv::Point at = match.at_px + sample.at_px;
    if (!inside.contains(at)) continue;
    const float seen = depth.at<float>(at);
    if (std::isfinite(seen)) differences.push_back(seen - sample.depth);
  }
  if (differences.empty()) return true;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return std::fabs(*middle) <= tolerance * match.shape->distance;
}

std::vector<Detection> select_detections(const std::vector<LinemodMatch>& matches, const RgbdFrame& frame,
                                         const LinemodSelection& selection) {
  const cv::Rect inside({0, 0}, frame.colour.size());
  std::vector<Detection> kept;
  std::map<int, std::vector<cv::Rect2f>> boxes;  // boxes by class id
  for (const LinemodMatch& match : matches) {
    if (match.similarity < selection.match_threshold) break;
    std::vector<cv::Rect2f>& class_boxes = boxes[match.shape->class_id];
    if (static_cast<int>(class_boxes.size()) >= selection.max_per_class) continue;
    const cv::Rect seen = (match.shape->box_px + match.at_px) & inside;
    if (seen.empty()) continue;
    const cv::Rect2f box(seen);
    const auto repeats = [&](const cv::Rect2f& other) { return box_iou(box, other) > selection.max_overlap; };
    if (std::any_of(class_boxes.begin(), class_boxes.end(), repeats)) continue;
    if (selection.check_depth && !depth_agrees(match, frame.depth, selection.depth_tolerance)) continue;
    class_boxes.push_back(box);
    kept.push_back(to_detection(match, seen, frame.camera));
  }
  return kept;
}

LinemodDetector::LinemodDetector(const std::vector<TrainingView>& views, const LinemodTemplateSettings& settings,
                                 const LinemodSelection& selection)
    : templates_(views, settings), selection_(selection) {
  check_selection(selection);
}

Detections LinemodDetector::detect(const RgbdFrame& frame) const {
  StageClock clock;
  Detections out;
  out.frame = frame.id;
  const std::vector<LinemodMatch> matches = templates_.match(frame, selection_.match_threshold);
  clock.mark("linemod.match");
  out.detections = select_detections(matches, frame, selection_);
  clock.mark("linemod.select");
  out.stages = frame.stages;
  out.stages.insert(out.stages.end(), clock.times().begin(), clock.times().end());
  return out;
}

}  // namespace houghstream
