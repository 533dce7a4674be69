#include "tools/studies/tracks/track_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "pose/model/symmetry.hpp"
#include "pose/motion/assignment.hpp"
#include "pose/motion/twist.hpp"

namespace houghstream::studies {
namespace {

constexpr int kThresholds = 19;
constexpr double kZeroAtM = 0.1;  // positions that far apart have no similarity

/// A pair is a ground-truth object and a published one.
using TrackPair = std::pair<int, std::int64_t>;

/// Objects of a frame that count.
struct CountedFrame {
  std::vector<int> instances;     // true objects that must be seen
  std::vector<std::int64_t> ids;  // published objects
  Eigen::MatrixXd similarities;   // similarity of each instance (row) to each id (column)
};

double similarity(double distance_m) {
  return std::max(0.0, 1.0 - distance_m / kZeroAtM);
}

CountedFrame counted(const std::vector<TrueInstance>& truth, const std::vector<PublishedObject>& objects,
                     const ClassSymmetries& symmetries, const TrackMetricsSettings& settings) {
  const std::vector<int> given = matches(truth, objects, symmetries, settings.reach_m);
  std::vector<bool> left_out(objects.size(), false);
  std::vector<std::size_t> required;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool is_required = truth[i].T_world_object && truth[i].visible >= settings.min_visible;
    if (is_required) required.push_back(i);
    if (!is_required && given[i] >= 0) left_out[static_cast<std::size_t>(given[i])] = true;
  }
  std::vector<std::size_t> kept;
  for (std::size_t j = 0; j < objects.size(); ++j) {
    if (!left_out[j]) kept.push_back(j);
  }
  CountedFrame frame;
  frame.similarities.resize(static_cast<Eigen::Index>(required.size()), static_cast<Eigen::Index>(kept.size()));
  for (const std::size_t i : required) frame.instances.push_back(truth[i].instance);
  for (const std::size_t j : kept) frame.ids.push_back(objects[j].track_id);
  for (std::size_t row = 0; row < required.size(); ++row) {
    for (std::size_t column = 0; column < kept.size(); ++column)
      frame.similarities(row, column) = similarity(apart_m(truth[required[row]], objects[kept[column]], symmetries));
  }
  return frame;
}

/// Counts in how many frames each object is, and the maximum similarity that two share.
struct Alignment {
  std::map<int, double> of_truth;
  std::map<std::int64_t, double> of_track;
  std::map<TrackPair, double> shared;

  void add(const CountedFrame& frame) {
    for (const int instance : frame.instances) ++of_truth[instance];
    for (const std::int64_t id : frame.ids) ++of_track[id];
    for (std::size_t i = 0; i < frame.instances.size(); ++i) {
      for (std::size_t j = 0; j < frame.ids.size(); ++j) {
        const double here = frame.similarities(i, j);
        if (here > 0.0)
          shared[{frame.instances[i], frame.ids[j]}] +=
              here / (frame.similarities.row(i).sum() + frame.similarities.col(j).sum() - here);
      }
    }
  }

  /// Returns the fraction of common frames among all frames of the two.
  double jaccard(const TrackPair& pair, double common) const {
    return common / (of_truth.at(pair.first) + of_track.at(pair.second) - common);
  }

  double of(const TrackPair& pair) const {
    const auto found = shared.find(pair);
    return found == shared.end() ? 0.0 : jaccard(pair, found->second);
  }
};

/// Returns for each ground-truth object the index of the published one, or -1.
std::vector<int> aligned_matches(const CountedFrame& frame, const Alignment& alignment) {
  Eigen::MatrixXd costs = -frame.similarities;
  for (std::size_t i = 0; i < frame.instances.size(); ++i) {
    for (std::size_t j = 0; j < frame.ids.size(); ++j) costs(i, j) *= alignment.of({frame.instances[i], frame.ids[j]});
  }
  return solve_assignment(costs, 0.0);
}

}  // namespace

