#include "tools/teach/mesh/practice_measurement.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "tools/evaluate/metrics/detection_metrics.hpp"
#include "tools/finder/search_options.hpp"
#include "tools/finder/stored_quality.hpp"

namespace houghstream::teach {
namespace {

// Upper ends of the bins. The last distance is beyond any that practice has; no object is more than whole.
constexpr std::array<double, 6> kDistances_m = {0.5, 0.75, 1.0, 1.25, 1.5, 10.0};
constexpr std::array<double, 5> kVisible = {0.25, 0.5, 0.75, 0.9, 1.0};

using ObjectKey = std::pair<std::size_t, std::size_t>;  // frame, object

template <std::size_t count>
std::vector<store::PracticeBin> empty_bins(const std::array<double, count>& ends) {
  std::vector<store::PracticeBin> bins;
  for (const double end : ends) bins.push_back({end, 0, 0});
  return bins;
}

void count_in_bin(double value, bool is_found, std::vector<store::PracticeBin>& bins) {
  const auto bin =
      std::find_if(bins.begin(), bins.end() - 1, [value](const store::PracticeBin& it) { return value < it.to; });
  ++bin->shown;
  bin->found += is_found ? 1 : 0;
}

store::PracticeCurve curve_of_scores(const PractisedObject& object, const quality::FoundPoses& found) {
  std::vector<store::JudgedValue> judged;
  for (const MatchedDetection& it : match_detections(found.frames, object.name, DetectionRules{})) {
    if (it.outcome == MatchOutcome::kIgnored) continue;
    judged.push_back({static_cast<double>(it.score), it.outcome == MatchOutcome::kTruePositive});
  }
  return store::make_practice_curve(std::move(judged));
}

/// Counts the poses that hs-pose would publish by default. Returns the objects that have a right one.
std::set<ObjectKey> count_published(const std::vector<quality::Example>& examples, const std::vector<float>& qualities,
                                    float reported_from, store::PracticeRecord& record) {
  std::set<ObjectKey> found;
  for (std::size_t i = 0; i < examples.size(); ++i) {
    const quality::Example& example = examples[i];
    const float published_from = example.score >= reported_from ? kStoreQuality : kStoreCandidateQuality;
    if (example.score < kCandidatesFrom || qualities[i] < published_from) continue;
    ++(example.is_correct_up_to_shape ? record.right : record.wrong);
    if (example.is_correct_up_to_shape) found.insert({example.frame, example.object});
  }
  return found;
}

store::PracticeCurve curve_of_qualities(const std::vector<quality::Example>& examples,
                                        const std::vector<float>& qualities) {
  std::vector<store::JudgedValue> judged;
  for (std::size_t i = 0; i < examples.size(); ++i) {
    if (examples[i].score < kCandidatesFrom) continue;
    judged.push_back({static_cast<double>(qualities[i]), examples[i].is_correct_up_to_shape});
  }
  return store::make_practice_curve(std::move(judged));
}

/// Returns the names of the other objects that are reported by their score in the place of this one, without those that
/// stand there themselves.
std::set<std::string> reported_in_place_of(const NamedObject& object, const EvaluatedFrame& frame,
                                           float reported_from) {
  const DetectionRules rules;
  std::set<std::string> names;
  for (const Detection& detection : frame.detections->detections) {
    if (detection.class_name == object.class_name || detection.score < reported_from) continue;
    const auto is_at = [&](const NamedObject& it) {
      return box_iou(detection.box_px, cv::Rect2f(it.truth.box_visible_px)) >= rules.min_iou;
    };
    const bool is_there = std::any_of(frame.objects.begin(), frame.objects.end(), [&](const NamedObject& it) {
      return it.class_name == detection.class_name && is_at(it);
    });
    if (is_at(object) && !is_there) names.insert(detection.class_name);
  }
  return names;
}

}  // namespace

store::PracticeRecord measure_practice(const PractisedObject& object, const quality::FoundPoses& found,
                                       const std::vector<quality::Example>& examples,
                                       const std::vector<float>& qualities, float reported_from) {
  const DetectionRules rules;
  store::PracticeRecord record;
  record.scores = curve_of_scores(object, found);
  record.qualities = curve_of_qualities(examples, qualities);
  record.by_distance = empty_bins(kDistances_m);
  record.by_visible = empty_bins(kVisible);
  const std::set<ObjectKey> found_objects = count_published(examples, qualities, reported_from, record);
  for (std::size_t f = 0; f < found.frames.size(); ++f) {
    const EvaluatedFrame& frame = found.frames[f];
    for (std::size_t o = 0; o < frame.objects.size(); ++o) {
      const NamedObject& it = frame.objects[o];
      if (it.class_name != object.name || !is_required(it, rules)) continue;
      const bool is_found = found_objects.count({f, o}) > 0;
      ++record.shown;
      const Eigen::Vector3d centre = it.truth.T_camera_object * object.vote_centre.cast<double>();
      count_in_bin(centre.norm(), is_found, record.by_distance);
      count_in_bin(it.truth.visible_fraction, is_found, record.by_visible);
      for (const std::string& name : reported_in_place_of(it, frame, reported_from)) ++record.taken_for[name];
    }
  }
  return record;
}

}  // namespace houghstream::teach
