#include <fmt/format.h>

#include "detector/forest/forest_file.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pose/model/symmetry_search.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/fuse/model_image.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/recorded/pose_sheets.hpp"
#include "tools/studies/recorded/real_bench.hpp"

namespace {

using namespace houghstream;

struct BenchOptions {
  std::string scenes;
  std::string forest;
  std::string models;
  double model_unit_m = 1e-3;
  std::string object = "ornament_3";
  std::string scan;
  double base_mm = 8.0;
  std::string references;
  std::filesystem::path out;
  SearchOptions search;
};

ComparedObject read_object(const BenchOptions& options, const view::ClassModels& models) {
  const auto fused = models.find(options.object);
  require(fused != models.end(), "{}: no model of {}", options.models, options.object);
  ComparedObject object;
  object.class_name = options.object;
  object.scan = fit_scan(load_mesh(options.scan), fused->second, 1e-3 * options.base_mm);
  object.symmetries = find_symmetries(object.scan.mesh);
  object.references = read_reference_poses(options.references);
  return object;
}

void run(const BenchOptions& options) {
  view::ClassModels models = load_class_models(options.models, options.model_unit_m);
  const ComparedObject object = read_object(options, models);
  models[options.object] = object.scan.mesh;
  Forest forest = load_forest(options.forest);
  const Detector detector = detector_of(std::move(forest), options.search);
  PoseSettings pose_settings;
  pose_settings.threads = options.search.threads;
  const PoseEstimator estimator(models, pose_settings);
  pose_settings.min_score = 0.0F;
  const PoseEstimator unchecked(models, without_rejection(pose_settings));
  const DrawnBoxes drawn = read_drawn_boxes(std::filesystem::path(options.scenes) / "boxes.json");
  const RealBench bench = run_real_bench(options.scenes, drawn, {detector, estimator, unchecked, models}, object);
  std::filesystem::create_directories(options.out);
  write_json(to_json(bench, object), options.out / "poses.json");
  write_png(draw_model(object.scan.mesh), options.out / (options.object + ".png"));
  int sheet = 0;
  for (const cv::Mat& image : make_sheets(bench.images)) {
    write_png(image, options.out / fmt::format("sheet_{}.png", ++sheet));
  }
  const AgreementSummary summary = summarise(bench.compared);
  fmt::print("{}: {} of {} frames within 5 mm and 5 degrees, {} with a pose; pictures in {}\n", options.object,
             summary.within_5mm_5deg, summary.frames, summary.with_pose, options.out.string());
}

}  // namespace

int houghstream::studies::recorded_command(CommandLine& app, int argc, char** argv) {
  BenchOptions options;
  app.add_option("--scenes", options.scenes, "folder of FRAME_color.png with FRAME_depth.png, and boxes.json")
      .required();
  app.add_option("--forest", options.forest, "forest file").required();
  add_model_options(app, options.models, options.model_unit_m);
  app.get_option("--models").required();
  app.add_option("--object", options.object, "class whose poses are compared; --models needs its fused model")
      .capture_default_str();
  app.add_option("--scan", options.scan, "its scanned mesh, millimetres, the frame of the reference poses").required();
  app.add_option("--base-mm", options.base_mm, "what of the scan is lower above its base is dropped")
      .non_negative()
      .capture_default_str();
  app.add_option("--references", options.references, "JSON with its reference poses").required();
  app.add_option("--out", options.out, "folder for poses.json, sheet_N.png and a picture of the scan").required();
  add_search_options(app, options.search);
  app.add_example(
      "hs-study recorded --scenes SCENES --forest my.forest --models MODELS --scan scan.ply --references poses.json "
      "--out "
      "OUT");
  return run_tool(app, argc, argv, [&] { run(options); });
}
