#include "pose/pose_estimator.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "pose/registration/flat_candidates.hpp"
#include "pose/seen/camera_colours.hpp"
#include "pose/seen/foreground_search.hpp"
#include "pose/verification/pose_decision.hpp"
#include "pose/verification/shared_surface.hpp"
#include "pose/verification/texture_comparison.hpp"

namespace houghstream {
namespace {

/// Holds what the stages have found for one detection.
struct Estimation {
  const Detection& detection;
  const ObjectModel& model;
  ObjectPose& pose;  ///< published result; its status is kInvalid until it is decided
  std::optional<ObjectObservation> observation = std::nullopt;
  std::vector<RotationCandidate> rotations = {};
  std::vector<PoseCandidate> candidates = {};
  std::vector<RegistrationResult> registered = {};  ///< the candidates after coarse registration, in their order
  std::vector<RegistrationResult> selected = {};    ///< the best first
  std::vector<PoseEvidence> evidence = {};          ///< evidence of the selected poses
  std::size_t published = 0;                        ///< index of the selected pose that is published, or would be
  /// Sure pose (WarmStartSettings::sure_quality) of an earlier frame that the selected one continues, or null.
  const ObjectPose* continued = nullptr;
};

ObjectPoses undecided_poses(const Detections& detections) {
  ObjectPoses poses;
  poses.frame = detections.frame;
  poses.stages = detections.stages;
  for (const Detection& detection : detections.detections) {
    ObjectPose pose;
    pose.class_id = detection.class_id;
    pose.class_name = detection.class_name;
    pose.detection_score = detection.score;
    pose.detection_index = static_cast<int>(poses.poses.size());
    pose.residual = std::numeric_limits<float>::quiet_NaN();
    poses.poses.push_back(std::move(pose));
  }
  return poses;
}

/// Returns the reason why no pose is estimated, or kInvalid.
PoseStatus initial_status(const Detection& detection, bool has_model, const PoseSettings& settings) {
  const Eigen::Vector3f& centre_camera = detection.centre_camera;
  if (!has_model) return PoseStatus::kNoModel;
  if (detection.score < settings.min_score) return PoseStatus::kLowScore;
  if (!centre_camera.allFinite() || !(centre_camera.z() > 0.0F)) return PoseStatus::kNoInitialPose;
  return PoseStatus::kInvalid;
}

/// Rejects a weak detection as the one that it repeats was rejected.
void repeat_rejection(const ObjectPose& rejected, ObjectPose& pose) {
  ObjectPose repeated = rejected;
  repeated.detection_score = pose.detection_score;
  repeated.detection_index = pose.detection_index;
  pose = std::move(repeated);
}

/// Returns the detections whose pose is estimated; `poses` of the others get the reason why not, or the rejection of an
/// earlier frame.
std::vector<Estimation> make_estimations(const Detections& detections, const std::map<std::string, ObjectModel>& models,
                                         const ObjectPoses& earlier, const PoseSettings& settings,
                                         std::vector<ObjectPose>& poses) {
  std::vector<Estimation> estimations;
  estimations.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Detection& detection = detections.detections[i];
    const auto model = models.find(detection.class_name);
    poses[i].status = initial_status(detection, model != models.end(), settings);
    if (poses[i].status != PoseStatus::kInvalid) continue;
    const ObjectPose* rejected = find_rejected(detection, detections.frame.utime, earlier, settings.warm_start);
    if (rejected != nullptr) {
      repeat_rejection(*rejected, poses[i]);
    } else {
      estimations.push_back({detection, model->second, poses[i]});
    }
  }
  return estimations;
}

void observe_region(const FrameContext& frame, const PoseSettings& settings, Estimation& estimation) {
  estimation.observation.emplace(observe_object(frame, estimation.detection, estimation.model, settings.region));
  if (estimation.observation->region.points < settings.region.min_points)
    estimation.pose.status = PoseStatus::kTooFewPoints;
}

void find_candidates(const ObjectPoses& earlier, const PoseSettings& settings, Estimation& estimation) {
  estimation.rotations = rotation_clusters(estimation.detection.rotations, settings.initial);
  estimation.candidates = place_candidates(*estimation.observation, estimation.rotations, settings.search);
  if (static_cast<double>(estimation.model.thickness) < settings.search.max_flat_thickness_m) {
    estimation.observation->foreground = find_surface_foreground(*estimation.observation);
    const std::vector<PoseCandidate> flat = flat_candidates(*estimation.observation, settings.search.flat_keep);
    estimation.candidates.insert(estimation.candidates.end(), flat.begin(), flat.end());
  }
  const std::vector<PoseCandidate> warm =
      earlier_candidates(*estimation.observation, estimation.detection.class_name, earlier, settings.warm_start);
  estimation.candidates.insert(estimation.candidates.end(), warm.begin(), warm.end());
  if (estimation.candidates.empty()) estimation.pose.status = PoseStatus::kNoInitialPose;
}

/// Returns the reason to give a candidate up after its first registration, or kInvalid.
PoseStatus early_rejection_reason(const PoseSettings& settings, const ExplainedSurface& explained,
                                  const Estimation& estimation, const RegistrationResult& best) {
  if (publication_probability(*estimation.observation, best, estimation.detection.score,
                              pose_selection_settings(settings)) < settings.min_publication_probability)
    return PoseStatus::kLowScore;
  if (!explained.is_empty() &&
      explained.fraction_of(estimation.observation->frame, {estimation.model, best.T_camera_object},
                            {settings.verification.tolerance_m, settings.noise}) > settings.max_explained_surface)
    return PoseStatus::kRefuted;
  return PoseStatus::kInvalid;
}

/// Selects among the registered candidates and their rotations, but for one that continues a sure pose of an earlier
/// frame: that one's rotations were searched then.
void select_pose(const ObjectPoses& earlier, const PoseSettings& settings, const ExplainedSurface& explained,
                 Estimation& estimation) {
  const PoseSelectionSettings selection = pose_selection_settings(settings);
  const RegistrationResult best =
      best_registered(*estimation.observation, estimation.registered, estimation.rotations, selection);
  if (best.inliers == 0) {
    estimation.pose.status = PoseStatus::kNotConverged;
  } else if (!estimation.detection.reported) {
    estimation.pose.status = early_rejection_reason(settings, explained, estimation, best);
  }
  if (estimation.pose.status == PoseStatus::kInvalid) {
    const ObjectObservation& observation = *estimation.observation;
    estimation.continued = find_continued(observation, best.T_camera_object, estimation.detection.class_name, earlier,
                                          settings.warm_start);
    if (estimation.continued != nullptr) {
      estimation.selected = {refine_rotation(observation, best, estimation.rotations, selection)};
    } else {
      estimation.selected = select_poses(observation, best, estimation.rotations, selection);
    }
  }
  copy_registration_evidence(estimation.selected.empty() ? best : estimation.selected.front(), estimation.pose);
}

void gather_all_evidence(const PoseSettings& settings, Estimation& estimation) {
  const QualitySettings& quality = class_quality_of(settings, estimation.pose.class_name);
  for (const RegistrationResult& result : estimation.selected) {
    estimation.evidence.push_back(gather_evidence(*estimation.observation, result.T_camera_object,
                                                  estimation.detection.score, settings.verification));
    std::optional<ChromaPair> pair = chroma_pair(estimation.pose.class_name, estimation.evidence.back(), quality);
    if (pair && (!estimation.pose.chroma || pair->probability > estimation.pose.chroma->probability))
      estimation.pose.chroma = std::move(pair);
  }
}

/// Learns of all objects together how the camera renders colours, for each undecided object without its class.
void learn_camera_colours(const RgbdFrame& frame, const std::vector<ChromaPair>& remembered,
                          std::vector<Estimation>& estimations) {
  if (is_colourless(frame.colour)) {
    for (Estimation& estimation : estimations) {
      estimation.pose.camera_colours = colourless_camera();
      estimation.pose.chroma.reset();
    }
    return;
  }
  std::vector<ChromaPair> pairs;
  for (const Estimation& estimation : estimations) {
    if (estimation.pose.chroma) pairs.push_back(*estimation.pose.chroma);
  }
  pairs.insert(pairs.end(), remembered.begin(), remembered.end());
  const std::vector<ChromaMap> maps = fit_chroma_maps_without_each(pairs);
  auto next = maps.begin();
  for (Estimation& estimation : estimations) {
    if (!estimation.pose.chroma) continue;
    if (estimation.pose.status == PoseStatus::kInvalid) estimation.pose.camera_colours = *next;
    ++next;
  }
}

/// Returns the pose of a result with the status that its evidence decides.
ObjectPose decide_pose(const Estimation& estimation, const RegistrationResult& result, const PoseEvidence& evidence,
                       const PoseSettings& settings) {
  ObjectPose decided = estimation.pose;
  decided.T_camera_object.reset();
  copy_registration_evidence(result, decided);
  decide_status(evidence, result.T_camera_object, estimation.detection.reported,
                class_quality_of(settings, estimation.pose.class_name), decided);
  return decided;
}

/// Decides by the pose with the strongest evidence; some pose was selected.
void decide_best(const PoseSettings& settings, Estimation& estimation) {
  std::optional<ObjectPose> best;
  for (std::size_t i = 0; i < estimation.selected.size(); ++i) {
    bring_to_camera(estimation.pose.camera_colours, estimation.evidence[i]);
    ObjectPose decided = decide_pose(estimation, estimation.selected[i], estimation.evidence[i], settings);
    if (best && !(decided.quality > best->quality)) continue;
    best = std::move(decided);
    estimation.published = i;
  }
  estimation.pose = *std::move(best);
}

/// Takes the texture's verdict over from the pose that is continued.
void inherit_texture(const PoseSettings& settings, Estimation& estimation) {
  const ObjectPose& continued = *estimation.continued;
  PoseEvidence& evidence = estimation.evidence[estimation.published];
  evidence.texture_probability = texture_probability_of(continued);
  estimation.pose = decide_pose(estimation, estimation.selected[estimation.published], evidence, settings);
  estimation.pose.continued_frames = continued.continued_frames + 1;
}

/// Selects the pose that the texture supports among those that are equivalent by shape, with its probability; also for
/// rejected poses, whose quality is reported too.
void resolve_symmetry(const PoseSettings& settings, Estimation& estimation) {
  constexpr float kMinShapeQuality = 0.1F;  // a pose that is wrong by its shape stays wrong
  if (estimation.pose.shape_quality < kMinShapeQuality) return;
  if (estimation.continued != nullptr) return inherit_texture(settings, estimation);
  const DepthTolerance tolerance{settings.verification.tolerance_m, estimation.observation->noise};
  const TextureSettings& learnt = class_quality_of(settings, estimation.pose.class_name).texture;
  const RegistrationResult& published = estimation.selected[estimation.published];
  const std::optional<TextureComparison> texture =
      compare_with_alternatives(*estimation.observation, published.T_camera_object, tolerance, settings.registration);
  if (!texture) return;
  const auto decide = [&](RegistrationResult result, const std::optional<TextureComparison>& compared) {
    if (compared && compared->aligned) result.T_camera_object = *compared->aligned;
    PoseEvidence evidence = gather_evidence(*estimation.observation, result.T_camera_object, estimation.detection.score,
                                            settings.verification);
    bring_to_camera(estimation.pose.camera_colours, evidence);
    evidence.texture_probability = compared ? texture_probability(compared->margin, learnt) : 1.0F;
    return decide_pose(estimation, result, evidence, settings);
  };
  PoseEvidence& published_evidence = estimation.evidence[estimation.published];
  published_evidence.texture_probability = texture_probability(texture->margin, learnt);
  ObjectPose decided =
      texture->aligned ? decide(published, texture) : decide_pose(estimation, published, published_evidence, settings);
  if (texture->better) {
    const RegistrationResult refined =
        refine_pose(*estimation.observation, *texture->better, estimation.rotations, pose_selection_settings(settings));
    const std::optional<TextureComparison> refined_texture =
        compare_with_alternatives(*estimation.observation, refined.T_camera_object, tolerance, settings.registration);
    ObjectPose rotated = decide(refined, refined_texture);
    if (refined.inliers > 0 && rotated.quality > decided.quality) decided = std::move(rotated);
  }
  estimation.pose = std::move(decided);
}

/// Adds the models that have a pose.
void add_explained_surface(const std::vector<ObjectPose>& poses, const std::map<std::string, ObjectModel>& models,
                           ExplainedSurface& explained) {
  for (const ObjectPose& pose : poses) {
    const auto model = models.find(pose.class_name);
    if (pose.T_camera_object && model != models.end()) explained.add({model->second, *pose.T_camera_object});
  }
}

/// Returns whether the centres of two objects are closer than `ratio` times the smaller radius. False without a model.
bool are_centres_closer(const std::map<std::string, ObjectModel>& models, const PlacedObject& a, const PlacedObject& b,
                        double ratio) {
  const auto model_a = models.find(a.class_name);
  const auto model_b = models.find(b.class_name);
  if (model_a == models.end() || model_b == models.end()) return false;
  const Eigen::Vector3d centre_a = a.T_camera_object * model_a->second.centre.cast<double>();
  const Eigen::Vector3d centre_b = b.T_camera_object * model_b->second.centre.cast<double>();
  return (centre_a - centre_b).norm() < ratio * std::min(model_a->second.radius, model_b->second.radius);
}

/// Returns whether `a` is less probable than `b` where both are one object: of one class by its quality, of two classes
/// by its shape_quality, since the texture tells which way round an object is, not which object it is. Of two that are
/// equally probable the later one is less probable.
bool is_less_probable(const ObjectPose& a, const ObjectPose& b) {
  const bool by_shape = a.class_name != b.class_name;
  const float probability_a = by_shape ? a.shape_quality : a.quality;
  const float probability_b = by_shape ? b.shape_quality : b.quality;
  return probability_a < probability_b || (probability_a == probability_b && &b < &a);
}

/// Compares each pose with the surest of its class in the frame, among those of the frame and the known ones.
void compare_instances(const Detections& detections, const PoseSettings& settings, const ObjectPoses& known,
                       std::vector<ObjectPose>& poses) {
  std::map<std::string, const ObjectPose*> surest;
  const auto add = [&](const std::vector<ObjectPose>& seen) {
    for (const ObjectPose& pose : seen) {
      if (!pose.T_camera_object || !pose.chroma) continue;
      const ObjectPose*& best = surest[pose.class_name];
      if (best == nullptr || pose.shape_quality > best->shape_quality) best = &pose;
    }
  };
  add(known.poses);
  add(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ObjectPose& pose = poses[i];
    if (!pose.T_camera_object || !pose.chroma) continue;
    const ObjectPose& surer = *surest.at(pose.class_name);
    if (&surer != &pose)
      compare_with_instance(surer, detections.detections[i].reported, class_quality_of(settings, pose.class_name),
                            pose);
  }
}

/// Withholds the less probable of two poses of one object, as of two detections of it, or of two classes that look
/// alike.
void withhold_duplicates(const PoseEstimator& estimator, const RgbdFrame& frame, std::vector<ObjectPose>& poses) {
  for (ObjectPose& pose : poses) {
    if (!pose.T_camera_object) continue;
    const PlacedObject placed{pose.class_name, *pose.T_camera_object};
    const auto better = std::find_if(poses.begin(), poses.end(), [&](const ObjectPose& other) {
      return &other != &pose && other.T_camera_object && is_less_probable(pose, other) &&
             estimator.is_same_object(frame, placed, {other.class_name, *other.T_camera_object});
    });
    if (better != poses.end()) withhold_duplicate(*better, pose);
  }
}

/// Remembers where weak detections were searched and rejected, for the next frame (find_rejected).
void note_rejections(std::int64_t utime, const std::vector<Estimation>& estimations) {
  for (const Estimation& estimation : estimations) {
    if (!estimation.detection.reported && !has_pose(estimation.pose.status))
      estimation.pose.rejected_search = RejectedSearch{estimation.detection.centre_camera, utime};
  }
}

}  // namespace

