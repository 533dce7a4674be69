#pragma once

#include <map>
#include <string>
#include <vector>

#include "drivers/files/json_file.hpp"

// What was counted of an object while its scores and qualities were calibrated on synthetic scenes ("practice"), and
// what follows from it for the thresholds of a search.

namespace houghstream::store {

/// A detection or a pose that the ground truth has judged.
struct JudgedValue {
  double value = 0.0;  ///< score or quality, 0 to 1
  bool is_right = false;
};

/// Counts of all that has at least this value.
struct PracticeStep {
  double from = 0.0;  ///< threshold, 0 to 1
  int right = 0;
  int wrong = 0;
};

/// Cumulative counts by threshold, highest threshold first.
using PracticeCurve = std::vector<PracticeStep>;

/// Counts of an object in a range of distances or of visible fractions; it begins where the bin before it ends.
struct PracticeBin {
  double to = 0.0;  ///< upper end, metres or a fraction
  int shown = 0;    ///< times that the object stood in view
  int found = 0;    ///< times that a right pose of it would have been published
};

/// Counts of an object in its practice.
struct PracticeRecord {
  int shown = 0;            ///< times that it stood in a frame's view, visible enough to be required
  int right = 0;            ///< times that it was found with a right pose that would be published by default
  int wrong = 0;            ///< poses that would be published by default and are wrong
  PracticeCurve scores;     ///< detections that are there, and that are not, by score
  PracticeCurve qualities;  ///< poses that are right up to the shape's symmetries, and that are not, by shape quality
  /// Times that another object, by name, was detected in its place with a score that is reported by default.
  std::map<std::string, int> taken_for;
  std::vector<PracticeBin> by_distance;  ///< distance of the object's origin from the camera, metres
  std::vector<PracticeBin> by_visible;   ///< visible fraction
};

/// Another object that is detected in an object's place.
struct Confusion {
  std::string name;       ///< empty where there is none
  double fraction = 0.0;  ///< of the times that the object stood in view
};

/// A threshold and what to expect from it on.
struct OperatingThreshold {
  double from = 1.0;
  double precision = 0.0;   ///< estimate_precision()
  double recall = 0.0;      ///< fraction of the times that the object stood in view
  bool is_reached = false;  ///< whether the precision is the wanted one; else it is the best that there is
};

/// The highest precision that can be asked for; 1 is never reached by an estimate from counts.
constexpr double kMaxPrecision = 0.9999;

/// Throws InputError naming `where` for a precision outside 0 to kMaxPrecision, NaN included.
void check_precision(double precision, const std::string& where);

/// Returns the curve of the values. Values are rounded down to a ten-thousandth. Of all thresholds those remain between
/// which the fraction of right ones falls: the blocks of an isotonic regression by pooling adjacent violators (Ayer et
/// al. 1955; Zadrozny and Elkan 2002), which are the vertices of the convex hull of the ROC curve (Fawcett and
/// Niculescu-Mizil 2007). Independent of the order of equal values.
PracticeCurve make_practice_curve(std::vector<JudgedValue> values);

/// Estimates a precision from counts: the mean of its posterior under Jeffreys' prior, Beta(1/2, 1/2) (Brown, Cai and
/// DasGupta, "Interval Estimation for a Binomial Proportion", 2001). Between 0 and 1; 0.5 without counts.
double estimate_precision(int right, int wrong);

/// Returns the lowest threshold of the curve with at least this precision; where there is none, the one of the highest
/// precision, of several of these the lowest. `shown` is PracticeRecord::shown. Throws InputError for an empty curve.
OperatingThreshold choose_threshold(const PracticeCurve& curve, int shown, double precision);

/// Returns the most frequent one of PracticeRecord::taken_for; of equals the first by name.
Confusion most_frequent_confusion(const PracticeRecord& record);

/// Returns store.json's record: {"shown", "right", "wrong", "score": {"from": [], "right": [], "wrong": []}, "quality":
/// ..., "taken_for": {NAME: }, "by_distance_m": {"to": [], "shown": [], "found": []}, "by_visible": ...}.
OrderedJson to_json(const PracticeRecord& record);

/// Throws InputError naming `where` for a missing or unknown name, and for numbers that are no counts or thresholds.
PracticeRecord practice_from_json(const nlohmann::json& json, const std::string& where);

}  // namespace houghstream::store
