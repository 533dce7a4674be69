#pragma once

#include <functional>
#include <string>

#include "tools/common/command_line.hpp"
#include "tools/evaluate/in_process.hpp"

namespace houghstream {

/// Settings of a search in the same process.
struct EvaluateSearch {
  /// Returns the settings with which a forest is searched.
  std::function<DetectionSettings(const Forest&)> settings = [](const Forest& it) { return detection_settings(it); };
  MakeSearch make = detector_search;
  /// Adds its own options, beside those of all searches.
  std::function<void(CommandLine& app)> add_options = [](CommandLine&) {};
};

/// Runs hs-evaluate, and under another name, with a search of its own, hs-study evaluate.
int evaluate_main(int argc, char** argv, const std::string& name, const EvaluateSearch& search = {});

}  // namespace houghstream
