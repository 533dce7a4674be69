#pragma once

#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

/// Whether an object is there: log odds that grow and fall with what is seen. Rates are per second of a camera's
/// frames: frames that follow one another closely show the same errors and say little new.
struct ExistenceSettings {
  double prior = -1.5;           ///< of what was never seen before
  double gain = 0.5;             ///< of a pose's own log odds, at 30 Hz
  double most = 6.0;             ///< however often it was seen
  double confirmed = 2.2;        ///< published from here on,
  int confirmed_frames = 3;      ///< seen in so many frames,
  double confirmed_s = 0.08;     ///< so long apart
  double gone = -1.0;            ///< below it is gone
  double seen_through = 30.0;    ///< a second, where the camera sees through it
  double displaced_rate = 12.0;  ///< a second, where another class is recognised in its place
  double goes_on = 3.0;          ///< a second, where depth agrees but the surface is larger
  double unrecognised = 0.6;     ///< a second, where depth agrees but nothing is recognised
  double lost = 14.0;            ///< a second, where it moved when it was seen last; hidden, a quarter of it
  double unconfirmed = 4.0;      ///< a second, of what is not yet published and not seen
};

template <typename Visit>
void fields(const ExistenceSettings& /*settings*/, const Visit& visit) {
  using S = ExistenceSettings;
  visit(number("prior", &S::prior, -100, 100));
  visit(number("gain", &S::gain, 0, 1000));
  visit(number("most", &S::most, 0, 1000));
  visit(number("confirmed", &S::confirmed, -100, 100));
  visit(number("confirmed_frames", &S::confirmed_frames, 0, 100000));
  visit(number("confirmed_s", &S::confirmed_s, 0, 3600, "s"));
  visit(number("gone", &S::gone, -100, 100));
  visit(number("seen_through", &S::seen_through, 0, 1e6, "1/s"));
  visit(number("displaced_rate", &S::displaced_rate, 0, 1e6, "1/s"));
  visit(number("goes_on", &S::goes_on, 0, 1e6, "1/s"));
  visit(number("unrecognised", &S::unrecognised, 0, 1e6, "1/s"));
  visit(number("lost", &S::lost, 0, 1e6, "1/s"));
  visit(number("unconfirmed", &S::unconfirmed, 0, 1e6, "1/s"));
}

/// A result, beside which objects are laid of which it has no pose.
struct UnobservedContext {
  const FrameObservation& seen;
  const std::vector<PoseObservation>& poses;  ///< that are new in it
  const TrackModels& models;
  double reach_m = 0.0;  ///< so near to where its class's detections have their centre, one is of the object
  double coast_s = 0.0;  ///< MotionSettings::coast_s
};

/// What a result counts for an object of which it has no pose.
struct MissedDetection {
  double seconds = 0.0;         ///< since the camera's frame before
  bool by_depth = false;        ///< it is the first one of its frame
  bool by_recognition = false;  ///< it is the first one of its frame that speaks of the class
};

/// What the frame says of an object that it shows no pose of: its log odds fall, it may be gone, and where the camera
/// has the word, its state and the reason are told.
void update_unobserved(const UnobservedContext& frame, const MissedDetection& missed, const ExistenceSettings& how,
                       Track& track);

}  // namespace houghstream::tracks
