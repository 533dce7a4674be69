#include <algorithm>
#include <opencv2/core.hpp>
#include <thread>

#include "tools/common/tool_main.hpp"
#include "tools/render/render_jobs.hpp"
#include "tools/render/sequence_jobs.hpp"
#include "tools/render/take_jobs.hpp"

// hs-render: training views, backgrounds and test scenes made by code, in BOP format.

using namespace houghstream;
using namespace houghstream::render;

namespace {

struct Arguments {
  RenderOptions common;
  std::vector<std::string> objects = {"all"};
  std::vector<std::string> attitudes = {"upright"};
  world::TurntableSettings turntable;
  int background_count = 215;
  SceneJob scene;
  std::string sensor = "structured_light";
  TakesJob takes;
  SequencesJob sequences;
};

void add_common(CommandLine& command, Arguments& arguments) {
  command.add_option("--out", arguments.common.out, "folder to write to").required();
  command.add_option("--threads", arguments.common.threads, "threads to render on").capture_default_str().range(1, 256);
  command.add_flag("--replace", arguments.common.replace,
                   "pictures and models that are there give way to those rendered");
}

CommandLine add_training(CommandLine& app, Arguments& arguments) {
  CommandLine training = app.add_subcommand("training", "turntable views of the objects, with masks and models");
  add_common(training, arguments);
  training.add_option("--seed", arguments.common.seed, "of the training rooms").capture_default_str();
  training.add_option("--objects", arguments.objects, "names, all (the four classes), all_20 (sixteen more) or all_40")
      .delimiter(',')
      .capture_default_str();
  training.add_option("--azimuths", arguments.turntable.azimuths, "views a turn").capture_default_str();
  training.add_option("--pitches", arguments.turntable.pitches, "camera heights").capture_default_str();
  training.add_option("--distance", arguments.turntable.distance_m, "from the camera to the object, metres")
      .capture_default_str()
      .range(0.3, 3.0);
  training
      .add_option("--attitudes", arguments.attitudes,
                  "upright, tilted (as if held) and lying (on its sides or upside down; half a turn's views for each)")
      .delimiter(',')
      .capture_default_str();
  training.add_example("hs-render training --out VIEWS");
  return training;
}

CommandLine add_background(CommandLine& app, Arguments& arguments) {
  CommandLine background = app.add_subcommand("background", "training rooms without the objects");
  add_common(background, arguments);
  background.add_option("--seed", arguments.common.seed, "of the training rooms").capture_default_str();
  background.add_option("--count", arguments.background_count, "frames").capture_default_str();
  background.add_example("hs-render background --out ROOMS");
  return background;
}

void add_scene(CommandLine& app, Arguments& arguments) {
  CommandLine scene = app.add_subcommand("scene", "one of the test scenes");
  add_common(scene, arguments);
  scene.add_option("name", arguments.scene.name, world::scene_names()).required();
  scene.add_option("--frames", arguments.scene.frames, "frames along the camera's whole way").capture_default_str();
  scene.add_option("--every", arguments.scene.every, "write only every Nth of them").capture_default_str();
  scene
      .add_option("--sensor", arguments.sensor,
                  "structured_light, as everything is taught, or time_of_flight, with another colour camera too")
      .capture_default_str();
  scene.add_example("hs-render scene table_small_1 --out SCENE --every 10");
}

CommandLine add_takes(CommandLine& app, Arguments& arguments) {
  CommandLine takes = app.add_subcommand("takes", "recordings of objects that are shown to a camera, with truth");
  add_common(takes, arguments);
  takes.add_option("--objects", arguments.takes.objects, "names, or all (twelve)").delimiter(',').capture_default_str();
  takes.add_option("--take", arguments.takes.take, "1: upright, 2: laid on its side or turned over; without it both")
      .range(1, 2);
  takes.add_option("--frames", arguments.takes.frames, "of a take, which is one turn").capture_default_str();
  takes.add_option("--fps", arguments.takes.fps, "frames a second").capture_default_str();
  takes.add_option("--world", arguments.takes.world, "another room, light and movement for each number")
      .capture_default_str()
      .range(0, 999);
  takes.add_flag("--development", arguments.takes.development, "rooms to choose settings in, of training seeds");
  takes.add_example("hs-render takes --objects mug --out TAKES");
  return takes;
}

CommandLine add_sequences(CommandLine& app, Arguments& arguments) {
  CommandLine sequences = app.add_subcommand(
      "sequences", "objects that are pushed, carried, taken away and hidden, with the truth of every frame");
  add_common(sequences, arguments);
  sequences
      .add_option("--names", arguments.sequences.names,
                  "walk, pushed, carried, removed, swapped, cans, arm, jerk, cameras, or all")
      .delimiter(',')
      .capture_default_str();
  sequences.add_option("--fps", arguments.sequences.fps, "frames a second").capture_default_str();
  sequences.add_flag("--development", arguments.sequences.development,
                     "rooms to choose settings in, of training seeds");
  sequences.add_example("hs-render sequences --names walk,pushed --out SEQUENCES");
  return sequences;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  arguments.common.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  cv::setNumThreads(1);  // frames are rendered in parallel, each on one thread
  CommandLine app("Renders training views, backgrounds and test scenes in BOP format", "hs-render");
  app.require_subcommand();
  app.add_example("hs-render scene table_small_1 --out SCENE --every 10");
  const CommandLine training = add_training(app, arguments);
  const CommandLine background = add_background(app, arguments);
  const CommandLine takes = add_takes(app, arguments);
  const CommandLine sequences = add_sequences(app, arguments);
  add_scene(app, arguments);
  return run_tool(app, argc, argv, [&] {
    if (training.given()) {
      arguments.turntable.attitudes.clear();
      for (const std::string& name : arguments.attitudes)
        arguments.turntable.attitudes.push_back(world::parse_attitude(name));
      render_training(arguments.common, arguments.objects, arguments.turntable);
    } else if (background.given()) {
      render_background(arguments.common, arguments.background_count);
    } else if (takes.given()) {
      render_takes(arguments.common, arguments.takes);
    } else if (sequences.given()) {
      render_sequences(arguments.common, arguments.sequences);
    } else {
      arguments.scene.sensor = world::parse_sensor(arguments.sensor);
      render_scene(arguments.common, arguments.scene);
    }
  });
}
