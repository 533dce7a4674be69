#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "detector/forest/forest_file.hpp"
#include "detector/training/forest_trainer.hpp"
#include "pipeline/checks.hpp"
#include "tools/train/training_sources.hpp"

using namespace houghstream;

namespace {

void add_settings(CLI::App& app, TrainingSettings& training) {
  app.add_option("--seed", training.seed, "same seed, same data: same forest")->capture_default_str();
  app.add_option("--threads", training.threads, "any number gives the same forest")->capture_default_str();
  app.add_option("--trees", training.trees)->capture_default_str()->check(CLI::Range(1, 1000));
  app.add_option("--max-depth", training.max_depth, "levels")->capture_default_str()->check(CLI::Range(1, 60));
  app.add_option("--tests", training.tests_per_node, "random tests tried per node")
      ->capture_default_str()
      ->check(CLI::Range(1, 100000));
  app.add_option("--patches", training.patches_per_view, "patches per training view")
      ->capture_default_str()
      ->check(CLI::Range(4, 100000));
  app.add_option("--composites", training.composites_per_view, "pictures made of one view")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  app.add_option("--min-distance", training.min_distance, "nearest distance taught, metres")->capture_default_str();
  app.add_option("--max-distance", training.max_distance, "farthest distance taught, metres")->capture_default_str();
}

void train(const TrainingSources& sources, const TrainingSettings& training, const std::string& out) {
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const auto progress = [&](const std::string& line) {
    fmt::print(stderr, "hs-train: {:6.1f} s  {}\n", seconds(), line);
  };
  const std::vector<TrainingView> views = read_training_sources(sources);
  progress(fmt::format("{} views and backgrounds read", views.size()));
  const Forest forest = train_forest(views, FeatureSettings{}, PatchSettings{}, training, progress);
  save_forest(forest, out);
  fmt::print("train_seconds {:.1f}\n", seconds());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Teaches objects to a depth-normalised Hough Forest: training views and background in, one forest file out");
  app.set_version_flag("--version", HOUGHSTREAM_VERSION);
  TrainingSources sources;
  TrainingSettings training;
  std::string out;
  app.add_option("--views", sources.views, "training views: bop:DIR or uw:DIR")->required();
  app.add_option("--background", sources.backgrounds,
                 "rooms without the objects: bop:DIR or images:DIR, with the folders below it")
      ->required();
  app.add_option("--instances", sources.instances, "instances of a uw: folder to teach")->delimiter(',');
  app.add_option("--rename", sources.renames, "can_1=can: what an instance is called")->delimiter(',');
  app.add_option("--camera", sources.camera, "WIDTHxHEIGHT,fx,fy,cx,cy, for data that publish none");
  app.add_option("--out", out, "forest file to write")->required();
  add_settings(app, training);
  CLI11_PARSE(app, argc, argv);
  try {
    train(sources, training, out);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "hs-train: {}\n", error.what());
    return 1;
  }
}
