#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "pipeline/types/frame.hpp"

namespace houghstream::teach {

/// Options of hs-teach show.
struct ShowOptions {
  std::string source;              ///< log:FILE, bop:DIR, uw:DIR, openni2 ...: what hs-log import and hs-capture read
  std::string second;              ///< a recording of a second take, with the object in another attitude; empty = none
  std::string name;                ///< name of the object
  std::filesystem::path out;       ///< the store
  bool add = false;                ///< adds to the existing store
  bool replace = false;            ///< replaces that store; with neither an existing one is refused before the take
  std::optional<cv::Rect> box;     ///< box of the object in the first frame, pixels; none = nearest to `at`
  std::optional<cv::Point> at;     ///< a place on it there; none = the middle
  std::filesystem::path keep;      ///< folder for model, views, images and report; empty = none
  bool accept_poor_model = false;  ///< teaches a poor model too
  bool teach = true;               ///< false: the model only, the store is left alone
  double max_duration_s = 60.0;    ///< length of a take from a live source
  std::string camera;              ///< WIDTHxHEIGHT,fx,fy,cx,cy of frames that come without; empty = they do not
  std::string channel;             ///< channel of the frames in a log; empty = the first that holds any
  std::filesystem::path backgrounds_cache;  ///< see BackgroundSettings
  std::uint64_t seed = 1;
  int threads = 2;
};

/// The next frame of a take, or nothing at its end.
using ShownFrames = std::function<std::optional<RgbdFrame>()>;

}  // namespace houghstream::teach
