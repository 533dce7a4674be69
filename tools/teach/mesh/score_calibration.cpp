#include "tools/teach/mesh/score_calibration.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "detector/detector.hpp"
#include "detector/stages.hpp"
#include "detector/training/augmentation/camera_randomisation.hpp"
#include "detector/training/augmentation/sensor_errors.hpp"
#include "detector/training/forest_trainer.hpp"
#include "detector/training/score_training.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"
#include "pose/verification/quality_training.hpp"
#include "tools/common/progress_line.hpp"
#include "tools/teach/mesh/practice_measurement.hpp"
#include "tools/teach/mesh/quality_examples.hpp"

namespace houghstream::teach {
namespace {

constexpr std::uint64_t kCameraSeed = 0x63616D657261ULL;

/// Renders the frames once; both passes read them. The objects are not quite those that were taught: light, wear and
/// printer differ.
std::vector<world::RenderedFrame> render_frames(const std::vector<world::CalibrationSceneObject>& objects,
                                                const CalibrationSettings& settings, int scene_count) {
  const world::CalibrationScenes scenes(objects, settings.seed);
  constexpr int kFramesPerScene = world::CalibrationScenes::kFramesPerScene;
  std::vector<world::RenderedFrame> frames(static_cast<std::size_t>(scene_count * kFramesPerScene));
  ProgressLine progress("practice rooms", scene_count);
  parallel_for(settings.threads, scene_count, [&](int scene) {
    int index = scene * kFramesPerScene;
    for (world::RenderedFrame& frame : scenes.render(scene)) {
      Random random = Random::for_item(settings.seed ^ kCameraSeed, static_cast<std::uint64_t>(index));
      for (const cv::Mat& mask : frame.visible_masks) {
        const cv::Rect part = cv::boundingRect(mask);
        cv::Mat colour = frame.frame.colour(part);
        training::perturb_appearance_in(mask(part), settings.surface_variation, random, colour);
      }
      frame.visible_masks.clear();
      training::randomise_camera(settings.camera_fraction, settings.camera_randomisation, frame.frame, random);
      frames[static_cast<std::size_t>(index)] = std::move(frame);
      ++index;
    }
    progress.add(1.0);
  });
  return frames;
}

void warn_of_unobserved(const std::vector<std::string>& names, int scene_count) {
  for (const std::string& name : names)
    log_warning(
        "{}: seen in none of {} practice rooms, expected some: what its scores and poses are worth is not learnt (too "
        "large for a table, or too few --practice-rooms)",
        name, scene_count);
}

training::ValidationSource validation_source(const std::vector<world::RenderedFrame>& frames) {
  return {static_cast<int>(frames.size()), [&frames](int index) {
            const world::RenderedFrame& from = frames[static_cast<std::size_t>(index)];
            training::ValidationFrame frame;
            frame.frame = from.frame;
            for (const GroundTruthObject& object : from.objects)
              frame.objects.push_back({object.object_id, {}, object.box_visible_px, object.visible_fraction});
            return frame;
          }};
}

/// Folds of the cross-validation: rooms of even numbers, and of odd ones.
constexpr int kFolds = 2;

int fold_of(std::size_t frame) {
  return static_cast<int>(frame) / world::CalibrationScenes::kFramesPerScene % kFolds;
}

/// The calibration of a group, in rooms of its own.
struct GroupCalibration {
  std::size_t place = 0;                               ///< index of its forest among the groups
  std::set<int> ids;                                   ///< ids of the classes that it is for
  std::vector<world::CalibrationSceneObject> objects;  ///< objects of all groups, as they stand in its rooms
  CalibrationSettings settings;                        ///< its seed is the group's
  std::vector<world::RenderedFrame> frames;            ///< not kept from step to step where there are several groups
  std::vector<training::ScoreExamples> examples;       ///< examples of each frame, of the group's classes
};

std::vector<GroupCalibration> calibrations_of(const std::vector<CalibrationObject>& objects,
                                              const std::set<int>& new_ids, const CalibrationSettings& settings,
                                              const std::vector<Forest>& groups) {
  constexpr std::uint64_t kNextSeed = 1000003U;
  std::vector<world::CalibrationSceneObject> in_scene;
  in_scene.reserve(objects.size());
  for (const CalibrationObject& object : objects) in_scene.push_back(object.in_scene);
  std::vector<GroupCalibration> all;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    GroupCalibration calibration;
    calibration.place = i;
    calibration.ids = new_objects_of(groups[i], new_ids);
    if (calibration.ids.empty()) continue;
    calibration.objects = groups.size() == 1 ? in_scene : interleave_distractors(in_scene, calibration.ids);
    for (world::CalibrationSceneObject& object : calibration.objects)
      object.is_calibrated = calibration.ids.count(object.id) > 0;
    calibration.settings = settings;
    calibration.settings.seed += kNextSeed * i;
    all.push_back(std::move(calibration));
  }
  return all;
}

void render_frames_of(GroupCalibration& calibration) {
  const int scene_count = scene_count_for(calibration.ids.size(), calibration.settings);
  calibration.frames = render_frames(calibration.objects, calibration.settings, scene_count);
}

/// Fits the scores of a group's objects to what is found of them in its rooms.
void learn_scores(GroupCalibration& calibration, Forest& forest) {
  Profile profile = training::profile_of(forest);
  profile.training.threads = calibration.settings.threads;
  calibration.examples = training::find_score_examples(validation_source(calibration.frames), 0, profile, forest);
  training::fit_scores(calibration.examples, calibration.ids, forest);
}

std::vector<std::size_t> frames_of(int fold, const GroupCalibration& calibration) {
  std::vector<std::size_t> in_fold;
  for (std::size_t f = 0; f < calibration.frames.size(); ++f) {
    if (fold_of(f) == fold) in_fold.push_back(f);
  }
  return in_fold;
}

void fit_scores_without(int fold, const GroupCalibration& calibration, Forest& forest) {
  std::vector<training::ScoreExamples> others;
  for (std::size_t f = 0; f < calibration.examples.size(); ++f) {
    if (fold_of(f) != fold) others.push_back(calibration.examples[f]);
  }
  training::fit_scores(others, calibration.ids, forest);
}

DetectionSettings detection_of(const Forest& forest) {
  DetectionSettings detection = detection_settings(forest);
  detection.threads = 1;
  detection.evidence.threshold = PoseSettings{}.min_score;
  detection.evidence.learn_camera_colours = false;
  return detection;
}

/// Finds poses. Each fold of the group's rooms is searched with scores that were fitted without it: what a score is
/// worth to a pose is learnt where the score is as uncertain as it will be. The forests, which may be too large to be
/// in memory twice, are lent to a detector; the group's takes the scores of one fold after the other, and is left with
/// those of all.
quality::FoundPoses find_poses(const GroupCalibration& calibration, const quality::UnfilteredPoseFinder& finder,
                               std::vector<Forest>& groups) {
  const DetectionSettings detection = detection_of(groups.front());
  const int threads = calibration.settings.threads;
  std::map<int, std::string> names;
  for (const Forest& forest : groups) {
    for (const ObjectClass& known : forest.classes) names[known.class_id] = known.name;
  }
  quality::FoundPoses found;
  found.frames.resize(calibration.frames.size());
  found.terms.resize(calibration.frames.size());
  PerWorker<DetectorWorkspace> workspaces;
  workspaces.resize(threads);
  ProgressLine progress("search in practice rooms", static_cast<double>(calibration.frames.size()));
  for (int fold = 0; fold < kFolds; ++fold) {
    fit_scores_without(fold, calibration, groups[calibration.place]);
    Detector detector(std::move(groups), detection);
    const std::vector<std::size_t> searched = frames_of(fold, calibration);
    parallel_for_workers(threads, static_cast<int>(searched.size()), [&](int worker, int i) {
      const std::size_t index = searched[static_cast<std::size_t>(i)];
      const world::RenderedFrame& rendered = calibration.frames[index];
      EvaluatedFrame& frame = found.frames[index];
      for (const GroundTruthObject& object : rendered.objects)
        frame.objects.push_back({names.at(object.object_id), object, std::nullopt});
      frame.detections = detector.detect(rendered.frame, workspaces[worker]);
      found.terms[index] = finder.find_in(rendered.frame, frame);
      progress.add(1.0);
    });
    groups = std::move(detector).take_groups();
  }
  training::fit_scores(calibration.examples, calibration.ids, groups[calibration.place]);
  return found;
}

using ExamplesByName = std::map<std::string, std::vector<quality::Example>>;

ExamplesByName label_all(const quality::FoundPoses& found, const std::map<std::string, PoseModel>& models) {
  ExamplesByName by_name;
  for (const auto& [name, model] : models) {
    by_name[name] = quality::label_examples(found, {{name, model}});
    for (quality::Example& example : by_name[name]) example.fold = fold_of(example.frame);
  }
  return by_name;
}

/// Learns the qualities of a group's objects from the poses in its rooms, and counts what was found of them there.
std::map<std::string, CalibratedObject> learn_from_poses(const GroupCalibration& calibration,
                                                         const std::vector<CalibrationObject>& objects,
                                                         const quality::FoundPoses& found,
                                                         const std::map<std::string, PoseModel>& models,
                                                         float reported_from) {
  const ExamplesByName labelled = label_all(found, models);
  std::map<std::string, CalibratedObject> learnt;
  std::map<std::string, std::vector<QualityExample>> examples;
  for (const auto& [name, of_class] : labelled) examples[name] = {of_class.begin(), of_class.end()};
  const std::map<std::string, QualitySettings> settings = learn_qualities(examples);
  const std::map<std::string, std::vector<float>> qualities = cross_fitted_qualities(examples);
  for (const CalibrationObject& object : objects) {
    if (calibration.ids.count(object.in_scene.id) == 0) continue;
    learnt[object.name] = {settings.at(object.name),
                           measure_practice({object.name, object.vote_centre}, found, labelled.at(object.name),
                                            qualities.at(object.name), reported_from)};
  }
  return learnt;
}

}  // namespace

