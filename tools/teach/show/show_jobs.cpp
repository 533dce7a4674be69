#include "tools/teach/show/show_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "drivers/store/object_store.hpp"
#include "drivers/store/store_transaction.hpp"
#include "pipeline/base/checks.hpp"
#include "pose/fusion/surface_nets.hpp"
#include "pose/reconstruction/model/take_model.hpp"
#include "pose/reconstruction/tracking/take_mapper.hpp"
#include "tools/common/usage_error.hpp"
#include "tools/teach/mesh/mesh_checks.hpp"
#include "tools/teach/mesh/teach_jobs.hpp"
#include "tools/teach/show/session_archive.hpp"
#include "tools/teach/show/show_options.hpp"
#include "tools/teach/show/show_progress.hpp"
#include "tools/teach/show/show_report.hpp"
#include "tools/teach/show/show_sources.hpp"
#include "tools/teach/show/turntable_videos.hpp"

namespace houghstream::teach {
namespace {

using reconstruction::ReconstructedModel;
using reconstruction::Take;
using reconstruction::TakeMapper;

/// Makes a training view: the object with a margin, in the brightness in which it is searched.
void crop_to_object(TrainingView& view) {
  constexpr int kMargin_px = 8;
  const AffineBrightness tone = fit_affine_brightness(view.frame.colour, kCalibrationBrightness);
  cv::Rect crop = cv::boundingRect(view.mask);
  crop = cv::Rect(crop.x - kMargin_px, crop.y - kMargin_px, crop.width + 2 * kMargin_px, crop.height + 2 * kMargin_px) &
         cv::Rect({0, 0}, view.mask.size());
  cv::Mat colour;
  apply_affine_brightness(tone, view.frame.colour(crop), colour);
  view.frame.colour = colour;
  view.frame.depth = view.frame.depth(crop).clone();
  view.frame.camera = view.frame.camera.cropped(crop.x, crop.y, crop.width, crop.height);
  view.mask = view.mask(crop).clone();
}

/// Gives the model of the takes the colours that it has in images of the tone in which it is looked for.
void bring_into_tone(const std::vector<Take>& takes, std::vector<cv::Vec3b>& colours) {
  if (colours.empty()) return;
  AffineBrightness mean{0.0F, 0.0F};
  float count = 0.0F;
  for (const Take& take : takes) {
    for (const reconstruction::Keyframe& keyframe : take.keyframes) {
      const AffineBrightness tone = fit_affine_brightness(keyframe.frame.colour, kCalibrationBrightness);
      mean.gain += tone.gain;
      mean.offset += tone.offset;
      count += 1.0F;
    }
  }
  if (count == 0.0F) return;
  cv::Mat all(colours);  // lies where they do
  apply_affine_brightness({mean.gain / count, mean.offset / count}, all, all);
}

/// Makes the teaching of a shown object: its mesh as if hs-teach mesh had read it, and the keyframes' views of it, all
/// in the brightness in which objects are searched. Throws InputError for a mesh that cannot be taught.
TeachOptions options_to_teach(const ShowOptions& options, const ShowResult& shown) {
  TeachOptions teach;
  TaughtMesh mesh;
  mesh.name = options.name;
  mesh.file = "shown: " + options.source;
  mesh.mesh = shown.mesh;
  check_mesh(options.name, 1e-3, mesh.mesh);
  mesh.coloured = has_colour(mesh.mesh);
  bring_into_tone(shown.takes, mesh.mesh.colours);
  teach.shown = {std::move(mesh)};
  for (std::size_t t = 0; t < shown.takes.size(); ++t) {
    std::vector<TrainingView> own = training_views(shown.takes[t], shown.views[t], options.name);
    for (TrainingView& view : own) {
      crop_to_object(view);
      teach.own_views.push_back(std::move(view));
    }
  }
  teach.out = options.out;
  teach.add = options.add;
  teach.replace = options.replace;
  teach.backgrounds.cache = options.backgrounds_cache;
  teach.backgrounds.threads = options.threads;
  teach.seed = options.seed;
  teach.threads = options.threads;
  return teach;
}

/// Refuses two takes of one camera that begin at once, between which nobody can turn the object over; videos have no
/// second take.
void check_second(const ShowOptions& options) {
  if (options.second.empty()) return;
  require(options.second.rfind("openni2", 0) != 0,
          "--second {}: a camera, expected a recording: record each take with hs-capture --source openni2 --log FILE, "
          "then give log:FILE as --source and as --second",
          options.second);
  for (const std::string& source : {options.source, options.second})
    require(!is_turntable_videos(source),
            "--second goes with takes, but {} holds turntable videos, expected all of an instance in that one folder",
            source);
}

/// Checks all conditions before the take, which is laborious to repeat.
void check_show_options(const ShowOptions& options) {
  store::require_new_name(options.name, "--name");
  if (!options.keep.empty()) require_keepable(options.keep);
  if (!options.teach) return;
  require_usage(!options.out.empty(), "--out is missing, expected the store to teach into, or --no-teach");
  store::require_place_for_store(options.out);
  store::recover_store(options.out);
  if (!options.add && !options.replace) require_no_store(options.out);
  if (!options.add) return;
  const store::ObjectStore known = store::read_store(options.out);
  const bool is_known = std::any_of(known.objects.begin(), known.objects.end(),
                                    [&](const store::StoredObject& object) { return object.name == options.name; });
  require(!is_known,
          "--name {}: the store {} has such an object already, expected a new name, or hs-teach remove first",
          options.name, options.out.string());
}

/// Returns the defect of a first frame as text; empty where there is none.
std::string lack_of(const RgbdFrame& frame) {
  const std::string name = fmt::format("frame {}", to_string(frame.id));
  check_frame(frame, name);
  cv::Scalar mean, deviation;
  cv::meanStdDev(frame.colour, mean, deviation);
  if (!(deviation[0] + deviation[1] + deviation[2] > 0.0))
    return fmt::format("{}: no colour, expected a picture", name);
  if (cv::countNonZero(frame.depth == frame.depth) == 0)
    return fmt::format("{}: no depth at all, expected depth registered to colour", name);
  return {};
}

reconstruction::ReconstructionSettings making_of(const ShowOptions& options) {
  reconstruction::ReconstructionSettings making;
  making.threads = options.threads;
  return making;
}

/// The selected object.
struct TakeSource {
  std::string name;             ///< name for messages
  const ShownFrames& frames;    ///< frames of it
  std::optional<cv::Rect> box;  ///< box of the object in the first frame; none: it is chosen
  std::optional<cv::Point> at;  ///< place at which it is chosen, or the middle
};

struct ModelledTake {
  Take take;
  ReconstructedModel model;
};

Take follow(const TakeSource& source, const ShowOptions& options, ProgressReporter& reporter) {
  constexpr std::size_t kMin = 20;
  constexpr int kAwake = 90;   // frames after which a camera has found its exposure
  constexpr int kAimed = 300;  // frames in which somebody has pointed it at the object
  const bool live = is_live(source.name);
  reconstruction::TakeMapperSettings settings;
  if (live && !source.at) settings.max_frames_to_choose = kAimed;
  settings.selection.box_px = source.box;
  settings.selection.at_px = source.at;
  settings.selection.seed = options.seed;
  settings.map.threads = options.threads;
  TakeMapper mapper(settings);
  int blank = 0;
  while (const std::optional<RgbdFrame> frame = source.frames()) {
    if (mapper.state().frames == 0) {
      reconstruction::TakeMapperStatus waiting;
      waiting.message = lack_of(*frame);
      if (!waiting.message.empty()) {
        require(live && ++blank < kAwake, "{}", waiting.message);
        reporter.frame(frame->id, waiting);
        continue;
      }
    }
    reporter.frame(frame->id, mapper.process(*frame));
  }
  if (mapper.state().frames > 0) reporter.step(TeachingState::kFusing, 0.0, "all keyframes are laid on one another");
  Take take = mapper.finish();
  require(take.frames.size() >= kMin, "{} frames, expected at least {}, of a whole turn", take.frames.size(), kMin);
  return take;
}

/// Errors name the take, of which there may be two.
ModelledTake follow_and_model(const TakeSource& source, const ShowOptions& options, ProgressReporter& reporter) {
  try {
    ModelledTake made;
    made.take = follow(source, options, reporter);
    reporter.step(TeachingState::kFusing, 0.3, "the model is made");
    made.model = reconstruct_model(made.take, making_of(options));
    return made;
  } catch (const InputError& error) {
    fail("{}: {}", source.name, error.what());
  }
}

/// Follows one or two takes and makes a model of them.
ShowResult show_takes(const ShowOptions& options, const ShownFrames& frames, const ShownFrames& second,
                      ProgressReporter& reporter) {
  const auto begin = std::chrono::steady_clock::now();
  ShowResult shown;
  shown.name = options.name;
  ModelledTake first = follow_and_model({options.source, frames, options.box, options.at}, options, reporter);
  ReconstructedModel& model = first.model;
  shown.takes.push_back(std::move(first.take));
  if (second) {
    const std::string name = options.second.empty() ? "the second take" : options.second;
    ModelledTake other = follow_and_model({name, second, std::nullopt, std::nullopt}, options, reporter);
    reporter.step(TeachingState::kFusing, 0.4, "the second take is laid on the first");
    shown.second_fits = merge_takes(shown.takes.front(), model, other.take, other.model, making_of(options));
    if (shown.second_fits) {
      shown.takes.push_back(std::move(other.take));
      shown.views.push_back(std::move(other.model.views));
    }
  }
  shown.views.insert(shown.views.begin(), std::move(model.views));
  shown.seen_surface = covered_fraction(model.seen);
  shown.mesh = fusion::remove_unobserved(model.mesh, model.seen, making_of(options).foot_m);
  shown.deviation_m = model.deviation_m;
  shown.free_space_violation = model.free_space_violation;
  shown.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return shown;
}

/// Teaches into the store twice: with scores and qualities of a little calibration, so that a stream that runs finds
/// the object soon, and again when they were learnt as thoroughly as those of any other.
void teach_shown(const ShowOptions& options, const ShowResult& shown, ProgressReporter& reporter) {
  constexpr int kFirstScenes = 18;
  TeachOptions teach = options_to_teach(options, shown);
  CalibrationSettings thorough = teach.calibration;
  thorough.seed = options.seed;
  thorough.threads = options.threads;
  teach.calibration.scenes = kFirstScenes;
  reporter.step(TeachingState::kTraining, 0.5, "the model is taught");
  teach_meshes(teach);
  reporter.step(TeachingState::kTraining, 0.8,
                fmt::format("{} is known, and what its detections are worth is learnt in more rooms", options.name));
  calibrate_store(options.out, thorough, {options.name});
}

/// Judges what was shown, writes what is to be kept, and teaches it. Returns the exit status.
int conclude(const ShowOptions& options, const ShowResult& shown, ProgressReporter& reporter) {
  constexpr int kPoor = 3;
  const ModelAssessment assessment = assess_model(shown);
  fmt::print("{}", describe(shown, assessment));
  if (!options.keep.empty()) archive_session(shown, assessment, options.keep);
  if (!assessment.good && !options.accept_poor_model) {
    reporter.step(TeachingState::kFailed, 1.0,
                  fmt::format("poor: {}{}", assessment.reasons.front(),
                              options.teach ? "; not taught (--go-on teaches it all the same)" : ""));
    return kPoor;
  }
  if (options.teach) teach_shown(options, shown, reporter);
  reporter.step(TeachingState::kDone, 1.0,
                options.teach ? fmt::format("{} is known", options.name) : fmt::format("{} has a model", options.name));
  return 0;
}

/// Runs a showing to its conclusion; reports the reason of a failure before it throws.
int run_reported(const ShowOptions& options, ShowObserver* observer,
                 const std::function<ShowResult(ProgressReporter&)>& show) {
  ProgressReporter reporter(options.name, observer);
  try {
    check_show_options(options);
    return conclude(options, show(reporter), reporter);
  } catch (const std::exception& error) {
    reporter.fail(error.what());
    throw;
  }
}

}  // namespace

int show_object(const ShowOptions& options, const ShownFrames& frames, const ShownFrames& second,
                ShowObserver* observer) {
  return run_reported(options, observer,
                      [&](ProgressReporter& reporter) { return show_takes(options, frames, second, reporter); });
}

int show_sources(const ShowOptions& options, ShowObserver* observer) {
  check_show_options(options);
  check_second(options);
  if (is_turntable_videos(options.source))
    return run_reported(options, observer, [&](ProgressReporter&) { return show_turntable(options); });
  const ShownFrames second = options.second.empty() ? ShownFrames() : open_shown(options.second, options);
  if (!is_live(options.source)) return show_object(options, open_shown(options.source, options), second, observer);
  CameraTake take(open_shown(options.source, options), observer);
  return show_object(
      options, [&take] { return take.next(); }, second, &take);
}

}  // namespace houghstream::teach
