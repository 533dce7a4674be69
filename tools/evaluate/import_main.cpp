#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "pipeline/checks.hpp"
#include "tools/evaluate/import_scene.hpp"

int main(int argc, char** argv) {
  CLI::App app{"Turns recorded frames into a scene folder in BOP format.", "hs-import"};
  app.set_version_flag("--version", HOUGHSTREAM_VERSION);
  bool verbose = false;
  app.add_flag("-v,--verbose", verbose, "log more");
  app.require_subcommand(1);

  std::string source;
  std::string scene;
  std::string camera = "640x480,525,525,319.5,239.5";
  CLI::App* boxes = app.add_subcommand("boxes", "frames with boxes drawn by hand (SOURCE/boxes.json)");
  CLI::App* frames = app.add_subcommand("frames", "NAME_color.png with NAME_depth.png, without objects");
  for (CLI::App* command : {boxes, frames}) {
    command->add_option("source", source, "folder with the frames")->required();
    command->add_option("scene", scene, "scene folder to write")->required();
  }
  frames->add_option("--camera", camera, "WIDTHxHEIGHT,fx,fy,cx,cy")->capture_default_str();
  CLI11_PARSE(app, argc, argv);

  spdlog::set_default_logger(spdlog::stderr_color_mt("hs-import"));
  if (verbose) spdlog::set_level(spdlog::level::debug);
  try {
    using namespace houghstream;
    const int count = *boxes ? import_boxes(source, scene) : import_frames(source, parse_camera(camera), scene);
    fmt::print("{} frames in {}\n", count, scene);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
  return 0;
}