int scene_count_for(std::size_t new_objects, const CalibrationSettings& settings) {
  constexpr int kScenesOfFirst = 80;
  constexpr int kScenesOfFurther = 25;
  constexpr int kMax = 240;
  return settings.scenes.value_or(
      std::min(kScenesOfFirst + kScenesOfFurther * (static_cast<int>(new_objects) - 1), kMax));
}

std::vector<std::string> unobserved_objects(const std::vector<world::RenderedFrame>& frames,
                                            const std::vector<CalibrationObject>& objects,
                                            const std::set<int>& new_ids) {
  std::set<int> seen;
  for (const world::RenderedFrame& frame : frames) {
    for (const GroundTruthObject& object : frame.objects) seen.insert(object.object_id);
  }
  std::vector<std::string> names;
  for (const CalibrationObject& object : objects) {
    const int id = object.in_scene.id;
    if (new_ids.count(id) > 0 && seen.count(id) == 0) names.push_back(object.name);
  }
  return names;
}

std::set<int> new_objects_of(const Forest& forest, const std::set<int>& new_ids) {
  std::set<int> ids;
  for (const ObjectClass& object : forest.classes) {
    if (new_ids.count(object.class_id) > 0) ids.insert(object.class_id);
  }
  return ids;
}

std::vector<world::CalibrationSceneObject> interleave_distractors(
    const std::vector<world::CalibrationSceneObject>& objects, const std::set<int>& group_ids) {
  constexpr std::size_t kFurther = 6;  // objects beside the first that a room may have
  std::vector<const world::CalibrationSceneObject*> members;
  std::vector<const world::CalibrationSceneObject*> distractors;
  for (const world::CalibrationSceneObject& object : objects)
    (group_ids.count(object.id) > 0 ? members : distractors).push_back(&object);
  const std::size_t between = (kFurther + members.size() - 1) / members.size();
  const std::size_t rounds =
      std::max<std::size_t>((distractors.size() + between * members.size() - 1) / (between * members.size()), 1);
  const std::size_t places = rounds * members.size();
  std::vector<world::CalibrationSceneObject> ordered;
  for (std::size_t i = 0; i < places; ++i) {
    ordered.push_back(*members[i % members.size()]);
    for (std::size_t k = i * distractors.size() / places; k < (i + 1) * distractors.size() / places; ++k)
      ordered.push_back(*distractors[k]);
  }
  return ordered;
}

