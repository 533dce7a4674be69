#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/stream/supervisor.hpp"

namespace houghstream::stream {

/// Splits a text into words as a shell does: by blanks, except for those within '...', within "..." and behind a
/// backslash. Throws InputError that names `source` where a quote has no end or nothing follows a backslash.
std::vector<std::string> shell_words(const std::string& text, const std::string& source);

/// Processes that hs-stream starts.
struct StreamOptions {
  std::filesystem::path executables;  ///< folder of hs-capture, hs-detect, hs-pose, hs-track, hs-view
  /// Source of hs-capture; "" = the frames come from another driver. For several cameras it is CHANNEL=SOURCE for each,
  /// with quotes as in a shell.
  std::string source;
  std::string objects;                ///< object store for all of them; "" = forest and models
  std::string forest;                 ///< forest of hs-detect
  std::string models;                 ///< folder for hs-pose and hs-view; "" = no poses
  std::string camera;                 ///< camera of frames without one of their own
  std::string cameras;                ///< camera poses of hs-track, a file
  std::optional<double> threshold;    ///< minimum score that hs-detect reports
  std::optional<double> min_quality;  ///< minimum quality of poses that hs-pose publishes
  std::optional<double> precision;    ///< instead of both, with a store: what hs-detect and hs-pose choose them for
  std::string channel = "OPENNI_FRAME";
  std::string lcm_url;  ///< "" = LCM's default
  bool view = true;
  bool track = false;           ///< hs-track too; so it is where `cameras` is given
  bool follow = false;          ///< hs-pose follows known objects, hs-detect looks a few times a second
  std::string capture_options;  ///< further options, with quotes as in a shell
  std::string detect_options;
  std::string pose_options;
  std::string track_options;
  std::string view_options;
};

/// Returns the processes with their command lines, in the order of the stream. Without models or store there is no
/// hs-pose. Throws InputError where further options have a quote without an end, or the sources of several cameras lack
/// a channel of their own.
std::vector<ChildPlan> plan_stream(const StreamOptions& options);

}  // namespace houghstream::stream
