#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/stream/supervisor.hpp"

namespace houghstream::stream {

/// What hs-stream starts.
struct StreamOptions {
  std::filesystem::path executables;  ///< folder of hs-capture, hs-detect, hs-pose, hs-track, hs-view
  std::string source;                 ///< of hs-capture; "" = the frames come from somebody else's driver
  std::string objects;                ///< object store for all of them; "" = forest and models
  std::string forest;                 ///< of hs-detect
  std::string models;                 ///< folder for hs-pose and hs-view; "" = no poses
  std::string camera;                 ///< for frames without a camera of their own
  std::string channel = "OPENNI_FRAME";
  std::string lcm_url;  ///< "" = LCM's default
  bool view = true;
  bool track = false;           ///< hs-track too
  bool follow = false;          ///< hs-pose follows known objects, hs-detect looks a few times a second
  std::string capture_options;  ///< further options, with quotes as in a shell
  std::string detect_options;
  std::string pose_options;
  std::string track_options;
  std::string view_options;
};

/// The processes with their command lines, in the order of the stream. Without models or store there is no hs-pose.
/// Throws InputError where further options have a quote without an end.
std::vector<ChildPlan> plan_stream(const StreamOptions& options);

}  // namespace houghstream::stream
