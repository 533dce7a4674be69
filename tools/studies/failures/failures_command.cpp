#include <fmt/format.h>

#include <optional>

#include "detector/stages.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/finder/searched_objects.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/failures/failures.hpp"

namespace {

using namespace houghstream;

struct FailureOptions {
  ObjectArguments known;  ///< its models are unused
  std::vector<std::string> scenes;
  std::string out;
  std::optional<float> operating_score;  ///< default: what hs-detect publishes
  int every = 1;
  int count = 8;
  int columns = 4;
  SearchOptions search;
};

/// Returns an image of each of the scene's gravest failures.
std::vector<cv::Mat> failures_in(const std::string& folder, const Detector& detector, const FailureOptions& options) {
  const BopScene scene(folder);
  std::vector<EvaluatedFrame> frames = every_nth(read_ground_truth(scene, find_bop_names(folder)), options.every);
  DetectorWorkspace workspace;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    frames[f].detections = detector.detect(scene.read_frame(f * static_cast<std::size_t>(options.every)), workspace);
  }
  std::vector<std::string> classes;
  for (const Forest& forest : detector.groups()) {
    for (const ObjectClass& known : forest.classes) classes.push_back(known.name);
  }
  constexpr std::size_t kPartsOfTheWay = 6;
  const std::vector<Failure> selected =
      choose_failures(frames, classes,
                      {DetectionRules{}, *options.operating_score, static_cast<std::size_t>(options.count),
                       frames.size() / kPartsOfTheWay});
  std::vector<cv::Mat> tiles;
  for (const Failure& failure : selected) {
    const RgbdFrame frame = scene.read_frame(failure.frame * static_cast<std::size_t>(options.every));
    tiles.push_back(draw_failure(failure, frame.colour));
  }
  return tiles;
}

void run(const FailureOptions& options) {
  const Detector detector = detector_of(load_named_forests(options.known, options.search.threads), options.search);
  std::vector<cv::Mat> tiles;
  for (const std::string& scene : options.scenes) {
    for (const cv::Mat& tile : failures_in(scene, detector, options)) tiles.push_back(tile);
  }
  write_png(join_tiles(tiles, options.columns), options.out);
  fmt::print("{} failures in {}\n", tiles.size(), options.out);
}

/// Returns the options with the store's forest, where one is named, and with hs-detect's defaults.
FailureOptions with_store(FailureOptions options) {
  require(options.known.store.empty() == !options.known.forest.empty(),
          "expected either --objects STORE or --forest FILE");
  options.operating_score = options.operating_score.value_or(EvidenceSettings{}.threshold);
  resolve_store(options.known);
  return options;
}

}  // namespace

int houghstream::studies::failures_command(CommandLine& app, int argc, char** argv) {
  FailureOptions options;
  app.add_option("--objects", options.known.store, "object store of hs-teach, instead of --forest");
  app.add_option("--forest", options.known.forest, "forest file");
  app.add_option("--scene", options.scenes, "BOP scene folder with the truth; may be given several times").required();
  app.add_option("--out", options.out, "picture to write, PNG").required();
  app.add_option("--count", options.count, "failures of each scene").range(1, 100).capture_default_str();
  app.add_option("--columns", options.columns, "pictures in a row").range(1, 20).capture_default_str();
  app.add_option("--every", options.every, "look at every Nth frame only").range(1, 100000).capture_default_str();
  app.add_option("--operating-score", options.operating_score,
                 "score from which a detection counts; default: what hs-detect publishes")
      .range(0.0, 1.0);
  add_search_options(app, options.search);
  app.add_example("hs-study failures --forest my.forest --scene SCENE --out failures.png");
  return run_tool(app, argc, argv, [&] { run(with_store(options)); });
}
