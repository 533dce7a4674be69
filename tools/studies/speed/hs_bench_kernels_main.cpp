#include <benchmark/benchmark.h>

#include "detector/forest/forest_file.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/common/search_options.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/studies/speed/kernels.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  benchmark::Initialize(&argc, argv);  // takes its own options, --benchmark_*, away
  CommandLine app("Google Benchmarks of what a frame goes through, on one thread; takes --benchmark_* too",
                  "hs-bench-kernels");
  std::string scene_folder;
  std::string forest_file;
  app.add_option("--scene", scene_folder, "BOP scene folder, whose first frame is looked at").required();
  app.add_option("--forest", forest_file, "depth-normalised forest").required();
  return run_tool(app, argc, argv, [&] {
    const Forest forest = load_forest(forest_file);
    require(forest.features.handling == ScaleHandling::kDepthNormalised,
            "{}: searches a scale space, expected a forest "
            "that is depth-normalised",
            forest_file);
    const BopScene scene{scene_folder};
    require(!scene.images().empty(), "{}: no frames", scene_folder);
    const RgbdFrame frame = scene.read_frame(0);
    SearchOptions search;
    search.threads = 1;
    const DetectionSettings settings = search.settings_for(forest);
    register_kernels(frame, forest, settings);
    benchmark::RunSpecifiedBenchmarks();
  });
}
