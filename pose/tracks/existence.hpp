#pragma once

#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

/// Existence of an object as log odds, which grow and fall with what is observed. Rates are per second of a camera's
/// frames: frames that follow one another closely show the same errors and add little information.
struct ExistenceSettings {
  double prior = -1.5;               ///< log odds of an object at its first pose, before that pose counts
  double gain = 0.5;                 ///< factor of a pose's own log odds, at 30 Hz
  double max_log_odds = 6.0;         ///< limit, however often an object was observed
  double confirm_log_odds = 2.2;     ///< log odds from which a candidate is confirmed
  int min_frames = 3;                ///< minimum number of frames with a pose for that
  double min_duration_s = 0.08;      ///< minimum time between first and last pose for that, seconds
  double delete_log_odds = -1.0;     ///< log odds below which an object is gone
  double free_space_rate = 30.0;     ///< 1/s, where the camera sees through it
  double replaced_rate = 12.0;       ///< 1/s, where another class is recognised in its place
  double continuation_rate = 3.0;    ///< 1/s, where depth agrees, but the surface is larger than the object
  double missed_rate = 0.6;          ///< 1/s, where depth agrees, but nothing is recognised
  double moving_missed_rate = 14.0;  ///< 1/s, where it moved when it was observed last; a quarter of it while occluded
  double candidate_rate = 4.0;       ///< 1/s, of a candidate that is not published yet and not observed
};

template <typename Visit>
void fields(const ExistenceSettings& /*settings*/, const Visit& visit) {
  using S = ExistenceSettings;
  visit(number("prior", &S::prior, -100, 100));
  visit(number("gain", &S::gain, 0, 1000));
  visit(number("max_log_odds", &S::max_log_odds, 0, 1000));
  visit(number("confirm_log_odds", &S::confirm_log_odds, -100, 100));
  visit(number("min_frames", &S::min_frames, 0, 100000));
  visit(number("min_duration_s", &S::min_duration_s, 0, 3600, "s"));
  visit(number("delete_log_odds", &S::delete_log_odds, -100, 100));
  visit(number("free_space_rate", &S::free_space_rate, 0, 1e6, "1/s"));
  visit(number("displaced_rate", &S::replaced_rate, 0, 1e6, "1/s"));
  visit(number("continuation_rate", &S::continuation_rate, 0, 1e6, "1/s"));
  visit(number("missed_rate", &S::missed_rate, 0, 1e6, "1/s"));
  visit(number("moving_missed_rate", &S::moving_missed_rate, 0, 1e6, "1/s"));
  visit(number("tentative_rate", &S::candidate_rate, 0, 1e6, "1/s"));
}

/// Inputs for updating tracks without a pose in one result.
struct UnobservedContext {
  const FrameObservation& observation;
  const std::vector<PoseObservation>& poses;  ///< poses that are new in this result
  const TrackModels& models;
  double reach_m = 0.0;  ///< distance below which a detection of the class is one of the object, metres
  double coast_s = 0.0;  ///< MotionSettings::coast_s: time for which a moving object continues unobserved
};

/// Evidence that one result gives against an unobserved track: which kinds of it count, and the time by which the
/// rates of ExistenceSettings are multiplied.
struct AbsenceEvidence {
  double dt_s = 0.0;            ///< CameraClock::dt_s: time since the camera's previous frame, limited
  bool by_depth = false;        ///< whether depth counts: only for the first result of a frame
  bool by_recognition = false;  ///< whether the missing pose counts: only for the first result that searched the class
};

/// Updates a track that received no measurement in this frame: lowers the log odds of its existence and deletes it
/// below the threshold. State and reason change only if it is deleted, this camera observed the object last, or no
/// camera has for 0.1 s.
void update_unobserved(const UnobservedContext& context, const AbsenceEvidence& absence,
                       const ExistenceSettings& settings, Track& track);

}  // namespace houghstream::tracks
