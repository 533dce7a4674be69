#include "detector/training/pictures/training_set.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "detector/training/pictures/training_pictures.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::training {
namespace {

/// What the pose process and the boxes need to remember of a view.
TrainedView trained_view(const TrainingView& view, std::uint32_t class_index, ScaleHandling handling) {
  const Eigen::Vector3d centre = view.T_camera_object.translation();
  const Eigen::Matrix3f R_camera_object = view.T_camera_object.rotation().cast<float>();
  const Eigen::Vector2d centre_px = view.frame.camera.project(centre);
  const cv::Rect box = cv::boundingRect(view.mask);
  const auto metres =
      static_cast<float>(view.frame.camera.metres_per_px(handling == ScaleHandling::kScaleSpace ? 1.0 : centre.z()));
  TrainedView out;
  out.class_index = class_index;
  out.R_ray_object = Eigen::Quaternionf(ray_rotation(centre.cast<float>()).transpose() * R_camera_object).normalized();
  const auto side = [&](int px, double origin_px) { return static_cast<float>(px - 0.5 - origin_px) * metres; };
  out.box = {side(box.x, centre_px.x()), side(box.y, centre_px.y()), side(box.br().x, centre_px.x()),
             side(box.br().y, centre_px.y())};
  out.appearance = remember_appearance(view.frame, view.mask, box, centre.cast<float>());
  return out;
}

std::vector<ObjectClass> list_classes(const std::vector<const TrainingView*>& views) {
  std::map<int, std::string> names;
  for (const TrainingView* shown : views) {
    const TrainingView& view = *shown;
    if (view.class_id == 0) continue;
    const auto [place, is_new] = names.emplace(view.class_id, view.class_name);
    require(is_new || place->second == view.class_name, "{}: class {} is called '{}' and '{}', expected one name",
            view.source, view.class_id, place->second, view.class_name);
    require(cv::countNonZero(view.mask) > 0, "{}: mask shows no object pixel, expected some at 255", view.source);
  }
  require(!names.empty(), "training data: no object views, expected at least one class");
  std::vector<ObjectClass> classes;
  for (const auto& [id, name] : names) {
    ObjectClass object;
    object.class_id = id;
    object.name = name;
    classes.push_back(std::move(object));
  }
  return classes;
}

/// One of `every` views of each class, whose labels these are, in ascending order.
std::vector<std::size_t> views_in_pictures(const std::vector<int>& labels, int every) {
  std::map<int, int> counts;
  std::vector<std::size_t> chosen;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (counts[labels[v]]++ % every == 0) chosen.push_back(v);
  }
  return chosen;
}

void measure_classes(const std::vector<TrainingPicture>& pictures, TrainingSet& set) {
  for (std::size_t c = 0; c < set.classes.size(); ++c) {
    std::vector<float> distances;
    double area = 0.0;
    int count = 0;
    for (const TrainingPicture& picture : pictures) {
      bool shows_class = false;
      for (const TrainingSample& sample : picture.samples) {
        if (sample.label != c + 1) continue;
        distances.push_back(sample.offset.norm());
        shows_class = true;
      }
      area += shows_class ? picture.whole_area : 0.0F;
      count += shows_class ? 1 : 0;
    }
    require(!distances.empty(), "class '{}': no patch with depth in any training view", set.classes[c].name);
    const std::size_t rank = distances.size() * 98 / 100;
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(rank), distances.end());
    set.classes[c].radius = distances[rank];
    set.visible_areas.push_back(static_cast<float>(area / count));
  }
}

/// Moves the pictures and their samples to the set.
void take_samples(std::vector<TrainingPicture>& pictures, TrainingSet& set) {
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    for (TrainingSample& sample : pictures[i].samples) {
      sample.picture = static_cast<std::int32_t>(i);
      set.samples.push_back(sample);
    }
    for (TrainingSample& sample : pictures[i].spare_background) {
      sample.picture = static_cast<std::int32_t>(i);
      set.spare_background.push_back(sample);
    }
    set.pictures.push_back(std::move(pictures[i].features));
  }
}

}  // namespace

TrainingSet make_training_set(const std::vector<const TrainingView*>& views, const Profile& profile,
                              const std::function<void(const TrainingView*)>& is_done) {
  const TrainingSettings& settings = profile.training;
  TrainingSet set;
  set.layout = FeatureLayout(profile.features);
  set.classes = list_classes(views);
  std::vector<const TrainingView*> objects;
  std::vector<const TrainingView*> backgrounds;
  for (const TrainingView* view : views) (view->class_id == 0 ? backgrounds : objects).push_back(view);
  require(!backgrounds.empty(), "training data: no background frames, expected at least one");

  std::vector<int> labels;
  for (const TrainingView* view : objects) {
    const auto same = [&](const ObjectClass& c) { return c.class_id == view->class_id; };
    const auto index = std::find_if(set.classes.begin(), set.classes.end(), same) - set.classes.begin();
    labels.push_back(static_cast<int>(index) + 1);
    set.views.push_back(trained_view(*view, static_cast<std::uint32_t>(index), profile.features.handling));
  }
  const int copies = settings.composites_per_view;
  const std::vector<std::size_t> pictured = views_in_pictures(labels, settings.views_per_picture);
  for (std::size_t v = 0; v < objects.size(); ++v) {
    if (!std::binary_search(pictured.begin(), pictured.end(), v)) is_done(objects[v]);
  }
  const int object_count = static_cast<int>(pictured.size()) * copies;
  const int total = object_count + static_cast<int>(backgrounds.size()) * kBackgroundPictures;
  std::vector<TrainingPicture> pictures(static_cast<std::size_t>(total));
  PerWorker<PictureWorkspace> workspaces;
  workspaces.make_room(settings.threads);
  parallel_for_workers(settings.threads, total, [&](int worker, int i) {
    Random random = Random::for_item(settings.seed, static_cast<std::uint64_t>(i));
    auto& picture = pictures[static_cast<std::size_t>(i)];
    if (i < object_count) {
      const std::size_t v = pictured[static_cast<std::size_t>(i / copies)];
      const auto b = static_cast<std::size_t>(random.below(static_cast<int>(backgrounds.size())));
      picture = object_picture({*objects[v], labels[v], static_cast<std::uint32_t>(v)}, backgrounds[b]->frame, profile,
                               random, workspaces[worker]);
      if (copies == 1) is_done(objects[v]);
    } else {
      const int b = i - object_count;
      const RgbdFrame& background = backgrounds[static_cast<std::size_t>(b / kBackgroundPictures)]->frame;
      const std::vector<FeatureLevel> levels = feature_levels(profile.features, background.camera);
      const FeatureLevel& level = levels[static_cast<std::size_t>(b) % levels.size()];
      picture = background_picture(background, level, profile, random, workspaces[worker]);
    }
  });
  measure_classes(pictures, set);
  take_samples(pictures, set);
  return set;
}

}  // namespace houghstream::training