struct PoseEstimator::State {
  std::map<std::string, ObjectModel> models;
  PoseSettings settings;
};

PoseEstimator::PoseEstimator(std::map<std::string, Mesh> models, PoseSettings settings, int threads)
    : state_(std::make_unique<State>()) {
  check_settings(settings, "pose settings");
  struct ModelJob {
    const std::string& name;
    Mesh* mesh;
    ObjectModel& model;
  };
  std::vector<ModelJob> jobs;
  jobs.reserve(models.size());
  for (auto& named : models) jobs.push_back({named.first, &named.second, state_->models[named.first]});
  // Models made one after another would leave threads idle at the end of each; a single one is made by all of them.
  const int threads_of_each = std::max(1, threads / std::max(1, static_cast<int>(jobs.size())));
  parallel_for(threads, static_cast<int>(jobs.size()), [&](int i) {
    ModelJob& job = jobs[static_cast<std::size_t>(i)];
    job.model = make_object_model(job.name, std::move(*job.mesh), settings.model, threads_of_each);
  });
  state_->settings = std::move(settings);
}

PoseEstimator PoseEstimator::from_models(std::map<std::string, ObjectModel> models, PoseSettings settings) {
  PoseEstimator estimator(std::map<std::string, Mesh>(), std::move(settings));
  estimator.state_->models = std::move(models);
  return estimator;
}

