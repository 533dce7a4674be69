#include "tools/teach/show/show_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pose/reconstruction/object_tracker.hpp"
#include "pose/reconstruction/take_model.hpp"
#include "tools/teach/mesh_checks.hpp"
#include "tools/teach/show/show_report.hpp"
#include "tools/teach/show/show_sources.hpp"
#include "tools/teach/teach_jobs.hpp"

namespace houghstream::teach {
namespace {

using reconstruction::ObjectTracker;
using reconstruction::ShownModel;
using reconstruction::Take;
using reconstruction::TrackerState;
using reconstruction::TrackState;

/// Tells the observer and, where something new happens, the terminal.
class Telling {
 public:
  Telling(const ShowOptions& options, ShowObserver* observer) : observer_(observer) { now_.name = options.name; }

  void frame(const FrameId& id, const TrackerState& state) {
    now_.frame = id;
    now_.state = state.state == TrackState::kTracking ? ShowState::kTracking
                 : state.state == TrackState::kLost   ? ShowState::kLost
                                                      : ShowState::kChoosing;
    now_.message = state.message;
    now_.seen = state.seen;
    now_.frames = state.frames;
    now_.keyframes = state.keyframes;
    now_.box = state.box_px;
    now_.T_camera_object = state.T_camera_object;
    now_.progress = static_cast<double>(reconstruction::count_seen(state.seen)) / ShowProgress::kDirections;
    tell();
  }

  void step(ShowState state, double progress, const std::string& message) {
    now_.state = state;
    now_.progress = progress;
    now_.message = message;
    now_.box = {};
    now_.T_camera_object.reset();
    printed_us_ = 0;
    tell();
  }

 private:
  void tell() {
    constexpr std::int64_t kApart_us = 1'000'000;  // of the take's time
    const std::string line = fmt::format("{}: {}", name_of(now_.state), now_.message);
    const bool soon = printed_us_ != 0 && std::abs(now_.frame.utime - printed_us_) < kApart_us;
    if (line != printed_ && !soon) {
      fmt::print(stderr, "hs-teach: {}\n", line);
      printed_ = line;
      printed_us_ = now_.frame.utime;
    }
    if (observer_ != nullptr) observer_->progress(now_);
  }

  ShowObserver* observer_;
  ShowProgress now_;
  std::string printed_;
  std::int64_t printed_us_ = 0;
};

void require_new_name(const ShowOptions& options) {
  require(!options.name.empty() && options.name.find_first_of("/\\ \t\n,=") == std::string::npos,
          "--name '{}', expected a word without spaces, commas and slashes", options.name);
  if (!options.teach) return;
  require(!options.out.empty(), "--out is missing, expected the store to teach into, or --no-teach");
  if (!options.add) return;
  const store::ObjectStore known = store::read_store(options.out);
  const bool is_known = std::any_of(known.objects.begin(), known.objects.end(),
                                    [&](const store::StoredObject& object) { return object.name == options.name; });
  require(!is_known,
          "--name {}: the store {} has such an object already, expected a new name, or hs-teach remove first",
          options.name, options.out.string());
}

void check_shown_frame(const RgbdFrame& frame, const std::string& source) {
  check_frame(frame, source);
  cv::Scalar mean, deviation;
  cv::meanStdDev(frame.colour, mean, deviation);
  require(deviation[0] + deviation[1] + deviation[2] > 0.0, "{}: frame {}: no colour, expected a picture", source,
          to_string(frame.id));
  require(cv::countNonZero(frame.depth == frame.depth) > 0,
          "{}: frame {}: no depth at all, expected depth registered to colour", source, to_string(frame.id));
}

Take follow(const ShowOptions& options, const std::string& source, const ShownFrames& frames, Telling& telling) {
  constexpr std::size_t kFewest = 20;
  reconstruction::TrackerSettings settings;
  settings.choice.box_px = options.box;
  settings.choice.seed = options.seed;
  settings.map.threads = options.threads;
  ObjectTracker tracker(settings);
  try {
    bool is_first = true;
    while (const std::optional<RgbdFrame> frame = frames()) {
      if (is_first) check_shown_frame(*frame, source);
      is_first = false;
      telling.frame(frame->id, tracker.process(*frame));
    }
    telling.step(ShowState::kFusing, 0.0, "all keyframes are laid on one another");
    Take take = tracker.finish();
    require(take.frames.size() >= kFewest, "{} frames, expected at least {}, of a whole turn", take.frames.size(),
            kFewest);
    return take;
  } catch (const InputError& error) {
    fail("{}: {}", source, error.what());
  }
}

/// The shown mesh as one that hs-teach mesh could have read, and the keyframes' views of it.
TeachOptions teaching_of(const ShowOptions& options, const Shown& shown) {
  TeachOptions teach;
  TaughtMesh mesh;
  mesh.name = options.name;
  mesh.file = "shown: " + options.source;
  mesh.mesh = shown.mesh;
  check_mesh(options.name, 1e-3, mesh.mesh);
  mesh.coloured = has_colour(mesh.mesh);
  teach.shown = {std::move(mesh)};
  teach.out = options.out;
  teach.add = options.add;
  teach.rooms.cache = options.rooms_cache;
  teach.rooms.threads = options.threads;
  teach.seed = options.seed;
  teach.threads = options.threads;
  return teach;
}

}  // namespace

int show_object(const ShowOptions& options, const ShownFrames& frames, const ShownFrames& second,
                ShowObserver* observer) {
  require_new_name(options);
  Telling telling(options, observer);
  try {
    const auto begin = std::chrono::steady_clock::now();
    Shown shown;
    shown.name = options.name;
    shown.takes.push_back(follow(options, options.source, frames, telling));
    telling.step(ShowState::kFusing, 0.3, "the model is made");
    reconstruction::ModelMaking making;
    making.threads = options.threads;
    ShownModel model = make_model(shown.takes.front(), making);
    require(!second, "--second is not known yet");
    shown.views.push_back(std::move(model.views));
    shown.mesh = std::move(model.mesh);
    shown.seen = std::move(model.seen);
    shown.agreement_m = model.agreement_m;
    shown.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const Verdict verdict = judge(shown);
    fmt::print("{}", describe(shown, verdict));
    if (!options.keep.empty()) keep_shown(shown, verdict, options.keep);
    if (!verdict.good && !options.go_on) {
      telling.step(ShowState::kFailed, 1.0, fmt::format("poor: {}", verdict.reasons.front()));
      return 3;
    }
    if (options.teach) {
      telling.step(ShowState::kTraining, 0.5, "the model is taught");
      teach_meshes(teaching_of(options, shown));
    }
    telling.step(ShowState::kDone, 1.0, fmt::format("{} is known", options.name));
    return 0;
  } catch (const std::exception& error) {
    telling.step(ShowState::kFailed, 1.0, error.what());
    throw;
  }
}

int show_sources(const ShowOptions& options, ShowObserver* observer) {
  require_new_name(options);
  const ShownFrames second = options.second.empty() ? ShownFrames() : open_shown(options.second, options);
  return show_object(options, open_shown(options.source, options), second, observer);
}

}  // namespace houghstream::teach
