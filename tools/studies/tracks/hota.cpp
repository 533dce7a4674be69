#include "tools/studies/tracks/hota.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "pose/tracks/assignment.hpp"

namespace houghstream::studies {
namespace {

constexpr int kThresholds = 19;
constexpr double kZeroAtM = 0.1;  // two places that far apart are not alike at all

/// A true object and a published one.
using TrackPair = std::pair<int, std::int64_t>;

/// What counts of a frame.
struct CountedFrame {
  std::vector<int> instances;     // true objects that must be seen
  std::vector<std::int64_t> ids;  // published objects
  Eigen::MatrixXd similarities;   // of these by those
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
    const bool is_required = truth[i].T_world_object && truth[i].visible >= settings.least_visible;
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

/// In how many frames each object is, and how much of them two share at most.
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

  /// Of all frames of the two, the share that would be common to them.
  double jaccard(const TrackPair& pair, double common) const {
    return common / (of_truth.at(pair.first) + of_track.at(pair.second) - common);
  }

  double of(const TrackPair& pair) const {
    const auto found = shared.find(pair);
    return found == shared.end() ? 0.0 : jaccard(pair, found->second);
  }
};

/// For each true object the place of the published one, or -1.
std::vector<int> aligned_matches(const CountedFrame& frame, const Alignment& alignment) {
  Eigen::MatrixXd costs = -frame.similarities;
  for (std::size_t i = 0; i < frame.instances.size(); ++i) {
    for (std::size_t j = 0; j < frame.ids.size(); ++j) costs(i, j) *= alignment.of({frame.instances[i], frame.ids[j]});
  }
  return tracks::assign(costs, 0.0);
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

}  // namespace houghstream::studies
