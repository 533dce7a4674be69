#include "tools/studies/colours/colour_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "detector/detector.hpp"
#include "detector/stages.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/parallel.hpp"
#include "pose/pose_estimator.hpp"
#include "pose/seen/camera_colours.hpp"
#include "tools/common/progress_line.hpp"
#include "tools/evaluate/metrics/pose_metrics.hpp"
#include "tools/finder/search_options.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/render/world/calibration_scenes.hpp"

namespace houghstream::colours {
namespace {

/// Holds all results through a camera.
struct Found {
  std::vector<EvaluatedFrame> as_taught;
  std::vector<EvaluatedFrame> in_frame;
  std::vector<EvaluatedFrame> in_stream;
};

/// Holds a pose with its outcome in the ground truth.
struct JudgedColours {
  std::size_t frame = 0;
  const ObjectPose* pose = nullptr;
  bool is_correct = false;
};

class Study {
 public:
  Study(const std::filesystem::path& folder, const StudySettings& settings)
      : settings_(settings), store_(store::read_store(folder)), meshes_(store::load_store_meshes(store_)) {
    const std::map<std::string, Symmetries> symmetries = store_.symmetries_by_name();
    for (const auto& [name, mesh] : meshes_) {
      const auto known = symmetries.find(name);
      models_.emplace(name, make_pose_model(mesh, known == symmetries.end() ? Symmetries{} : known->second));
    }
    render();
  }

  std::vector<Row> run() {
    std::vector<StrangeCamera> cameras(1);
    const std::vector<StrangeCamera> strange = strange_cameras(settings_.cameras, settings_.seed);
    cameras.insert(cameras.end(), strange.begin(), strange.end());
    const std::vector<Found> found = search(cameras);
    std::vector<Row> rows;
    std::string pairs =
        "camera,learnt,frame,class,right,score,quality,probability,model_a,model_b,measured_a,measured_b,lightness\n";
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      rows.push_back({i == 0 ? "plain" : cameras[i].name(), figures_of(found[i].as_taught),
                      figures_of(found[i].in_frame), figures_of(found[i].in_stream)});
      pairs +=
          pairs_of(found[i].as_taught, i, 0) + pairs_of(found[i].in_frame, i, 1) + pairs_of(found[i].in_stream, i, 2);
    }
    if (!settings_.pairs.empty()) write_file_atomically(settings_.pairs, pairs);
    return rows;
  }

 private:
  void render() {
    std::vector<world::CalibrationSceneObject> objects;
    for (const store::StoredObject& stored : store_.objects) {
      const Mesh& mesh = meshes_.at(stored.name);
      world::CalibrationSceneObject& object = objects.emplace_back();
      object.id = stored.id;
      object.thing = world::make_taught_thing(mesh, stored.coloured);
      object.ups = world::up_directions(mesh, world::parse_mesh_attitudes(stored.attitudes));
      object.has_colour = stored.coloured;
    }
    constexpr std::uint64_t kRooms = 0x636F6C6F757273ULL;
    const world::CalibrationScenes scenes(std::move(objects), settings_.seed ^ kRooms);
    constexpr int kEach = world::CalibrationScenes::kFramesPerScene;
    frames_.resize(static_cast<std::size_t>(settings_.rooms * kEach));
    parallel_for(settings_.threads, settings_.rooms, [&](int room) {
      auto rendered = scenes.render(room);
      for (std::size_t k = 0; k < rendered.size(); ++k) {
        rendered[k].visible_masks.clear();
        frames_[static_cast<std::size_t>(room * kEach) + k] = std::move(rendered[k]);
      }
    });
  }

  EvaluatedFrame truth_of(std::size_t index) const {
    EvaluatedFrame frame;
    for (const GroundTruthObject& object : frames_[index].objects) {
      const auto known = std::find_if(store_.objects.begin(), store_.objects.end(),
                                      [&](const store::StoredObject& stored) { return stored.id == object.object_id; });
      frame.objects.push_back({known->name, object, std::nullopt});
    }
    return frame;
  }

  PoseEstimator estimator(bool learn) const {
    PoseSettings settings;
    settings.threads = 1;
    settings.learn_camera_colours = learn;
    return PoseEstimator(meshes_, without_rejection(pose_settings_of(settings, store_, std::nullopt)),
                         settings_.threads);
  }

  Detector detector(bool learn) const {
    SearchOptions options;
    options.threads = 1;
    options.threshold = PoseSettings{}.min_score;
    options.learn_camera_colours = learn;
    return detector_of(load_store_forests(store_, options.threads), options);
  }

