#include "detector/baseline/gall_profile.hpp"
#include "tools/evaluate/evaluate_main.hpp"
#include "tools/studies/baseline/study_search.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  bool reference = false;
  EvaluateSearch search;
  search.settings = baseline::detection_settings_of;
  search.make = [&](Forest forest, const DetectionSettings& settings) {
    return study_search(std::move(forest), settings, reference);
  };
  search.add_options = [&](CommandLine& app) { add_reference_option(app, reference); };
  return evaluate_main(argc, argv, "hs-study-evaluate", search);
}
