#include "detector/training/augmentation/training_set.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "detector/training/augmentation/camera_randomisation.hpp"
#include "detector/training/augmentation/composites.hpp"
#include "detector/training/augmentation/patch_cover.hpp"
#include "detector/training/augmentation/sensor_errors.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/heap_memory.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::training {
namespace {

/// Draws the distance at which the object is put.
double draw_distance(const TrainingView& view, const ImageInput& input, Random& random) {
  const AugmentationSettings& settings = input.settings;
  const DistanceRange range =
      input.scales.distances(view.T_camera_object.translation().z(), {settings.min_distance, settings.max_distance});
  return std::exp(random.uniform(std::log(range.nearest), std::log(range.farthest)));
}

/// Draws at most `count` random pixels of the working frame that `wanted` accepts.
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

TrainingSample sample_at(cv::Point at, const WorkingFrame& frame, const ImageInput& input) {
  TrainingSample sample;
  sample.x = static_cast<std::int16_t>(at.x);
  sample.y = static_cast<std::int16_t>(at.y);
  sample.scale = input.scales.scale_of_patch(input.patch, frame.camera, frame.filled_depth.at<float>(at));
  return sample;
}

/// Returns the pixel of the view that a pixel of the composite shows.
ShownPoint shown_point(const Composite& composite, cv::Point2d frame_px, float depth) {
  const cv::Point2d view_px = (frame_px - composite.origin_px) / composite.scale;
  return {view_px, depth - composite.depth_change.at(frame_px), composite.scale};
}

/// The composite as a level works on it, and where patches may be drawn.
struct Canvas {
  WorkingFrame frame;
  cv::Mat mask;      // mask of the object, working pixels
  cv::Mat measured;  // depth without what holes have borrowed
  double to_frame = 1.0;

