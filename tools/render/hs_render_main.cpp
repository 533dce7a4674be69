#include <CLI/CLI.hpp>
#include <algorithm>
#include <opencv2/core.hpp>
#include <thread>

#include "pipeline/checks.hpp"
#include "tools/render/render_jobs.hpp"

// hs-render: training views, backgrounds and test scenes made by code, in BOP format.

namespace {

struct Arguments {
  houghstream::RenderOptions common;
  std::vector<std::string> objects = {"all"};
  std::vector<std::string> attitudes = {"upright"};
  houghstream::TurntableSettings turntable;
  int background_count = 215;
  std::string scene;
  int frames = 300;
  int every = 1;
};

void add_common(CLI::App& command, Arguments& arguments) {
  command.add_option("--out", arguments.common.out, "folder to write to")->required();
  command.add_option("--threads", arguments.common.threads, "threads to render on")
      ->capture_default_str()
      ->check(CLI::Range(1, 256));
}

void add_commands(CLI::App& app, Arguments& arguments) {
  CLI::App* training = app.add_subcommand("training", "turntable views of the objects, with masks and models");
  add_common(*training, arguments);
  training->add_option("--seed", arguments.common.seed, "of the training rooms")->capture_default_str();
  training->add_option("--objects", arguments.objects, "names, all (the four classes), all_20 (sixteen more) or all_40")
      ->delimiter(',')
      ->capture_default_str();
  training->add_option("--azimuths", arguments.turntable.azimuths, "views a turn")->capture_default_str();
  training->add_option("--pitches", arguments.turntable.pitches, "camera heights")->capture_default_str();
  training->add_option("--distance", arguments.turntable.distance_m, "from the camera to the object, metres")
      ->capture_default_str()
      ->check(CLI::Range(0.3, 3.0));
  training
      ->add_option("--attitudes", arguments.attitudes,
                   "upright, tilted (as if held) and lying (on its sides or upside down; half a turn's views for each)")
      ->delimiter(',')
      ->capture_default_str();
  training->callback([&] {
    arguments.turntable.attitudes.resize(arguments.attitudes.size());
    std::transform(arguments.attitudes.begin(), arguments.attitudes.end(), arguments.turntable.attitudes.begin(),
                   houghstream::parse_attitude);
    render_training(arguments.common, arguments.objects, arguments.turntable);
  });

  CLI::App* background = app.add_subcommand("background", "training rooms without the objects");
  add_common(*background, arguments);
  background->add_option("--seed", arguments.common.seed, "of the training rooms")->capture_default_str();
  background->add_option("--count", arguments.background_count, "frames")->capture_default_str();
  background->callback([&] { render_background(arguments.common, arguments.background_count); });

  CLI::App* scene = app.add_subcommand("scene", "one of the test scenes");
  add_common(*scene, arguments);
  scene->add_option("name", arguments.scene, houghstream::scene_names())->required();
  scene->add_option("--frames", arguments.frames, "frames along the camera's whole way")->capture_default_str();
  scene->add_option("--every", arguments.every, "write only every Nth of them")->capture_default_str();
  scene->callback([&] { render_scene(arguments.common, arguments.scene, arguments.frames, arguments.every); });
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  arguments.common.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  cv::setNumThreads(1);  // frames are rendered in parallel, each on one thread
  CLI::App app("Renders training views, backgrounds and test scenes in BOP format");
  app.set_version_flag("--version", HOUGHSTREAM_VERSION);
  app.require_subcommand(1);
  add_commands(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  } catch (const std::exception& error) {
    fmt::print(stderr, "\nhs-render: {}\n", error.what());
    return 1;
  }
  return 0;
}