PoseEstimator::~PoseEstimator() = default;
PoseEstimator::PoseEstimator(PoseEstimator&&) noexcept = default;

const std::map<std::string, ObjectModel>& PoseEstimator::models() const {
  return state_->models;
}

const PoseSettings& PoseEstimator::settings() const {
  return state_->settings;
}

ObjectPoses PoseEstimator::estimate(const RgbdFrame& frame, const Detections& detections) const {
  return estimate(frame, detections, {});
}

ObjectPoses PoseEstimator::estimate(const RgbdFrame& frame, const Detections& detections, const ObjectPoses& earlier,
                                    const std::vector<ChromaPair>& remembered, const ObjectPoses& known) const {
  if (frame.id != detections.frame) {
    throw std::logic_error(
        fmt::format("detections of frame {} given with frame {}", to_string(detections.frame), to_string(frame.id)));
  }
  check_frame(frame, "pose estimation");
  const PoseSettings& settings = state_->settings;
  StageClock clock;
  ObjectPoses result = undecided_poses(detections);
  std::vector<Estimation> estimations = make_estimations(detections, state_->models, earlier, settings, result.poses);
  const FrameContext context = make_frame_context(frame, settings.region, settings.noise);
  ExplainedSurface explained;
  add_explained_surface(known.poses, state_->models, explained);
  for (const bool are_reported : {true, false}) {
    const auto for_each = [&](const auto& stage) {
      parallel_for(settings.threads, static_cast<int>(estimations.size()), [&](int i) {
        if (estimations[i].detection.reported == are_reported) stage(estimations[i]);
      });
    };
    const auto for_each_undecided = [&](const auto& stage) {
      for_each([&](Estimation& estimation) {
        if (estimation.pose.status == PoseStatus::kInvalid) stage(estimation);
      });
    };
    for_each_undecided([&](Estimation& estimation) { observe_region(context, settings, estimation); });
    clock.mark("pose.region");
    for_each_undecided([&](Estimation& estimation) { find_candidates(earlier, settings, estimation); });
    clock.mark("pose.candidates");
    for_each_undecided([&](Estimation& estimation) {
      estimation.registered =
          register_candidates(*estimation.observation, estimation.candidates, settings.registration);
    });
    clock.mark("pose.registration");
    for_each_undecided([&](Estimation& estimation) { select_pose(earlier, settings, explained, estimation); });
    clock.mark("pose.choice");
    for_each_undecided([&](Estimation& estimation) { gather_all_evidence(settings, estimation); });
    if (settings.learn_camera_colours) learn_camera_colours(frame, remembered, estimations);
    for_each_undecided([&](Estimation& estimation) { decide_best(settings, estimation); });
    clock.mark("pose.verification");
    for_each([&](Estimation& estimation) { resolve_symmetry(settings, estimation); });
    if (are_reported) add_explained_surface(result.poses, state_->models, explained);
    clock.mark("pose.print");
  }
  withhold_duplicates(*this, frame, result.poses);
  if (settings.compare_instances) compare_instances(detections, settings, known, result.poses);
  note_rejections(frame.id.utime, estimations);
  clock.mark("pose.print");

  result.stages.insert(result.stages.end(), clock.times().begin(), clock.times().end());
  return result;
}

