#include <fmt/format.h>

#include "detector/baseline/gall_profile.hpp"
#include "detector/baseline/hough_images.hpp"
#include "detector/forest/forest_file.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/evaluate/metrics/detection_metrics.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/studies/baseline/study_search.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/hough/hough_panels.hpp"
#include "tools/view/drawing/overlay.hpp"

namespace {

using namespace houghstream;

struct HoughOptions {
  std::string forest;
  std::string scene;
  std::string out;
  int frame = 0;
  SearchOptions search;
  bool reference = false;
};

/// A class is drawn in one colour, whatever number the scene knows it by; one that was not taught is grey.
cv::Scalar colour_of(const Forest& forest, const std::string& class_name) {
  for (const ObjectClass& known : forest.classes) {
    if (known.name == class_name) return view::class_colour(known.class_id);
  }
  return {170, 170, 170};
}

/// Returns the objects that are visible enough to be required of a detector.
std::vector<NamedBox> ground_truth_boxes(const EvaluatedFrame& frame, const Forest& forest) {
  std::vector<NamedBox> boxes;
  for (const NamedObject& object : frame.objects) {
    if (object.truth.visible_fraction < DetectionRules{}.min_visible) continue;
    boxes.push_back({object.truth.box_visible_px, object.class_name, colour_of(forest, object.class_name)});
  }
  return boxes;
}

std::vector<HoughPanel> search(const Forest& forest, const RgbdFrame& frame, const HoughOptions& options) {
  const DetectionSettings settings = options.search.change(baseline::detection_settings_of(forest));
  const ForestIndex index(forest);
  const SearchContext by{index, settings};
  const baseline::Way way = way_of(options.reference);
  const Detections found = baseline::StudyDetector(forest, settings, way).detect(frame);
  std::vector<HoughPanel> panels;
  for (std::size_t c = 0; c < forest.classes.size(); ++c) {
    const ObjectClass& object = forest.classes[c];
    HoughPanel panel{object.name, baseline::hough_image(by, static_cast<int>(c), frame), {}};
    for (const Detection& detection : found.detections) {
      if (detection.class_id != object.class_id) continue;
      panel.found.push_back(
          {detection.box_px, fmt::format("{:.2f}", detection.score), view::class_colour(object.class_id)});
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

void run(const HoughOptions& options) {
  for (const std::string& input : {options.scene, options.forest}) require_other_file(options.out, input);
  const BopScene scene(options.scene);
  const int last = static_cast<int>(scene.images().size()) - 1;
  require(options.frame >= 0 && options.frame <= last, "{}: --frame {}, expected 0 to {}", options.scene, options.frame,
          last);
  const auto index = static_cast<std::size_t>(options.frame);
  const EvaluatedFrame truth = read_ground_truth(scene, find_bop_names(options.scene))[index];
  const Forest forest = load_forest(options.forest);
  const RgbdFrame frame = scene.read_frame(index);
  const std::vector<HoughPanel> panels = search(forest, frame, options);
  write_png(draw_hough_panels(frame.colour, ground_truth_boxes(truth, forest), panels), options.out);
}

}  // namespace

int houghstream::studies::hough_command(CommandLine& app, int argc, char** argv) {
  HoughOptions options;
  app.add_option("--forest", options.forest, "forest file").required();
  app.add_option("--scene", options.scene, "BOP scene folder with the truth").required();
  app.add_option("--frame", options.frame, "position in the scene, from 0").required();
  app.add_option("--out", options.out, "picture to write, PNG").required();
  add_search_options(app, options.search);
  add_reference_option(app, options.reference);
  app.add_example("hs-study hough --forest my.forest --scene SCENE --frame 0 --out votes.png");
  return run_tool(app, argc, argv, [&] { run(options); });
}