  /// Returns whether depth is measured. A hole's borrowed depth may be the background's and a rim's may be an
  /// occluder's: this suffices to test a patch, not to learn where the centre is.
  bool depth_is_measured(int x, int y) const {
    return std::abs(measured.at<float>(y, x) - frame.filled_depth.at<float>(y, x)) < 0.02F;
  }
  cv::Point2d frame_px(cv::Point at) const { return {(at.x + 0.5) * to_frame - 0.5, (at.y + 0.5) * to_frame - 0.5}; }
};

Canvas make_canvas(const Composite& composite, const FeatureLevel& level, const ImageInput& input) {
  Canvas canvas;
  canvas.frame = input.scales.working_frame(composite.frame, level, input.features);
  const cv::Size size = canvas.frame.colour.size();
  cv::resize(composite.mask, canvas.mask, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(composite.frame.depth, canvas.measured, size, 0, 0, cv::INTER_NEAREST);
  canvas.to_frame = static_cast<double>(composite.mask.cols) / size.width;
  return canvas;
}

/// Computes all features of an image; they stay until the next one.
const FeatureImage& all_features(const WorkingFrame& frame, const ImageInput& input, ImageWorkspace& workspace) {
  workspace.tiles.want_all(frame.colour.size());
  const ExtraPlanes extra = input.scales.extra_planes(frame, input.features);
  compute_features({frame, input.features, workspace.tiles, &extra}, 1, workspace.feature_workspace,
                   workspace.features);
  return workspace.features;
}

/// Takes what the patches of an image read.
void take_pixels(const FeatureImage& features, const PatchSettings& patch, TrainingImage& image) {
  std::vector<TrainingSample*> readers;
  for (auto* list : {&image.samples, &image.negative_pool})
    for (TrainingSample& sample : *list) readers.push_back(&sample);
  image.cutouts = cut_out_patches(features, patch, 0, readers);
}

/// Draws a part of the background that the level sees something in, or any part where there is none.
cv::Rect background_window(const RgbdFrame& background, const FeatureLevel& level, const Scales& scales,
                           Random& random) {
  constexpr int kTries = 12;
  const float fraction = std::min(0.5F, 1.0F / (4.0F * level.scale));
  const cv::Size size(static_cast<int>(static_cast<float>(background.colour.cols) * fraction),
                      static_cast<int>(static_cast<float>(background.colour.rows) * fraction));
  cv::Rect place;
  for (int i = 0; i < kTries; ++i) {
    place = cv::Rect(random.between(0, background.colour.cols - size.width),
                     random.between(0, background.colour.rows - size.height), size.width, size.height);
    int held = 0;
    for (int y = 0; y < size.height; y += 8) {
      for (int x = 0; x < size.width; x += 8) {
        held += scales.teaches(level, background.depth.at<float>(place.y + y, place.x + x)) ? 1 : 0;
      }
    }
    if (held * 64 * 3 > size.area()) break;
  }
  return place;
}

}  // namespace

TrainingImage object_image(const LabelledView& taught, const RgbdFrame& background, const ImageInput& input,
                           Random& random, ImageWorkspace& workspace) {
  const TrainingView& view = taught.view;
  const AugmentationSettings& settings = input.settings;
  TrainingImage image;
  double distance = draw_distance(view, input, random);
  std::optional<Composite> composite = make_composite(view, background, distance, settings, random);
  if (!composite) {
    distance = view.T_camera_object.translation().z();
    composite = make_composite(view, background, distance, settings, random);
  }
  if (!composite) return image;

  jitter_tone(settings.tone_jitter_fraction, settings.camera_randomisation, composite->frame.colour, random);
  input.scales.vary_depth(distance, input.features, composite->frame.depth, random);
  const FeatureLevel level = input.scales.level_for(distance, composite->frame.camera, input.features, random);
  const Canvas canvas = make_canvas(*composite, level, input);
  const bool needs_depth = input.scales.needs_measured_depth();
  const auto known = [&](int x, int y) {
    return input.scales.teaches(level, canvas.frame.filled_depth.at<float>(y, x));
  };
  const auto on_object = [&](int x, int y) {
    return canvas.mask.at<std::uint8_t>(y, x) != 0 && known(x, y) && (!needs_depth || canvas.depth_is_measured(x, y));
  };
  const auto beside = [&](int x, int y) { return canvas.mask.at<std::uint8_t>(y, x) == 0 && known(x, y); };

  const int count = settings.patches_per_view / settings.composites_per_view;
  for (const cv::Point at : draw_pixels(canvas.mask.size(), count, random, on_object)) {
    TrainingSample sample = sample_at(at, canvas.frame, input);
    const float depth = canvas.frame.filled_depth.at<float>(at);
    sample.offset = input.scales.centre_offset(view, shown_point(*composite, canvas.frame_px(at), depth));
    sample.label = static_cast<std::uint16_t>(taught.label);
    sample.view = taught.index;
    image.samples.push_back(sample);
  }
  for (const cv::Point at : draw_pixels(canvas.mask.size(), count / 4, random, beside)) {
    image.samples.push_back(sample_at(at, canvas.frame, input));
  }
  const double px = composite->frame.camera.metres_per_px(input.scales.counted_distance(distance));
  image.whole_area = static_cast<float>(composite->whole_px * px * px);
  image.size = canvas.mask.size();
  take_pixels(all_features(canvas.frame, input, workspace), input.patch, image);
  return image;
}

TrainingImage background_image(const RgbdFrame& background, const FeatureLevel& level, const ImageInput& input,
                               Random& random, ImageWorkspace& workspace) {
  const AugmentationSettings& settings = input.settings;
  const cv::Rect place = background_window(background, level, input.scales, random);
  RgbdFrame part;
  part.colour = background.colour(place).clone();
  part.depth = background.depth(place);
  part.camera = background.camera.cropped(place.x, place.y, place.width, place.height);
  jitter_exposure(part.colour, settings.lighting_variation, random);
  jitter_tone(settings.tone_jitter_fraction, settings.camera_randomisation, part.colour, random);

  const WorkingFrame frame = input.scales.working_frame(part, level, input.features);
  TrainingImage image;
  const auto known = [&](int x, int y) { return input.scales.teaches(level, frame.filled_depth.at<float>(y, x)); };
  const auto count = static_cast<std::size_t>(settings.patches_per_background / kBackgroundImages);
  const int drawn = static_cast<int>(count) * (1 + settings.negative_pool);
  for (const cv::Point at : draw_pixels(frame.colour.size(), drawn, random, known)) {
    auto& list = image.samples.size() < count ? image.samples : image.negative_pool;
    list.push_back(sample_at(at, frame, input));
  }
  image.size = frame.colour.size();
  take_pixels(all_features(frame, input, workspace), input.patch, image);
  return image;
}

namespace {

/// Makes the view template, which poses and boxes need.
ViewTemplate trained_view(const TrainingView& view, std::uint32_t class_index, const Scales& scales) {
  const Eigen::Vector3d centre = view.T_camera_object.translation();
  const Eigen::Matrix3f R_camera_object = view.T_camera_object.rotation().cast<float>();
  const Eigen::Vector2d centre_px = view.frame.camera.project(centre);
  const cv::Rect box = cv::boundingRect(view.mask);
  const auto metres = static_cast<float>(view.frame.camera.metres_per_px(scales.counted_distance(centre.z())));
  ViewTemplate out;
  out.class_index = class_index;
  out.R_ray_object = Eigen::Quaternionf(ray_rotation(centre.cast<float>()).transpose() * R_camera_object).normalized();
  const auto side = [&](int px, double origin_px) { return static_cast<float>(px - 0.5 - origin_px) * metres; };
  out.box = {side(box.x, centre_px.x()), side(box.y, centre_px.y()), side(box.br().x, centre_px.x()),
             side(box.br().y, centre_px.y())};
  out.appearance = make_template_grid(view.frame, view.mask, box, centre.cast<float>());
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

/// Returns one of `every` views of each class, whose labels these are, in ascending order.
std::vector<std::size_t> views_in_images(const std::vector<int>& labels, int every) {
  std::map<int, int> counts;
  std::vector<std::size_t> selected;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (counts[labels[v]]++ % every == 0) selected.push_back(v);
  }
  return selected;
}

void measure_classes(const std::vector<TrainingImage>& images, TrainingSet& set) {
  for (std::size_t c = 0; c < set.classes.size(); ++c) {
    std::vector<float> distances;
    double area = 0.0;
    int count = 0;
    for (const TrainingImage& image : images) {
      bool shows_class = false;
      for (const TrainingSample& sample : image.samples) {
        if (sample.label != c + 1) continue;
        distances.push_back(sample.offset.norm());
        shows_class = true;
      }
      area += shows_class ? image.whole_area : 0.0F;
      count += shows_class ? 1 : 0;
    }
    require(!distances.empty(), "class '{}': no patch with depth in any training view", set.classes[c].name);
    const std::size_t rank = distances.size() * 98 / 100;
    std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(rank), distances.end());
    set.classes[c].radius = distances[rank];
    set.visible_areas.push_back(static_cast<float>(area / count));
  }
}

/// Moves the images' cutouts and samples to the set.
void take_samples(std::vector<TrainingImage>& images, TrainingSet& set) {
  set.images = images.size();
  for (std::size_t i = 0; i < images.size(); ++i) {
    const auto take = [&](const std::vector<TrainingSample>& from, std::vector<TrainingSample>& to) {
      for (TrainingSample sample : from) {
        sample.image = static_cast<std::int32_t>(i);
        sample.cutout += static_cast<std::int32_t>(set.cutouts.size());
        to.push_back(sample);
      }
    };
    take(images[i].samples, set.samples);
    take(images[i].negative_pool, set.negative_pool);
    std::move(images[i].cutouts.begin(), images[i].cutouts.end(), std::back_inserter(set.cutouts));
    images[i] = {};
  }
}

std::size_t bytes_of(const std::vector<Cutout>& cutouts) {
  std::size_t bytes = 0;
  for (const Cutout& cutout : cutouts) bytes += cutout.bytes();
  return bytes;
}

}  // namespace

