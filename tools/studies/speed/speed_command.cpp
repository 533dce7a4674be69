#include <hwy/targets.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/studies/baselines/linemod_detector.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/speed/speed_bench.hpp"
#include "tools/train/training_sources.hpp"

namespace {

using namespace houghstream;

struct SpeedOptions {
  std::string scene;
  std::string out;
  std::size_t every = 1;
  std::vector<std::string> detectors;
  TrainingSources linemod_views;
  LinemodTemplateSettings linemod;
  std::size_t linemod_frames = SIZE_MAX;
  bool list_sets = false;
};

/// Makes OpenCV's LINEMOD, with templates of the views at the given distances.
BenchmarkedDetector make_linemod(const SpeedOptions& options) {
  const std::vector<TrainingView> views = read_training_sources(options.linemod_views);
  const auto linemod = std::make_shared<const LinemodDetector>(views, options.linemod, LinemodSelection{});
  log_info("LINEMOD: {} templates", linemod->training().templates);
  BenchmarkedDetector contender;
  contender.name = "linemod";
  contender.frames = options.linemod_frames;
  contender.detect = [linemod](const RgbdFrame& frame) { return linemod->detect(frame); };
  return contender;
}

void list_instruction_sets() {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) fmt::print("{}\n", hwy::TargetName(target));
}

void run(const SpeedOptions& options) {
  require(!options.scene.empty() && !options.out.empty(), "expected --scene and --out, or --instruction-sets");
  const BopScene scene(options.scene);
  std::vector<RgbdFrame> frames;
  for (std::size_t i = 0; i < scene.images().size(); i += options.every) frames.push_back(scene.read_frame(i));
  std::vector<BenchmarkedDetector> contenders;
  for (const std::string& text : options.detectors) contenders.push_back(parse_contender(text));
  if (!options.linemod_views.views.empty()) contenders.push_back(make_linemod(options));
  require(!contenders.empty(), "nothing to measure: expected --detector or --linemod-views");
  const std::vector<SpeedResult> results = measure_speed(contenders, frames);
  std::ofstream out(options.out);
  out << to_json(contenders, results).dump(2) << "\n" << std::flush;
  require(out.good(), "{}: cannot be written", options.out);
  fmt::print("{}", speed_table(contenders, results));
}

}  // namespace

int houghstream::studies::speed_command(CommandLine& app, int argc, char** argv) {
  SpeedOptions options;
  app.add_option("--scene", options.scene, "BOP scene folder");
  app.add_option("--every", options.every, "look at every Nth frame only").range(1, 100000).capture_default_str();
  app.add_option("--detector", options.detectors,
                 "NAME=FOREST[,threads=N][,reference][,set=AVX2][,frames=N][,trees=N][,scale=X]"
                 "[,threshold=X][,min-mass=X]; may be given again");
  app.add_option("--linemod-views", options.linemod_views.views, "measure LINEMOD taught by these views: bop:DIR");
  app.add_option("--linemod-frames", options.linemod_frames, "so many frames only");
  app.add_option("--min-distance", options.linemod.min_distance, "LINEMOD's nearest, metres").capture_default_str();
  app.add_option("--max-distance", options.linemod.max_distance, "LINEMOD's farthest, metres").capture_default_str();
  app.add_option("--linemod-threads", options.linemod.threads).capture_default_str();
  app.add_option("--out", options.out, "JSON file to write");
  app.add_flag("--instruction-sets", options.list_sets, "list those that this processor has, and end");
  app.add_example("hs-study speed --scene SCENE --detector ours=my.forest --detector one=my.forest,threads=1");
  return run_tool(app, argc, argv, [&] { options.list_sets ? list_instruction_sets() : run(options); });
}