std::map<std::string, CalibratedObject> calibrate_on_scenes(const std::vector<CalibrationObject>& objects,
                                                            const std::set<int>& new_ids,
                                                            const CalibrationSettings& settings,
                                                            std::vector<Forest>& groups) {
  require(settings.scenes.value_or(0) <= CalibrationSettings::kMaxScenes,
          "{} practice rooms, expected at most {}: all are in memory", settings.scenes.value_or(0),
          CalibrationSettings::kMaxScenes);
  std::vector<GroupCalibration> calibrations = calibrations_of(objects, new_ids, settings, groups);
  for (GroupCalibration& calibration : calibrations) {
    render_frames_of(calibration);
    warn_of_unobserved(unobserved_objects(calibration.frames, objects, calibration.ids),
                       static_cast<int>(calibration.frames.size()) / world::CalibrationScenes::kFramesPerScene);
    learn_scores(calibration, groups[calibration.place]);
    if (calibrations.size() > 1) calibration.frames.clear();  // of all groups at once they take too much memory
  }
  quality::PosedModels models;
  models.tone = groups.front().features.tone;
  std::map<std::string, PoseModel> pose_models;
  for (const CalibrationObject& object : objects) {
    models.meshes[object.name] = object.mesh;
    models.vote_centres[object.name] = object.vote_centre;
    models.symmetries[object.name] = object.symmetries;
    models.shape_symmetries[object.name] = object.shape_symmetry;
    pose_models[object.name] = make_pose_model(object.mesh, object.symmetries);
  }
  const quality::UnfilteredPoseFinder finder(models, 1);
  std::map<std::string, CalibratedObject> learnt;
  for (GroupCalibration& calibration : calibrations) {
    if (calibration.frames.empty()) render_frames_of(calibration);
    const quality::FoundPoses found = find_poses(calibration, finder, groups);
    calibration.frames.clear();
    const float reported_from = detection_settings(groups[calibration.place]).evidence.threshold;
    learnt.merge(learn_from_poses(calibration, objects, found, pose_models, reported_from));
  }
  return learnt;
}

}  // namespace houghstream::teach
