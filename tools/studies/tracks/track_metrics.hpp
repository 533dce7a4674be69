#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/json_file.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "tools/studies/tracks/sequence_file.hpp"

namespace houghstream::studies {

/// An object as it was published: in a frame, or after it.
struct PublishedObject {
  std::int64_t track_id = 0;  ///< 0 where objects have none: poses of single frames
  std::string class_name;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  /// Published standard deviation of its position (root of the variances' sum), metres; NaN without one.
  double deviation_m = std::numeric_limits<double>::quiet_NaN();
};

/// Holds the published objects of a frame of the sequence.
struct PublishedFrame {
  std::size_t index = 0;  ///< index in the sequence
  std::vector<PublishedObject> objects;
  std::vector<double> qualities = {};  ///< of poses of single frames, in the order of `objects`; empty of tracks
};

struct TrackMetricsSettings {
  double reach_m = 0.05;     ///< a published object is a true one of its class that is nearer
  double min_visible = 0.1;  ///< true objects of which less is seen are neither required nor wrong
};

/// Publications beside the truth, frame by frame; each true object is given at most one published one of its class, so
/// that the sum of distances is least. Of a frame of which nothing was published it is that nothing is there:
///
///   "frames", "required", "recall", "precision"; "kept": published rightly though it was not required;
///   "silent_frames": of which nothing was published
///   "id_switches"      how often a true object's number changed (CLEAR MOT, Bernardin and Stiefelhagen 2008; they hold
///                      on to what was given in the frame before as long as it is near enough, here each frame is
///                      judged by itself, which counts no fewer)
///   "hota"             as hota.hpp says; "hota_counts": of each threshold true positives, false negatives, false
///                      positives and the sum of A(c), to be added up over sequences
///   "error"            of matched objects that stand, and that move: medians and 95 % points, mm and degrees; the
///                      published deviation of the place, and the share of errors within two of it: an honest one has
///                      nearly all there
///   "jitter"           of those that stand: RMS from the mean over each 5 s, median and worst of these; mm and degrees
///   "seconds_to_find"  from when half of an object was seen first, or came back, to when it is published; each, null
///                      where it never was
///   "seconds_to_gone"  from when one has been taken away to when its number is not published any more; each, null
///                      where it still was when the object came back, or in the end
///   "hidden_kept"      share of the frames in which a true object that was found stands where no camera sees it, and
///                      in which it is published
///   "wrong"            classes of what was published and is not so, with how often
///
/// Rotations are compared but for the symmetries of the class.
OrderedJson track_metrics(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                          const std::map<std::string, Symmetries>& symmetries, const TrackMetricsSettings& settings);

/// Symmetries by class name; of others none.
using ClassSymmetries = std::map<std::string, Symmetries>;

/// Returns the published pose of a ground-truth object that is present: of the poses equivalent by symmetry, the one
/// nearest to the true one.
Eigen::Isometry3d as_the_truth(const PublishedObject& object, const TrueInstance& truth,
                               const ClassSymmetries& symmetries);

/// Returns the metres from a ground-truth object to a published one of its class, up to symmetry; infinite where the
/// classes differ, or the ground-truth one is not present.
double apart_m(const TrueInstance& truth, const PublishedObject& object, const ClassSymmetries& symmetries);

/// Assigns to each ground-truth object a published one, or -1: of its class, nearer than `reach_m`, and so that the sum
/// of distances is minimal.
std::vector<int> matches(const std::vector<TrueInstance>& truth, const std::vector<PublishedObject>& objects,
                         const ClassSymmetries& symmetries, double reach_m);

/// A ground-truth object that is present in a published frame, with the published pose of its class that is assigned to
/// it within 0.1 m: a published object farther away belongs to none of its class.
struct MatchedPose {
  const PublishedFrame* frame = nullptr;
  const TrueInstance* truth = nullptr;                        ///< T_world_object is set
  std::optional<Eigen::Isometry3d> T_world_object;            ///< as_the_truth(); nothing where it is not published
  double quality = std::numeric_limits<double>::quiet_NaN();  ///< NaN of tracks, and where it is not published

  /// Returns whether at least a third of it is visible, as medians of errors require.
  bool is_clearly_visible() const { return truth->visible >= 1.0 / 3.0; }
};

/// Returns the objects that are present in the published frames, frame by frame. They refer to `sequence` and
/// `published`, which must outlive them.
std::vector<MatchedPose> match_published(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                                         const ClassSymmetries& symmetries);

/// Returns the value below which a fraction (0 to 1) of the values lies; NaN of none.
double quantile(std::vector<double> values, double fraction);

/// Metrics at one threshold of similarity.
struct HotaCount {
  double true_positives = 0.0;
  double false_negatives = 0.0;
  double false_positives = 0.0;
  double association = 0.0;  ///< sum over the true positives of A(c)
};

/// Computes Higher Order Tracking Accuracy (Luiten et al., "HOTA: A Higher Order Metric for Evaluating Multi-Object
/// Tracking", IJCV 2021), as the authors' TrackEval counts it, at thresholds 0.05 to 0.95: in each frame ground-truth
/// and published objects are matched once, for all thresholds, so that the sum of similarity times the global alignment
/// of their tracks is maximal. Similarity is 1 - distance / 0.1 m. Published objects that are matched (matches()) to a
/// ground-truth one that need not be seen are left out before, with that one.
std::vector<HotaCount> hota_counts(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                                   const ClassSymmetries& symmetries, const TrackMetricsSettings& settings);

/// Returns the mean over the thresholds of sqrt(DetA AssA). Counts of several sequences may be added up before.
double hota_of(const std::vector<HotaCount>& counts);

}  // namespace houghstream::studies