Eigen::Vector3d PoseEstimator::vote_centre(const PlacedObject& object) const {
  const auto model = state_->models.find(object.class_name);
  if (model == state_->models.end()) return object.T_camera_object.translation();
  return object.T_camera_object * model->second.vote_centre.cast<double>();
}

bool PoseEstimator::is_duplicate(const PlacedObject& a, const PlacedObject& b) const {
  return are_centres_closer(state_->models, a, b, state_->settings.duplicate_distance_ratio);
}

bool PoseEstimator::is_same_object(const RgbdFrame& frame, const PlacedObject& a, const PlacedObject& b) const {
  if (a.class_name == b.class_name) return is_duplicate(a, b);
  const auto model_a = state_->models.find(a.class_name);
  const auto model_b = state_->models.find(b.class_name);
  if (model_a == state_->models.end() || model_b == state_->models.end()) return false;
  const DepthTolerance tolerance{state_->settings.verification.tolerance_m, state_->settings.noise};
  return shared_surface(frame, {model_a->second, a.T_camera_object}, {model_b->second, b.T_camera_object}, tolerance) >
         state_->settings.max_shared_surface;
}

bool PoseEstimator::is_duplicate(const PlacedObject& a, const PlacedObject& b, double max_distance_ratio) const {
  return are_centres_closer(state_->models, a, b, max_distance_ratio);
}

void withhold_duplicate(const ObjectPose& other, ObjectPose& pose) {
  pose.T_camera_object.reset();
  pose.status = other.class_name == pose.class_name ? PoseStatus::kLowScore : PoseStatus::kRefuted;
}

}  // namespace houghstream
