#include <string>

#include "pipeline/base/checks.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/studies/commands.hpp"

namespace {

using namespace houghstream;

struct Study {
  const char* name;
  const char* words;  ///< description for --help
  int (*command)(CommandLine&, int, char**);
};

constexpr Study kStudies[] = {
    {"train", "hs-train with the original Hough Forest (--profile gall) and the surface features",
     studies::train_command},
    {"evaluate", "hs-evaluate for such forests, and by the slow reference (--reference)", studies::evaluate_command},
    {"linemod", "Teaches objects to OpenCV's LINEMOD and measures it in scenes of known truth",
     studies::linemod_command},
    {"hough", "Draws the votes for each class over a frame of a scene, with what was found and what is true",
     studies::hough_command},
    {"failures", "Shows the gravest failures of a forest in scenes: false detections and missed objects",
     studies::failures_command},
    {"terms", "Shows which terms push the scores of true objects down, groups of scenes side by side",
     studies::terms_command},
    {"colours",
     "Measures what cameras of strange colours cost in rendered rooms, and what learning their colours brings back",
     studies::colours_command},
    {"household", "Renders furnished rooms in which objects that are taught and others stand together, with the truth",
     studies::household_command},
    {"quality", "Learns QualitySettings, by which a pose's evidence becomes the probability that it is right",
     studies::quality_command},
    {"pose", "Measures poses on rendered scenes: ours, PCL's ICP from the same starts, and two other methods",
     studies::pose_command},
    {"recorded", "Estimates poses in recorded frames, compares one object's with reference poses and draws all",
     studies::recorded_command},
    {"speed", "Measures what detectors take for the frames of a scene, side by side", studies::speed_command},
    {"kernels",
     "Google Benchmarks of what a frame goes through, on one thread; takes Google Benchmark's own options, "
     "--benchmark_filter=REGEX and others, too",
     studies::kernels_command},
    {"shown", "Compares what hs-teach show made of rendered takes with the truth", studies::shown_command},
    {"tracks", "Logs of rendered sequences, and objects over time beside their truth", studies::tracks_command},
};

/// Handles a first word that names no study: prints help, the version, or the error.
int no_study(int argc, char** argv) {
  CommandLine app("Runs one of the studies: what exists for comparisons only", "hs-study");
  for (const Study& study : kStudies) app.add_subcommand(study.name, study.words);
  app.require_subcommand();
  app.add_example("hs-study pose --help");
  return run_tool(app, argc, argv, [] { fail("the name of the study stands first: hs-study NAME --help"); });
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  for (const Study& study : kStudies) {
    if (name != study.name) continue;
    CommandLine app(study.words, "hs-study " + name);
    return study.command(app, argc - 1, argv + 1);
  }
  return no_study(argc, argv);
}
