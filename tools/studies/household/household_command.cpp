#include "tools/common/tool_main.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/household/household_scenes.hpp"

int houghstream::studies::household_command(CommandLine& app, int argc, char** argv) {
  household::SceneSettings settings;
  app.add_option("--models", settings.models, "BOP models folder").required();
  app.add_option("--ids", settings.ids, "2,5: only these of its objects; default all").delimiter(',');
  app.add_option("--out", settings.out, "folder to write BOP scenes to").required();
  app.add_option("--rooms", settings.rooms, "rooms, each a scene").range(1, 1000).capture_default_str();
  app.add_option("--frames", settings.frames, "frames of a room").range(1, 100).capture_default_str();
  app.add_option("--min-objects", settings.min_objects, "least number of objects that a room is meant to hold")
      .range(1, 100)
      .capture_default_str();
  app.add_option("--max-objects", settings.max_objects, "largest number of them").range(1, 100).capture_default_str();
  app.add_option("--seed", settings.seed, "of the rooms and of what stands in them").capture_default_str();
  app.add_option("--threads", settings.threads, "any number gives the same files").range(1, 64).capture_default_str();
  app.add_example("hs-study household --models DIR/models --out SCENES");
  return run_tool(app, argc, argv, [&] { household::render_scenes(settings); });
}
