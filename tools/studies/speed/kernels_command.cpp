#include <benchmark/benchmark.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "detector/forest/forest_file.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/finder/search_options.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/speed/kernels.hpp"

namespace {

bool is_for_benchmark(const char* word) {
  return std::string_view(word).substr(0, 12) == "--benchmark_";
}

/// Hands Google Benchmark its own options, and no other: it would answer --help by itself. Returns the rest, and those
/// of its kind that it does not know.
std::vector<char*> without_benchmark_options(std::vector<char*> words) {
  const auto theirs =
      std::stable_partition(words.begin() + 1, words.end(), [](const char* word) { return !is_for_benchmark(word); });
  std::vector<char*> handed = {words.front()};
  handed.insert(handed.end(), theirs, words.end());
  int count = static_cast<int>(handed.size());
  benchmark::Initialize(&count, handed.data());
  words.erase(theirs, words.end());
  words.insert(words.end(), handed.begin() + 1, handed.begin() + count);
  return words;
}

}  // namespace

int houghstream::studies::kernels_command(CommandLine& app, int argc, char** argv) {
  std::vector<char*> words = without_benchmark_options({argv, argv + argc});
  std::string scene_folder;
  std::string forest_file;
  app.add_option("--scene", scene_folder, "BOP scene folder, whose first frame is looked at").required();
  app.add_option("--forest", forest_file, "depth-normalised forest").required();
  app.add_example("hs-study kernels --scene SCENE --forest my.forest --benchmark_filter=vote");
  return run_tool(app, static_cast<int>(words.size()), words.data(), [&] {
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
    const ForestIndex index(forest);
    register_kernels(frame, index, settings);
    benchmark::RunSpecifiedBenchmarks();
  });
}
