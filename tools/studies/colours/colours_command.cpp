#include <fmt/format.h>

#include "tools/common/tool_main.hpp"
#include "tools/studies/colours/colour_study.hpp"
#include "tools/studies/commands.hpp"

int houghstream::studies::colours_command(CommandLine& app, int argc, char** argv) {
  colours::StudySettings settings;
  std::string store;
  app.add_option("--objects", store, "store of hs-teach").required();
  app.add_option("--practice-rooms", settings.rooms, "rendered, two frames each").range(1, 100).capture_default_str();
  app.add_option("--cameras", settings.cameras, "of strange colours").range(1, 1000).capture_default_str();
  app.add_option("--seed", settings.seed, "of rooms and cameras").capture_default_str();
  app.add_option("--threads", settings.threads, "any number gives the same figures").range(1, 64).capture_default_str();
  app.add_option("--pairs", settings.pairs, "CSV file with the colours of each pose");
  app.add_example("hs-study colours --objects my.store");
  return run_tool(app, argc, argv,
                  [&] { fmt::print("{}", colours::to_table(colours::study_cameras(store, settings))); });
}