  /// Detects and estimates poses as hs-detect and hs-pose do, except that no pose is rejected.
  std::vector<Found> search(const std::vector<StrangeCamera>& cameras) const {
    const Detector plain_detector = detector(false);
    const Detector learning_detector = detector(true);
    const PoseEstimator as_taught = estimator(false);
    const PoseEstimator learning = estimator(true);
    PerWorker<DetectorWorkspace> workspaces;
    workspaces.resize(settings_.threads);
    std::vector<Found> found(cameras.size());
    ProgressLine progress("cameras", static_cast<double>(cameras.size()));
    parallel_for_workers(settings_.threads, static_cast<int>(cameras.size()), [&](int worker, int camera) {
      const auto c = static_cast<std::size_t>(camera);
      CameraColours colours;
      const auto look = [&](const Detector& detector, const PoseEstimator& estimator, std::size_t f,
                            const std::vector<ChromaPair>& remembered) {
        const RgbdFrame frame = seen_by(cameras[c], f);
        Detections all = detector.detect(frame, workspaces[worker], remembered);
        for (Detection& it : all.detections) it.reported = it.score >= EvidenceSettings{}.threshold;
        const Detections sent = sent_of(all);
        for (Detection& it : all.detections) it.rotations = {};
        EvaluatedFrame result = truth_of(f);
        result.detections = std::move(all);
        return posed(std::move(result), estimator.estimate(frame, sent, {}, remembered));
      };
      for (std::size_t f = 0; f < frames_.size(); ++f) {
        found[c].as_taught.push_back(look(plain_detector, as_taught, f, {}));
        found[c].in_frame.push_back(look(learning_detector, learning, f, {}));
        colours.update(*found[c].in_frame.back().poses);
      }
      for (std::size_t f = 0; f < frames_.size(); ++f) {
        found[c].in_stream.push_back(look(learning_detector, learning, f, colours.pairs()));
        colours.update(*found[c].in_stream.back().poses);
      }
      progress.add(1.0);
    });
    return found;
  }

  RgbdFrame seen_by(const StrangeCamera& camera, std::size_t index) const {
    RgbdFrame frame = frames_[index].frame;
    frame.colour = frame.colour.clone();
    Random random = Random::for_item(settings_.seed, index);
    training::apply_colour(camera.camera, frame.colour, random);
    return frame;
  }

  static Detections sent_of(const Detections& all) {
    Detections sent{all.frame, {}, {}};
    int candidates = EvidenceSettings{}.max_candidates;
    for (const Detection& detection : all.detections) {
      if (!detection.reported && (detection.score < kCandidatesFrom || --candidates < 0)) break;
      sent.detections.push_back(detection);
    }
    return sent;
  }

  /// Returns the result with these poses, which are of its first detections.
  static EvaluatedFrame posed(EvaluatedFrame result, ObjectPoses poses) {
    for (std::size_t i = poses.poses.size(); i < result.detections->detections.size(); ++i) {
      ObjectPose& pose = poses.poses.emplace_back();
      pose.class_name = result.detections->detections[i].class_name;
      pose.detection_index = static_cast<int>(i);
      pose.status = PoseStatus::kLowScore;
    }
    result.poses = std::move(poses);
    return result;
  }

  /// The poses of detections that are true or false, of all classes.
  std::vector<JudgedColours> judge(const std::vector<EvaluatedFrame>& frames) const {
    std::vector<JudgedColours> judged;
    for (const auto& [name, model] : models_) {
      for (const MatchedDetection& match : match_detections(frames, name, DetectionRules{})) {
        const EvaluatedFrame& frame = frames[match.frame];
        const ObjectPose& pose = frame.poses->poses[match.index];
        if (match.outcome == MatchOutcome::kIgnored || !pose.T_camera_object) continue;
        const bool is_true = match.outcome == MatchOutcome::kTruePositive;
        judged.push_back(
            {match.frame, &pose,
             is_true && is_correct(model, *pose.T_camera_object, frame.objects[match.object].truth.T_camera_object)});
      }
    }
    return judged;
  }

  bool is_published(const JudgedColours& it, const std::vector<EvaluatedFrame>& frames) const {
    const Detection& detection =
        frames[it.frame].detections->detections[static_cast<std::size_t>(it.pose->detection_index)];
    return it.pose->quality >= (detection.reported ? kStoreQuality : kStoreCandidateQuality);
  }

