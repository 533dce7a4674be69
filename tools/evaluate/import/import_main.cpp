#include <fmt/format.h>

#include "tools/common/tool_main.hpp"
#include "tools/evaluate/import/import_scene.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  CommandLine app("Turns annotated frames into a scene folder in BOP format (frames alone: hs-log export bop)",
                  "hs-import");
  app.require_subcommand();
  std::string source;
  std::string scene;
  std::string camera = "640x480,525,525,319.5,239.5";
  CommandLine boxes = app.add_subcommand("boxes", "frames with boxes drawn by hand (SOURCE/boxes.json)");
  CommandLine uw_scene = app.add_subcommand("uw-scene", "SCENE/SCENE_K of the UW RGB-D Scenes Dataset, with its boxes");
  for (CommandLine command : {boxes, uw_scene}) {
    command.add_option("source", source, "folder with the frames").required();
    command.add_option("scene", scene, "scene folder to write").required();
  }
  boxes.add_example("hs-import boxes FRAMES SCENE");
  uw_scene.add_example("hs-import uw-scene DIR/desk/desk_1 SCENE");
  uw_scene.add_option("--camera", camera, "WIDTHxHEIGHT,fx,fy,cx,cy").capture_default_str();
  app.add_example("hs-import uw-scene DIR/desk/desk_1 SCENE");
  return run_tool(app, argc, argv, [&] {
    const int count =
        boxes.given() ? import_boxes(source, scene) : import_uw_scene(source, parse_camera(camera), scene);
    fmt::print("{} frames in {}\n", count, scene);
  });
}