std::vector<HotaCount> hota_counts(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                                   const ClassSymmetries& symmetries, const TrackMetricsSettings& settings) {
  std::vector<CountedFrame> frames;
  Alignment alignment;
  for (const PublishedFrame& frame : published) {
    frames.push_back(counted(sequence.frames[frame.index], frame.objects, symmetries, settings));
    alignment.add(frames.back());
  }
  std::vector<HotaCount> counts(kThresholds);
  std::vector<std::map<TrackPair, double>> common(kThresholds);
  for (const CountedFrame& frame : frames) {
    const std::vector<int> given = aligned_matches(frame, alignment);
    for (std::size_t k = 0; k < counts.size(); ++k) {
      const double threshold = 0.05 * static_cast<double>(k + 1) - std::numeric_limits<double>::epsilon();
      double matched = 0.0;
      for (std::size_t i = 0; i < given.size(); ++i) {
        if (given[i] < 0 || frame.similarities(i, given[i]) < threshold) continue;
        ++matched;
        ++common[k][{frame.instances[i], frame.ids[static_cast<std::size_t>(given[i])]}];
      }
      counts[k].true_positives += matched;
      counts[k].false_negatives += static_cast<double>(frame.instances.size()) - matched;
      counts[k].false_positives += static_cast<double>(frame.ids.size()) - matched;
    }
  }
  for (std::size_t k = 0; k < counts.size(); ++k) {
    for (const auto& [pair, count] : common[k]) counts[k].association += count * alignment.jaccard(pair, count);
  }
  return counts;
}

double hota_of(const std::vector<HotaCount>& counts) {
  double sum = 0.0;
  for (const HotaCount& count : counts) {
    const double all = count.true_positives + count.false_negatives + count.false_positives;
    if (count.true_positives > 0.0)
      sum += std::sqrt(count.true_positives / all * count.association / count.true_positives);
  }
  return counts.empty() ? 0.0 : sum / static_cast<double>(counts.size());
}

Eigen::Isometry3d as_the_truth(const PublishedObject& object, const TrueInstance& truth,
                               const ClassSymmetries& symmetries) {
  const auto known = symmetries.find(truth.class_name);
  if (known == symmetries.end()) return object.T_world_object;
  return nearest_equivalent(object.T_world_object, *truth.T_world_object, known->second);
}

double apart_m(const TrueInstance& truth, const PublishedObject& object, const ClassSymmetries& symmetries) {
  if (!truth.T_world_object || truth.class_name != object.class_name) return std::numeric_limits<double>::infinity();
  return (truth.T_world_object->translation() - as_the_truth(object, truth, symmetries).translation()).norm();
}

std::vector<int> matches(const std::vector<TrueInstance>& truth, const std::vector<PublishedObject>& objects,
                         const ClassSymmetries& symmetries, double reach_m) {
  constexpr double kFar = 1e3;
  Eigen::MatrixXd costs(truth.size(), objects.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < objects.size(); ++j)
      costs(i, j) = std::min(kFar, apart_m(truth[i], objects[j], symmetries));
  }
  return solve_assignment(costs, reach_m);
}

std::vector<MatchedPose> match_published(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                                         const ClassSymmetries& symmetries) {
  constexpr double kReachM = 0.1;
  std::vector<MatchedPose> out;
  for (const PublishedFrame& frame : published) {
    const std::vector<TrueInstance>& truth = sequence.frames[frame.index];
    const std::vector<int> given = matches(truth, frame.objects, symmetries, kReachM);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (!truth[i].T_world_object) continue;
      MatchedPose& pose = out.emplace_back();
      pose.frame = &frame;
      pose.truth = &truth[i];
      if (given[i] < 0) continue;
      const auto place = static_cast<std::size_t>(given[i]);
      pose.T_world_object = as_the_truth(frame.objects[place], truth[i], symmetries);
      if (!frame.qualities.empty()) pose.quality = frame.qualities[place];
    }
  }
  return out;
}

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::lround(fraction * static_cast<double>(values.size() - 1)))];
}

namespace {

constexpr double kDegrees = 180.0 / M_PI;

using Numbers = std::vector<double>;

/// Errors of poses in millimetres and degrees.
struct Errors {
  Numbers mm;
  Numbers deg;
  Numbers deviations_mm;  ///< published standard deviations of some of them
  int within_two = 0;     ///< errors within two of these deviations

  void add(const Vector6& error, double deviation_m) {
    mm.push_back(1e3 * error.head<3>().norm());
    deg.push_back(kDegrees * error.tail<3>().norm());
    if (!std::isfinite(deviation_m)) return;
    deviations_mm.push_back(1e3 * deviation_m);
    within_two += mm.back() <= 2.0 * deviations_mm.back() ? 1 : 0;
  }