  Figures figures_of(const std::vector<EvaluatedFrame>& frames) const {
    Figures out;
    std::vector<ClassResult> classes;
    for (const auto& [name, model] : models_) {
      classes.push_back(evaluate_class(frames, name, DetectionRules{}));
      out.objects += classes.back().required;
    }
    out.auc = weighted_auc(classes);
    std::vector<JudgedColours> judged = judge(frames);
    std::stable_sort(judged.begin(), judged.end(),
                     [](const JudgedColours& a, const JudgedColours& b) { return a.pose->quality > b.pose->quality; });
    std::vector<Prediction> qualities;
    std::vector<double> off;
    std::vector<double> wrong_off;
    int right = 0;
    for (std::size_t i = 0; i < judged.size(); ++i) {
      const JudgedColours& it = judged[i];
      right += it.is_correct ? 1 : 0;
      if (it.is_correct) out.pose_auc += static_cast<double>(right) / static_cast<double>(i + 1) / out.objects;
      if (is_published(it, frames)) ++out.published;
      if (is_published(it, frames) && it.is_correct) ++out.right;
      qualities.push_back({it.pose->quality, it.is_correct});
      if (!it.pose->chroma) continue;
      const ChromaPair& pair = *it.pose->chroma;
      (it.is_correct ? off : wrong_off)
          .push_back((pair.measured - it.pose->camera_colours.apply(pair.model, pair.lightness)).norm());
    }
    out.ece = calibrate(qualities, right).ece;
    out.off = median(off);
    double told = 0.0;
    for (const double a : off)
      for (const double b : wrong_off) told += a < b ? 1.0 : 0.0;
    out.conflict = told / static_cast<double>(off.size() * wrong_off.size());
    return out;
  }

  static double median(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
  }

  std::string pairs_of(const std::vector<EvaluatedFrame>& frames, std::size_t camera, int learnt) const {
    std::string lines;
    for (const JudgedColours& it : judge(frames)) {
      if (!it.pose->chroma) continue;
      const ChromaPair& pair = *it.pose->chroma;
      lines += fmt::format("{},{},{},{},{},{:.3f},{:.4f},{:.4f},{:.2f},{:.2f},{:.2f},{:.2f},{:.1f}\n", camera, learnt,
                           it.frame, pair.class_name, it.is_correct ? 1 : 0, it.pose->detection_score, it.pose->quality,
                           pair.probability, pair.model.x(), pair.model.y(), pair.measured.x(), pair.measured.y(),
                           pair.lightness);
    }
    return lines;
  }

  StudySettings settings_;
  store::ObjectStore store_;
  std::map<std::string, Mesh> meshes_;
  std::map<std::string, PoseModel> models_;
  std::vector<world::RenderedFrame> frames_;
};

Figures mean_of(const std::vector<Row>& rows, Figures Row::*which) {
  Figures mean;
  const auto count = static_cast<double>(rows.size());
  for (const Row& row : rows) {
    const Figures& it = row.*which;
    mean.objects += it.objects;
    mean.published += it.published;
    mean.right += it.right;
    mean.auc += it.auc / count;
    mean.pose_auc += it.pose_auc / count;
    mean.ece += it.ece / count;
    mean.off += it.off / count;
    mean.conflict += it.conflict / count;
  }
  return mean;
}

std::string to_line(const Figures& it) {
  return fmt::format("{:5.3f} {:5.3f} {:4d}/{:4d} of {:4d} {:5.3f} {:5.1f} {:5.3f}", it.auc, it.pose_auc, it.right,
                     it.published, it.objects, it.ece, it.off, it.conflict);
}

}  // namespace

std::vector<Row> study_cameras(const std::filesystem::path& store, const StudySettings& settings) {
  std::vector<Row> rows = Study(store, settings).run();
  const std::vector<Row> strange(rows.begin() + 1, rows.end());
  rows.push_back({"mean of the strange ones", mean_of(strange, &Row::as_taught), mean_of(strange, &Row::in_frame),
                  mean_of(strange, &Row::in_stream)});
  return rows;
}

std::string to_table(const std::vector<Row>& rows) {
  std::string out = fmt::format(
      "{:40} auc  poses right/published  ece  off  told | the same, colours learnt in each frame | learnt in the "
      "stream\n",
      "");
  for (const Row& row : rows)
    out += fmt::format("{:40} {} | {} | {}\n", row.name, to_line(row.as_taught), to_line(row.in_frame),
                       to_line(row.in_stream));
  return out;
}

}  // namespace houghstream::colours