std::size_t TrainingSet::held_bytes() const {
  return bytes_of(cutouts);
}

void drop_unread_pixels(const PatchSettings& patch, TrainingSet& set) {
  constexpr std::size_t kCutoutsPerReturn = 1000;  // they were allocated by other threads, whose memory is not reused
  std::vector<std::vector<TrainingSample*>> readers(set.cutouts.size());
  for (auto* list : {&set.samples, &set.negative_pool})
    for (TrainingSample& sample : *list) readers[static_cast<std::size_t>(sample.cutout)].push_back(&sample);
  std::vector<Cutout> kept;
  for (std::size_t c = 0; c < readers.size(); ++c) {
    Cutout& old = set.cutouts[c];
    const auto first = static_cast<std::int32_t>(kept.size());
    std::vector<Cutout> parts = cut_out_patches(old, patch, first, readers[c]);
    if (bytes_of(parts) < old.bytes()) {
      std::move(parts.begin(), parts.end(), std::back_inserter(kept));
      old = {};
    } else {
      for (TrainingSample* reader : readers[c]) reader->cutout = first;
      kept.push_back(std::move(old));
    }
    if (c % kCutoutsPerReturn == 0) return_freed_memory();
  }
  set.cutouts = std::move(kept);
}

TrainingSet make_training_set(const std::vector<const TrainingView*>& views, const ImageInput& input,
                              const std::function<void(const TrainingView*)>& is_done) {
  constexpr int kImagesPerReturn = 500;  // images' memory is reused by none that is larger than a view
  const AugmentationSettings& settings = input.settings;
  TrainingSet set;
  set.layout = FeatureLayout(input.features);
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
    set.views.push_back(trained_view(*view, static_cast<std::uint32_t>(index), input.scales));
  }
  const int copies = settings.composites_per_view;
  const std::vector<std::size_t> imaged = views_in_images(labels, settings.views_per_image);
  for (std::size_t v = 0; v < objects.size(); ++v) {
    if (!std::binary_search(imaged.begin(), imaged.end(), v)) is_done(objects[v]);
  }
  return_freed_memory();
  const int object_count = static_cast<int>(imaged.size()) * copies;
  const int total = object_count + static_cast<int>(backgrounds.size()) * kBackgroundImages;
  std::vector<TrainingImage> images(static_cast<std::size_t>(total));
  PerWorker<ImageWorkspace> workspaces;
  workspaces.resize(settings.threads);
  parallel_for_workers(settings.threads, object_count, [&](int worker, int i) {
    Random random = Random::for_item(settings.seed, static_cast<std::uint64_t>(i));
    const std::size_t v = imaged[static_cast<std::size_t>(i / copies)];
    const auto b = static_cast<std::size_t>(random.below(static_cast<int>(backgrounds.size())));
    images[static_cast<std::size_t>(i)] = object_image({*objects[v], labels[v], static_cast<std::uint32_t>(v)},
                                                       backgrounds[b]->frame, input, random, workspaces[worker]);
    if (copies == 1) is_done(objects[v]);
    if (i % kImagesPerReturn == 0) return_freed_memory();
  });
  parallel_for_workers(settings.threads, static_cast<int>(backgrounds.size()), [&](int worker, int b) {
    const TrainingView* background = backgrounds[static_cast<std::size_t>(b)];
    const std::vector<FeatureLevel> levels = input.scales.levels(input.features, background->frame.camera);
    for (int i = b * kBackgroundImages; i < (b + 1) * kBackgroundImages; ++i) {
      const int item = object_count + i;
      Random random = Random::for_item(settings.seed, static_cast<std::uint64_t>(item));
      images[static_cast<std::size_t>(item)] = background_image(
          background->frame, levels[static_cast<std::size_t>(i) % levels.size()], input, random, workspaces[worker]);
    }
    is_done(background);
  });
  measure_classes(images, set);
  take_samples(images, set);
  return set;
}

}  // namespace houghstream::training