  OrderedJson json() const {
    return {{"frames", mm.size()},
            {"mm_median", finite_or_null(quantile(mm, 0.5))},
            {"mm_p95", finite_or_null(quantile(mm, 0.95))},
            {"deg_median", finite_or_null(quantile(deg, 0.5))},
            {"deg_p95", finite_or_null(quantile(deg, 0.95))},
            {"deviation_mm_median", finite_or_null(quantile(deviations_mm, 0.5))},
            {"within_two_deviations",
             finite_or_null(static_cast<double>(within_two) / static_cast<double>(deviations_mm.size()))}};
  }
};

/// Returns a row for each threshold.
OrderedJson counts_json(const std::vector<HotaCount>& counts) {
  OrderedJson out = OrderedJson::array();
  for (const HotaCount& count : counts)
    out.push_back({count.true_positives, count.false_negatives, count.false_positives, count.association});
  return out;
}

/// Returns the frames of the sequence in order, those without a publication as empty ones.
std::vector<PublishedFrame> with_silent_frames(const SequenceFile& sequence, std::vector<PublishedFrame> published) {
  std::vector<bool> told(sequence.frames.size(), false);
  for (const PublishedFrame& frame : published) told[frame.index] = true;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!told[i]) published.push_back({i, {}});
  }
  std::stable_sort(published.begin(), published.end(),
                   [](const PublishedFrame& a, const PublishedFrame& b) { return a.index < b.index; });
  return published;
}

/// Tracks the life of one ground-truth object.
struct Life {
  std::int64_t last_id = 0;          // last published number of it; 0: none yet
  std::optional<std::size_t> since;  // frame in which it was observed first, or again, and not yet found
  bool there = false;
  std::optional<std::size_t> taken;  // frame from which on it is away, and its number still published
  std::vector<Vector6> window;       // differences from the true pose while it stands
  std::size_t window_begin = 0;      // frame
};

class Comparison {
 public:
  Comparison(const SequenceFile& sequence, const ClassSymmetries& symmetries, const TrackMetricsSettings& settings)
      : sequence_(sequence), symmetries_(symmetries), settings_(settings) {}

