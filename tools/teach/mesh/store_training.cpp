#include "tools/teach/mesh/store_training.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "detector/training/forest_trainer.hpp"
#include "drivers/datasets/object_pixels.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/heap_memory.hpp"
#include "pipeline/base/parallel.hpp"
#include "pose/model/symmetry_search.hpp"
#include "tools/common/progress_line.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using store::ObjectStore;
using store::StoredObject;

/// Returns the number of views of each of so many objects: the fewer, the more there is time and memory for.
int views_per_object(std::size_t objects) {
  constexpr int kMaxViewsOfAll = 12600;
  constexpr int kMin = 1280;
  constexpr int kMax = 2200;
  return std::clamp(kMaxViewsOfAll / static_cast<int>(objects), kMin, kMax);
}

/// Returns the middle of an object's box, so that the place of a mesh's origin, at a corner or a metre beside it, makes
/// no difference.
Eigen::Vector3f vote_centre_of(const Mesh& mesh) {
  return mesh_bounds(mesh).center();
}

/// Moves the origin of the object frame to its centre, since votes are for the origin of a view's pose.
void move_origins_to(const Eigen::Vector3f& centre, std::vector<TrainingView>& views) {
  for (TrainingView& view : views) view.T_camera_object.translate(centre.cast<double>());
}

/// Renders training views of a mesh; those that show no depth of it are left out.
std::vector<TrainingView> render_views(const TaughtMesh& taught, const TeachOptions& options, int maximum) {
  world::MeshViewSettings settings = options.views;
  settings.max_views = std::min(settings.max_views, maximum);
  settings.attitudes = world::parse_mesh_attitudes(options.attitudes);
  settings.has_colour = taught.coloured;
  const world::MeshViews rendered(taught.mesh, settings,
                                  options.seed * 1000003U + static_cast<std::uint64_t>(taught.id));
  std::vector<TrainingView> views(static_cast<std::size_t>(rendered.count()));
  parallel_for(options.threads, rendered.count(), [&](int i) {
    TrainingView& view = views[static_cast<std::size_t>(i)];
    view = rendered.render(i);
    view.class_id = taught.id;
    view.class_name = taught.name;
    view.source = fmt::format("{} view {}", taught.file.string(), i);
  });
  const auto shows_nothing = [](const TrainingView& view) {
    return count_depth_pixels(view.frame.depth, view.mask) == 0;
  };
  views.erase(std::remove_if(views.begin(), views.end(), shows_nothing), views.end());
  require(!views.empty(), "{}: no view of it shows any depth, expected an object that a camera sees",
          taught.file.string());
  return views;
}

/// Writes the views of one object as a scene folder in BOP format.
void dump_views(const std::vector<TrainingView>& views, const fs::path& folder) {
  BopWriter writer(folder);
  for (const TrainingView& view : views) {
    GroundTruthObject object;
    object.object_id = view.class_id;
    object.T_camera_object = view.T_camera_object;
    object.box_visible_px = cv::boundingRect(view.mask);
    writer.add(view.frame, {object}, {view.mask});
  }
  writer.finish();
}

int max_views(const std::vector<TrainingView>& views) {
  std::map<int, int> counts;
  for (const TrainingView& view : views) counts[view.class_id] += view.class_id > 0 ? 1 : 0;
  int maximum = 1;
  for (const auto& [class_id, count] : counts) maximum = std::max(maximum, count);
  return maximum;
}

}  // namespace

std::vector<NamedModel> models_of(const std::vector<TaughtMesh>& meshes) {
  std::vector<NamedModel> models;
  models.reserve(meshes.size());
  for (const TaughtMesh& taught : meshes) models.push_back({taught.id, taught.name, taught.mesh, taught.symmetries});
  return models;
}

std::vector<TrainingView> make_views(const std::vector<TaughtMesh>& meshes, const TeachOptions& options,
                                     ObjectStore& new_store, const std::function<void(const std::string&)>& report) {
  std::vector<TrainingView> all;
  ProgressLine line("objects rendered", static_cast<double>(meshes.size()));
  for (const TaughtMesh& taught : meshes) {
    std::vector<TrainingView> views = render_views(taught, options, views_per_object(meshes.size()));
    for (const TrainingView& own : options.own_views) {
      if (own.class_name != taught.name) continue;
      views.push_back(own);
      views.back().class_id = taught.id;
    }
    StoredObject object;
    object.id = taught.id;
    object.name = taught.name;
    object.mesh = taught.file.string();
    object.coloured = taught.coloured;
    object.views = static_cast<int>(views.size());
    object.attitudes = options.attitudes;
    object.shape_symmetry = find_shape_symmetry(taught.mesh);
    const std::string title = title_of(object, mesh_bounds(taught.mesh).sizes().cast<double>());
    report(title);
    write_png(view_image(views, title), new_store.view_image(object.id));
    if (!options.dump_views.empty()) dump_views(views, options.dump_views / fmt::format("{:06d}", object.id));
    object.vote_centre = vote_centre_of(taught.mesh);
    move_origins_to(object.vote_centre, views);
    new_store.objects.push_back(object);
    std::move(views.begin(), views.end(), std::back_inserter(all));
    line.add(1.0);
  }
  return all;
}

Forest train_store_forest(std::vector<TrainingView> views, const Forest* old, const TeachOptions& options,
                          const std::function<void(const std::string&)>& report) {
  constexpr double kToneFraction = 0.7;  // see TrainingSettings
  constexpr int kPatches = 26000;  // patches of an object that trees are grown from: chosen by the time that takes
  constexpr int kMinPatches = 100;
  constexpr int kMaxPatches = 250;
  constexpr int kViewsPerImage = 2;  // a view template costs a tenth of one that trees learn from
  // Many attitudes want many patches and small leaves; that fewer of them choose a test pays for it.
  constexpr int kNodeSamples = 700;
  constexpr int kTestsPerNode = 1000;
  constexpr int kMinLeafSamples = 10;
  Profile profile = options.profile;
  if (old) {
    profile = training::profile_of(*old);
    const int trees = profile.training.trees;
    const Scoring scoring = profile.training.scoring;
    profile.training = options.profile.training;
    profile.training.trees = trees;
    profile.training.scoring = scoring;
  }
  profile.training.validation_frames = 0;    // calibration on scenes replaces it
  profile.training.composites_per_view = 1;  // another view is worth more than another background
  profile.training.tone_jitter_fraction = kToneFraction;
  if (!old) profile.features.tone = kCalibrationBrightness;
  profile.training.views_per_image = kViewsPerImage;
  const int images = std::max(max_views(views) / kViewsPerImage, 1);
  profile.training.patches_per_view = std::clamp(kPatches / images, kMinPatches, kMaxPatches);
  profile.training.node_samples = kNodeSamples;
  profile.training.tests_per_node = kTestsPerNode;
  profile.training.min_samples = kMinLeafSamples;
  profile.training.seed = options.seed;
  profile.training.threads = options.threads;
  Forest forest = old ? training::add_objects(*old, std::move(views), profile, report)
                      : training::train_forest(std::move(views), profile, report);
  return_freed_memory();
  return forest;
}

}  // namespace houghstream::teach
