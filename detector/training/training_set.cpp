#include "detector/training/training_set.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "detector/features/features.hpp"
#include "detector/training/composites.hpp"
#include "pipeline/checks.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

struct Picture {
  FeatureImage features;
  std::vector<TrainingSample> samples;
  std::vector<TrainingSample> spare_background;
  float whole_area = 0.0F;  // of the object, square metres
};

constexpr int kBackgroundPictures = 4;  // per background frame, half of them at each level

struct Recipe {
  const FeatureSettings& features;
  const PatchSettings& patch;
  const TrainingSettings& settings;
};

/// Depth that a level is taught: a little beyond what it holds, since detection decides by noisy depth.
bool nearly_holds(const FeatureLevel& level, float depth) {
  return depth > 0.85F * level.min_distance && depth <= 1.15F * level.max_distance;
}

/// The level that sees an object at this distance; either one near the limit between them.
FeatureLevel level_for(double distance, const FeatureSettings& features, Random& random) {
  const auto levels = feature_levels(features);
  return distance * random.uniform(0.9, 1.1) > features.far_distance ? levels[1] : levels[0];
}

/// Random pixels of the working frame that `wanted` accepts, at most `count`.
template <typename Wanted>
std::vector<cv::Point> draw_pixels(cv::Size size, int count, Random& random, const Wanted& wanted) {
  std::vector<cv::Point> all;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (wanted(x, y)) all.emplace_back(x, y);
    }
  }
  const int taken = std::min(count, static_cast<int>(all.size()));
  for (int i = 0; i < taken; ++i) {
    std::swap(all[static_cast<std::size_t>(i)],
              all[static_cast<std::size_t>(random.between(i, static_cast<int>(all.size()) - 1))]);
  }
  all.resize(static_cast<std::size_t>(taken));
  return all;
}

TrainingSample sample_at(cv::Point at, const WorkingFrame& frame, const Recipe& recipe) {
  TrainingSample sample;
  sample.x = static_cast<std::int16_t>(at.x);
  sample.y = static_cast<std::int16_t>(at.y);
  sample.scale = patch_scale(recipe.patch, frame.camera.fx, frame.filled_depth.at<float>(at));
  return sample;
}

/// From a surface point to the object's centre, in the ray frame of the pixel that shows the point.
Eigen::Vector3f centre_offset(const TrainingView& view, const Composite& composite, cv::Point2d frame_px, float depth) {
  const cv::Point2d view_px = (frame_px - composite.origin_px) / composite.scale;
  const Eigen::Vector3d point = view.frame.camera.backproject(view_px.x, view_px.y, depth - composite.depth_shift);
  const Eigen::Vector3d offset = view.T_camera_object.translation() - point;
  return ray_rotation(point.cast<float>()).transpose() * offset.cast<float>();
}

Picture object_picture(const TrainingView& view, int label, std::uint32_t view_index, const RgbdFrame& background,
                       const Recipe& recipe, Random& random) {
  const TrainingSettings& settings = recipe.settings;
  Picture picture;
  double distance = std::exp(random.uniform(std::log(settings.min_distance), std::log(settings.max_distance)));
  std::optional<Composite> composite = make_composite(view, background, distance, settings, random);
  if (!composite) {
    distance = view.T_camera_object.translation().z();
    composite = make_composite(view, background, distance, settings, random);
  }
  if (!composite) return picture;

  const FeatureLevel level = level_for(distance, recipe.features, random);
  const WorkingFrame frame = make_working_frame(composite->frame, level.scale, recipe.features);
  picture.features = compute_features(frame, recipe.features, 1);
  cv::Mat mask;
  cv::resize(composite->mask, mask, frame.colour.size(), 0, 0, cv::INTER_NEAREST);
  const double to_frame = static_cast<double>(composite->mask.cols) / mask.cols;
  const auto known = [&](int x, int y) { return nearly_holds(level, frame.filled_depth.at<float>(y, x)); };
  // A hole's borrowed depth may be the background's and a rim's may be an occluder's: good enough to look at a patch,
  // not to learn where the centre is.
  cv::Mat measured;
  cv::resize(composite->frame.depth, measured, mask.size(), 0, 0, cv::INTER_NEAREST);
  const auto on_object = [&](int x, int y) {
    const float difference = measured.at<float>(y, x) - frame.filled_depth.at<float>(y, x);
    return mask.at<std::uint8_t>(y, x) != 0 && known(x, y) && std::abs(difference) < 0.02F;
  };
  const auto beside = [&](int x, int y) { return mask.at<std::uint8_t>(y, x) == 0 && known(x, y); };

  const int count = settings.patches_per_view / settings.composites_per_view;
  for (const cv::Point at : draw_pixels(mask.size(), count, random, on_object)) {
    TrainingSample sample = sample_at(at, frame, recipe);
    const cv::Point2d frame_px((at.x + 0.5) * to_frame - 0.5, (at.y + 0.5) * to_frame - 0.5);
    sample.offset = centre_offset(view, *composite, frame_px, frame.filled_depth.at<float>(at));
    sample.label = static_cast<std::uint16_t>(label);
    sample.view = view_index;
    picture.samples.push_back(sample);
  }
  for (const cv::Point at : draw_pixels(mask.size(), count / 4, random, beside)) {
    picture.samples.push_back(sample_at(at, frame, recipe));
  }
  const double px = composite->frame.camera.metres_per_px(distance);
  picture.whole_area = static_cast<float>(composite->whole_px * px * px);
  return picture;
}

