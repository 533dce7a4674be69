#include "detector/baseline/gall_profile.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/evaluate/evaluate_main.hpp"
#include "tools/studies/baseline/study_search.hpp"
#include "tools/studies/commands.hpp"

int houghstream::studies::evaluate_command(CommandLine& app, int argc, char** argv) {
  bool reference = false;
  EvaluateSearch search;
  search.settings = baseline::detection_settings_of;
  search.make = [&](std::vector<Forest> groups, const DetectionSettings& settings) {
    require(groups.size() == 1, "a store of {} groups, expected one of one group: hs-evaluate searches several",
            groups.size());
    return study_search(std::move(groups.front()), settings, reference);
  };
  search.add_options = [&](CommandLine& line) { add_reference_option(line, reference); };
  return evaluate_main(argc, argv, app.name(), search);
}