  void add(const PublishedFrame& frame) {
    const std::vector<TrueInstance>& truth = sequence_.frames[frame.index];
    const std::vector<int> given = matches(truth, frame.objects, symmetries_, settings_.reach_m);
    std::vector<bool> used(frame.objects.size(), false);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (given[i] >= 0) used[given[i]] = true;
      add_instance(truth[i], given[i] >= 0 ? &frame.objects[given[i]] : nullptr, frame);
    }
    for (std::size_t j = 0; j < used.size(); ++j) {
      if (!used[j]) {
        ++false_;
        ++wrong_[frame.objects[j].class_name];
      }
    }
    ++frames_;
  }

  OrderedJson json(const std::vector<HotaCount>& hota) {
    for (auto& [instance, life] : lives_) {
      if (life.since) to_find_.push_back(nullptr);
      if (life.taken) to_gone_.push_back(nullptr);
    }
    return {{"frames", frames_},
            {"required", required_},
            {"kept", kept_},
            {"recall", finite_or_null(static_cast<double>(found_) / required_)},
            {"precision", finite_or_null(static_cast<double>(found_ + kept_) / (found_ + kept_ + false_))},
            {"id_switches", switches_},
            {"hota", hota_of(hota)},
            {"hota_counts", counts_json(hota)},
            {"error", {{"standing", standing_.json()}, {"moving", moving_.json()}}},
            {"jitter",
             {{"windows", jitter_.mm.size()},
              {"mm", finite_or_null(quantile(jitter_.mm, 0.5))},
              {"deg", finite_or_null(quantile(jitter_.deg, 0.5))},
              {"mm_worst", finite_or_null(quantile(jitter_.mm, 1.0))},
              {"deg_worst", finite_or_null(quantile(jitter_.deg, 1.0))}}},
            {"seconds_to_find", to_find_},
            {"seconds_to_gone", to_gone_},
            {"hidden_kept", hidden_ == 0 ? OrderedJson() : OrderedJson(static_cast<double>(kept_hidden_) / hidden_)},
            {"hidden_frames", hidden_},
            {"wrong", wrong_}};
  }

 private:
  double seconds(std::size_t from, std::size_t to) const {
    return static_cast<double>(sequence_.utimes[to] - sequence_.utimes[from]) * 1e-6;
  }

  void add_instance(const TrueInstance& truth, const PublishedObject* object, const PublishedFrame& frame) {
    constexpr double kSeen = 0.5;
    Life& life = lives_[truth.instance];
    const bool required = truth.T_world_object && truth.visible >= settings_.min_visible;
    required_ += required ? 1 : 0;
    found_ += required && object != nullptr ? 1 : 0;
    kept_ += !required && object != nullptr ? 1 : 0;
    follow_presence(truth, frame, life);
    if (!life.there && truth.T_world_object && truth.visible >= kSeen) {
      life.there = true;
      life.since = frame.index;
    }
    if (object != nullptr && life.since) {
      to_find_.push_back(seconds(*life.since, frame.index));
      life.since.reset();
    }
    const bool stands = stood(truth, frame.index);
    if (stands && !required && life.last_id != 0) {
      ++hidden_;
      kept_hidden_ += object != nullptr ? 1 : 0;
    }
    if (object != nullptr) {
      if (life.last_id != 0 && object->track_id != life.last_id) ++switches_;
      life.last_id = object->track_id;
      if (required) add_error(truth, *object, stands, frame.index);
    }
    if (!stands || object == nullptr) life.window.clear();
  }

  /// Returns whether the object has not moved since the frame before: several publications may be of one frame.
  bool stood(const TrueInstance& truth, std::size_t index) const {
    if (!truth.T_world_object || index == 0) return false;
    const std::vector<TrueInstance>& before = sequence_.frames[index - 1];
    const auto same = std::find_if(before.begin(), before.end(),
                                   [&](const TrueInstance& other) { return other.instance == truth.instance; });
    return same != before.end() && same->T_world_object &&
           local_coordinates_about_world(*truth.T_world_object, *same->T_world_object).norm() < 1e-9;
  }

  void follow_presence(const TrueInstance& truth, const PublishedFrame& frame, Life& life) {
    if (life.there && !truth.T_world_object) {
      life.there = false;
      if (life.since) to_find_.push_back(nullptr);  // it never was
      life.since.reset();
      if (life.last_id != 0) life.taken = frame.index;
    }
    if (!life.taken) return;
    const bool told = std::any_of(frame.objects.begin(), frame.objects.end(),
                                  [&](const PublishedObject& object) { return object.track_id == life.last_id; });
    if (told && !truth.T_world_object) return;
    to_gone_.push_back(
        told ? OrderedJson()
             : OrderedJson(seconds(*life.taken, frame.index)));  // null where it came back before it was gone
    life.taken.reset();
  }

  void add_error(const TrueInstance& truth, const PublishedObject& object, bool stands, std::size_t index) {
    const Vector6 error =
        local_coordinates_about_world(as_the_truth(object, truth, symmetries_), *truth.T_world_object);
    (stands ? standing_ : moving_).add(error, object.deviation_m);
    if (stands) add_to_window(error, index, lives_[truth.instance]);
  }

  /// A window is closed by the first publication that is 5 s after its first one, which begins the next.
  void add_to_window(const Vector6& error, std::size_t index, Life& life) {
    constexpr double kWindowS = 5.0;
    if (life.window.empty()) life.window_begin = index;
    if (seconds(life.window_begin, index) >= kWindowS) {
      add_jitter(life.window);
      life.window.clear();
      life.window_begin = index;
    }
    life.window.push_back(error);
  }

  void add_jitter(const std::vector<Vector6>& errors) {
    Vector6 mean = Vector6::Zero();
    for (const Vector6& error : errors) mean += error / static_cast<double>(errors.size());
    double mm = 0.0;
    double deg = 0.0;
    for (const Vector6& error : errors) {
      mm += (error - mean).head<3>().squaredNorm() / static_cast<double>(errors.size());
      deg += (error - mean).tail<3>().squaredNorm() / static_cast<double>(errors.size());
    }
    jitter_.mm.push_back(1e3 * std::sqrt(mm));
    jitter_.deg.push_back(kDegrees * std::sqrt(deg));
  }

  const SequenceFile& sequence_;
  const ClassSymmetries& symmetries_;
  const TrackMetricsSettings& settings_;
  std::map<int, Life> lives_;
  int frames_ = 0;
  int required_ = 0;
  int found_ = 0;
  int kept_ = 0;
  int false_ = 0;
  int switches_ = 0;
  int hidden_ = 0;
  int kept_hidden_ = 0;
  Errors standing_, moving_, jitter_;
  OrderedJson to_find_ = OrderedJson::array();
  OrderedJson to_gone_ = OrderedJson::array();
  std::map<std::string, int> wrong_;
};

}  // namespace

OrderedJson track_metrics(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                          const std::map<std::string, Symmetries>& symmetries, const TrackMetricsSettings& settings) {
  const std::vector<PublishedFrame> frames = with_silent_frames(sequence, published);
  Comparison comparison(sequence, symmetries, settings);
  for (const PublishedFrame& frame : frames) comparison.add(frame);
  OrderedJson json = comparison.json(hota_counts(sequence, frames, symmetries, settings));
  json["silent_frames"] = frames.size() - published.size();
  return json;
}

}  // namespace houghstream::studies