/// A part of the background that the level sees something in, or any part where there is none.
cv::Rect background_window(const RgbdFrame& background, const FeatureLevel& level, Random& random) {
  constexpr int kTries = 12;
  const cv::Size size(static_cast<int>(static_cast<float>(background.colour.cols) / (4.0F * level.scale)),
                      static_cast<int>(static_cast<float>(background.colour.rows) / (4.0F * level.scale)));
  cv::Rect place;
  for (int i = 0; i < kTries; ++i) {
    place = cv::Rect(random.between(0, background.colour.cols - size.width),
                     random.between(0, background.colour.rows - size.height), size.width, size.height);
    int held = 0;
    for (int y = 0; y < size.height; y += 8) {
      for (int x = 0; x < size.width; x += 8) {
        held += nearly_holds(level, background.depth.at<float>(place.y + y, place.x + x)) ? 1 : 0;
      }
    }
    if (held * 64 * 3 > size.area()) break;
  }
  return place;
}

Picture background_picture(const RgbdFrame& background, const FeatureLevel& level, const Recipe& recipe,
                           Random& random) {
  const cv::Rect place = background_window(background, level, random);
  RgbdFrame part;
  part.colour = background.colour(place).clone();
  part.depth = background.depth(place);
  part.camera = background.camera.cropped(place.x, place.y, place.width, place.height);
  vary_exposure(part.colour, recipe.settings.light_variation, random);

  const WorkingFrame frame = make_working_frame(part, level.scale, recipe.features);
  Picture picture;
  picture.features = compute_features(frame, recipe.features, 1);
  const auto known = [&](int x, int y) { return nearly_holds(level, frame.filled_depth.at<float>(y, x)); };
  const std::size_t count = static_cast<std::size_t>(recipe.settings.patches_per_view / kBackgroundPictures);
  const int drawn = static_cast<int>(count) * (1 + recipe.settings.spare_background);
  for (const cv::Point at : draw_pixels(frame.colour.size(), drawn, random, known)) {
    auto& list = picture.samples.size() < count ? picture.samples : picture.spare_background;
    list.push_back(sample_at(at, frame, recipe));
  }
  return picture;
}

/// What the pose process and the boxes need to remember of a view.
TrainedView trained_view(const TrainingView& view, std::uint32_t class_index) {
  const Eigen::Vector3d centre = view.T_camera_object.translation();
  const Eigen::Matrix3f R_camera_object = view.T_camera_object.rotation().cast<float>();
  const Eigen::Vector2d centre_px = view.frame.camera.project(centre);
  const cv::Rect box = cv::boundingRect(view.mask);
  const auto metres = static_cast<float>(view.frame.camera.metres_per_px(centre.z()));
  TrainedView out;
  out.class_index = class_index;
  out.R_ray_object = Eigen::Quaternionf(ray_rotation(centre.cast<float>()).transpose() * R_camera_object).normalized();
  const auto side = [&](int px, double origin_px) { return static_cast<float>(px - 0.5 - origin_px) * metres; };
  out.box = {side(box.x, centre_px.x()), side(box.y, centre_px.y()), side(box.br().x, centre_px.x()),
             side(box.br().y, centre_px.y())};
  out.appearance = remember_appearance(view.frame, view.mask, box, centre.z());
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

void measure_classes(const std::vector<Picture>& pictures, TrainingSet& set) {
  for (std::size_t c = 0; c < set.classes.size(); ++c) {
    std::vector<float> distances;
    double area = 0.0;
    int count = 0;
    for (const Picture& picture : pictures) {
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

}  // namespace

TrainingSet make_training_set(const std::vector<const TrainingView*>& views, const FeatureSettings& features,
                              const PatchSettings& patch, const TrainingSettings& settings) {
  const Recipe recipe{features, patch, settings};
  TrainingSet set;
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
    set.views.push_back(trained_view(*view, static_cast<std::uint32_t>(index)));
  }
  const int copies = settings.composites_per_view;
  const int object_count = static_cast<int>(objects.size()) * copies;
  const int total = object_count + static_cast<int>(backgrounds.size()) * kBackgroundPictures;
  std::vector<Picture> pictures(static_cast<std::size_t>(total));
  parallel_for(settings.threads, total, [&](int i) {
    Random random = Random::for_item(settings.seed, static_cast<std::uint64_t>(i));
    auto& picture = pictures[static_cast<std::size_t>(i)];
    if (i < object_count) {
      const auto v = static_cast<std::size_t>(i / copies);
      const auto b = static_cast<std::size_t>(random.below(static_cast<int>(backgrounds.size())));
      picture =
          object_picture(*objects[v], labels[v], static_cast<std::uint32_t>(v), backgrounds[b]->frame, recipe, random);
    } else {
      const int b = i - object_count;
      const FeatureLevel level = feature_levels(features)[static_cast<std::size_t>(b % 2)];
      picture = background_picture(backgrounds[static_cast<std::size_t>(b / kBackgroundPictures)]->frame, level, recipe,
                                   random);
    }
  });
  measure_classes(pictures, set);
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
  return set;
}

}  // namespace houghstream
