#include "tools/train/train_main.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <optional>

#include "detector/forest/forest_file.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "tools/common/new_output.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/train/support_plane.hpp"
#include "tools/train/training_sources.hpp"

namespace houghstream {
namespace {

/// Options of the command line that override a profile.
struct Overrides {
  std::string profile = "realtime";
  std::string features;
  std::string scale_handling;
  std::optional<float> image_scale;
  std::optional<int> depth_kernel;
  std::optional<int> trees;
  std::optional<int> max_depth;
  std::optional<int> tests;
  std::optional<double> offset_fraction;
  std::optional<double> single_pixel_fraction;
  std::optional<double> shape_single_pixel_fraction;
  std::optional<int> patches;
  std::optional<int> composites;
  std::optional<float> min_distance;
  std::optional<float> max_distance;
  std::uint64_t seed = 1;
  int threads = 2;
};

void add_overrides(CommandLine& app, const TrainProgram& program, Overrides& overrides) {
  using training::TrainingSettings;
  app.add_option("--profile", overrides.profile, fmt::format("to begin with: {}", fmt::join(program.profiles, ", ")))
      .capture_default_str();
  app.add_option("--features", overrides.features, "some of " + family_names(program.families));
  app.add_option("--depth-kernel", overrides.depth_kernel, "of the depth derivatives, working pixels")
      .one_of({3, 5, 7, 9});
  app.add_option("--image-scale", overrides.image_scale, "working size over frame size").range(0.1, 2.0);
  if (program.set_scale_handling)
    app.add_option("--scale-handling", overrides.scale_handling, "five, single or normalised");
  app.add_option("--seed", overrides.seed, "same seed, same data: same forest").capture_default_str();
  app.add_option("--threads", overrides.threads, "any number gives the same forest")
      .range(range_of(&TrainingSettings::threads))
      .capture_default_str();
  app.add_option("--trees", overrides.trees, "trees of the forest").range(range_of(&TrainingSettings::trees));
  app.add_option("--max-depth", overrides.max_depth, "levels").range(range_of(&TrainingSettings::max_depth));
  app.add_option("--tests", overrides.tests, "random tests tried per node, at most")
      .range(range_of(&TrainingSettings::tests_per_node));
  app.add_option("--offset-share", overrides.offset_fraction, "of the nodes are split by offsets, not by labels")
      .range(range_of(&TrainingSettings::offset_fraction));
  app.add_option("--alone-share", overrides.single_pixel_fraction, "of the tests look at one pixel, not at two")
      .range(range_of(&TrainingSettings::single_pixel_fraction));
  app.add_option("--shape-alone-share", overrides.shape_single_pixel_fraction,
                 "at least so many of those on depth features")
      .range(range_of(&TrainingSettings::shape_single_pixel_fraction));
  app.add_option("--patches", overrides.patches, "patches per training view")
      .range(range_of(&TrainingSettings::patches_per_view));
  app.add_option("--composites", overrides.composites, "pictures made of one view")
      .range(range_of(&TrainingSettings::composites_per_view));
  app.add_option("--min-distance", overrides.min_distance, "nearest distance taught, metres")
      .range(range_of(&TrainingSettings::min_distance));
  app.add_option("--max-distance", overrides.max_distance, "farthest distance taught, metres")
      .range(range_of(&TrainingSettings::max_distance));
}

template <typename T>
void take(const std::optional<T>& from, T& to) {
  if (from) to = *from;
}

Profile overridden(const TrainProgram& program, const Overrides& overrides) {
  Profile profile = program.make_profile(overrides.profile);
  if (!overrides.features.empty()) profile.features.families = parse_families(overrides.features);
  if (overrides.image_scale) program.set_image_scale(profile, *overrides.image_scale);
  if (!overrides.scale_handling.empty()) program.set_scale_handling(profile, overrides.scale_handling);
  take(overrides.depth_kernel, profile.features.depth_sobel_px);
  training::TrainingSettings& training = profile.training;
  take(overrides.trees, training.trees);
  take(overrides.max_depth, training.max_depth);
  take(overrides.tests, training.tests_per_node);
  take(overrides.offset_fraction, training.offset_fraction);
  take(overrides.single_pixel_fraction, training.single_pixel_fraction);
  take(overrides.shape_single_pixel_fraction, training.shape_single_pixel_fraction);
  take(overrides.patches, training.patches_per_view);
  take(overrides.patches, training.patches_per_background);
  take(overrides.composites, training.composites_per_view);
  take(overrides.min_distance, training.min_distance);
  take(overrides.max_distance, training.max_distance);
  require(training.min_distance < training.max_distance,
          "--min-distance {}, expected less than the {} of --max-distance", training.min_distance,
          training.max_distance);
  training.seed = overrides.seed;
  training.threads = overrides.threads;
  return profile;
}

/// Returns the profile by which a forest was trained; only seed and threads can be chosen.
Profile profile_for(const Forest& forest, const TrainProgram& program, const Overrides& overrides) {
  Profile profile = program.profile_of(forest);
  profile.training.seed = overrides.seed;
  profile.training.threads = overrides.threads;
  return profile;
}

void train(const TrainingSources& sources, const Profile& profile, const std::optional<Forest>& old,
           const std::string& out, const TrainProgram& program) {
  const training::Scales& scales = program.scales_of(profile.features);
  scales.require_teachable(profile.features, fmt::format("profile '{}'", profile.name));  // before views are read
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const auto progress = [&](const std::string& line) {
    fmt::print(stderr, "{}: {:6.1f} s  {}\n", program.name, seconds(), line);
  };
  std::vector<TrainingView> views = read_training_sources(sources, profile.training.threads);
  const int standing = find_supports(views, profile.training.threads);
  progress(fmt::format("{} views and backgrounds read; in {} an object stands on a plane", views.size(), standing));
  const Forest forest = old ? training::add_objects(*old, std::move(views), profile, progress, scales)
                            : training::train_forest(std::move(views), profile, progress, scales);
  save_forest(forest, out);
  fmt::print("train_seconds {:.1f}\n", seconds());
}

}  // namespace

int train_main(int argc, char** argv, const TrainProgram& program) {
  CommandLine app("Teaches a Hough Forest objects: training views and rooms in, one forest file out", program.name);
  TrainingSources sources;
  Overrides overrides;
  std::string out;
  std::string add_to;
  bool replace = false;
  app.add_option("--views", sources.views, "training views: bop:DIR or uw:DIR").required();
  app.add_option("--background", sources.backgrounds, "rooms without the objects: bop:DIR or images:DIR").required();
  app.add_option("--instances", sources.instances, "instances of a uw: folder to teach").delimiter(',');
  app.add_option("--rename", sources.renames, "can_1=can: what an instance is called").delimiter(',');
  app.add_option("--camera", sources.camera, "WIDTHxHEIGHT,fx,fy,cx,cy, for data without one");
  app.add_option("--out", out, "forest file to write").required();
  app.add_option("--add-to", add_to, "forest that learns them too; its profile counts");
  add_replace_output_option(app, replace, "a file of the name of --out");
  add_overrides(app, program, overrides);
  app.add_example(program.name + " --views bop:VIEWS --background bop:ROOMS --out my.forest");
  return run_tool(app, argc, argv, [&] {
    require_writable(out);
    require_new_output(out, replace);
    std::optional<Forest> old;
    if (!add_to.empty()) old = load_forest(add_to);
    train(sources, old ? profile_for(*old, program, overrides) : overridden(program, overrides), old, out, program);
  });
}

}  // namespace houghstream
