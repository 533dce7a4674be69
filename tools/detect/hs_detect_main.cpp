#include <unistd.h>

#include <map>
#include <mutex>

#include "detector/forest/forest_file.hpp"
#include "detector/group_schedule.hpp"
#include "detector/stages.hpp"
#include "drivers/files/camera_info.hpp"
#include "drivers/store/store_watcher.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/heap_memory.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/process/detect_process.hpp"
#include "pipeline/process/warm_up.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/common/usage_error.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/finder/stored_precision.hpp"

namespace {

using namespace houghstream;

Detector make_detector(std::vector<Forest> groups, const SearchOptions& search) {
  for (const Forest& forest : groups) {
    for (const ObjectClass& object : forest.classes) log_debug("class {}: {}", object.class_id, object.name);
  }
  return detector_of(std::move(groups), search);
}

/// A detector with the workspace of its frames, which are searched one after another, and the turns of its groups. It
/// has searched a made-up frame before, so that its first real frame takes no longer than the others: its data are in
/// the caches, its memory is allocated.
struct ReadyDetector {
  ReadyDetector(Detector of_forest, const GroupScheduleSettings& scheduling, const RgbdFrame& warm_up_frame)
      : detector(std::move(of_forest)), schedule(detector.groups(), scheduling) {
    detector.detect(warm_up_frame, workspace);
  }

  /// Finds the objects of all groups, or, in turn, of those that are due in this frame.
  Detections detect(const RgbdFrame& frame, const std::vector<ChromaPair>& camera_colours, bool in_turn) const {
    std::vector<std::size_t> selected;
    if (in_turn) {
      const std::lock_guard<std::mutex> lock(schedule_mutex);
      selected = schedule.select(frame.id);
    }
    Detections found = detector.detect(frame, workspace, camera_colours, selected);
    if (in_turn) note(found);
    return found;
  }

  /// Tells the schedule what was found; may be called from any thread.
  template <typename Results>
  void note(const Results& results) const {
    const std::lock_guard<std::mutex> lock(schedule_mutex);
    schedule.note(results);
  }

  Detector detector;
  mutable DetectorWorkspace workspace;
  mutable std::mutex schedule_mutex;
  mutable GroupSchedule schedule;
};

/// Options of the command line.
struct DetectOptions {
  std::string objects;
  std::string forest_file;
  std::string url;
  std::string output_log;
  bool replace = false;                // an output log that is there
  bool ignore_camera_colours = false;  // as hs-pose has learnt them
  SearchOptions search;
  std::optional<double> precision;  // chooses the thresholds of a store's objects
  std::optional<double> group_interval_s;
  DetectProcessOptions process;
};

/// Loads the groups that are whole; the others are the watcher's to report.
store::Loaded<ReadyDetector> load_detector(const store::ObjectStore& store, const DetectOptions& options,
                                           const RgbdFrame& warm_up_frame) {
  const SearchOptions search = with_precision(options.search, store, options.precision);
  GroupScheduleSettings scheduling;
  scheduling.interval_s = options.group_interval_s.value_or(scheduling.interval_s);
  std::vector<store::GroupFault> faults;
  Detector detector = make_detector(load_whole_forests(store, search.threads, faults), search);
  return {std::make_shared<const ReadyDetector>(std::move(detector), scheduling, warm_up_frame), std::move(faults)};
}

/// Lowers the priority of this thread and of all threads that it starts from here on: where the rate of detections is
/// limited, hs-pose follows objects from frame to frame and goes first.
void lower_priority() {
  constexpr int kNiceIncrement = 2;
  if (nice(kNiceIncrement) == -1) log_debug("the priority of looks cannot be lowered");
}

/// Holds the colours that hs-pose has learnt last of each camera. Every function may be called from any thread.
class KnownColours {
 public:
  void update(const CameraChroma& colours) {
    constexpr std::size_t kMaxCameras = 64;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (objects_.size() < kMaxCameras || objects_.count(colours.frame.channel) > 0)
      objects_[colours.frame.channel] = colours.objects;
  }

  std::vector<ChromaPair> chroma_pairs_of(const std::string& channel) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto known = objects_.find(channel);
    return known == objects_.end() ? std::vector<ChromaPair>{} : known->second;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<ChromaPair>> objects_;  // by camera
};

/// Detects by a forest file, which does not change while this runs.
void run_with_forest(const DetectOptions& options, const KnownColours& colours) {
  const std::shared_future<RgbdFrame> warm_up_frame = start_warm_up();
  const ReadyDetector ready(
      make_detector(load_named_forests({{}, options.forest_file, {}}, options.search.threads), options.search), {},
      warm_up_frame.get());
  LcmBus bus(options.url, options.output_log, existing_of_recording(options.replace));
  run_detect_process(bus, options.process, [&](const RgbdFrame& frame) {
    return ready.detect(frame, colours.chroma_pairs_of(frame.id.channel), false);
  });
}

/// A store may change while frames go by: each frame is searched by what is there when its turn comes. Groups are
/// searched in turn on a network; of a log, which can wait, only where an interval is given.
void run_with_store(DetectOptions options, const KnownColours& colours) {
  const std::shared_future<RgbdFrame> warm_up_frame = start_warm_up();
  store::StoreWatcher<ReadyDetector> watch(options.objects, [&](const store::ObjectStore& store) {
    return load_detector(store, options, warm_up_frame.get());
  });
  options.process.objects = [&] { return watch.known(); };
  LcmBus bus(options.url, options.output_log, existing_of_recording(options.replace));
  bus.is_log() ? watch.require_store() : watch.follow();
  const bool in_turn = !bus.is_log() || options.group_interval_s;
  options.process.on_poses = [&](const ObjectPoses& poses) {
    if (const std::shared_ptr<const ReadyDetector> ready = watch.current()) ready->note(poses);
  };
  run_detect_process(bus, options.process, [&](const RgbdFrame& frame) {
    const std::shared_ptr<const ReadyDetector> ready = watch.current();
    if (!ready) return Detections{frame.id, {}, frame.stages};
    return ready->detect(frame, colours.chroma_pairs_of(frame.id.channel), in_turn);
  });
}

/// Throws for options that do not go together.
void check_options(const DetectOptions& options) {
  require_usage(options.forest_file.empty() != options.objects.empty(),
                "expected either --objects STORE or --forest FILE");
  require_usage(!options.precision || !options.objects.empty(),
                "--precision goes with --objects, whose practice it reads");
  require_usage(!options.group_interval_s || !options.objects.empty(),
                "--group-interval goes with --objects, whose groups are searched in turn");
  require_output_log(options.url, options.output_log);
  for (const std::string& input : {options.forest_file, options.objects}) require_other_file(options.output_log, input);
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app(
      "Finds the taught objects in the newest RGB-D frame of each camera in turn and publishes detections_t",
      "hs-detect");
  DetectOptions options;
  std::string camera;
  app.add_option("--objects", options.objects,
                 "object store of hs-teach; it may be made, and changed, while this runs");
  app.add_option("--forest", options.forest_file, "forest file of hs-train, instead of --objects");
  app.add_option("--camera", camera, kCameraOptionHelp);
  add_search_options(app, options.search);
  add_precision_option(app, options.precision,
                       "with --objects: what is reported by its score shall be right in this fraction of the cases; "
                       "each object has the least score that its practice needed for it")
      .excludes(app.get_option("--threshold"));
  options.search.candidates_from = kCandidatesFrom;
  app.add_option("--candidates", options.search.candidates_from,
                 "weaker detections from this score on are handed to hs-pose, which reports those whose pose is right; "
                 "1: none")
      .range(range_of(&EvidenceSettings::candidates_from))
      .capture_default_str();
  app.add_option("--looks-per-second", options.process.max_rate_hz,
                 "look at so many of each camera's frames a second, for hs-pose --follow; default: at each one")
      .range(0.1, 1000.0);
  app.add_option("--group-interval", options.group_interval_s,
                 "with --objects: seconds within which each group of objects is searched again while none of it is "
                 "found; 0: in each frame, as of a log by default")
      .range(range_of(&GroupScheduleSettings::interval_s))
      .default_str(fmt::format("{}", GroupScheduleSettings{}.interval_s));
  app.add_flag("--no-camera-colours", options.ignore_camera_colours,
               "learn how a camera renders colours from each frame by itself, as of a log, and not from what hs-pose "
               "tells of earlier ones: the same frame gives the same detections whenever it comes");
  add_frame_channels_option(app, options.process.frame_channels);
  app.add_option("--output-log", options.output_log, "with -l file://LOG: write the results to this log");
  app.add_flag("--keep-frames", options.process.keep_frames,
               "with --output-log: write the frames too, each before its result, so that hs-pose can work on that log");
  add_replace_option(app, options.replace, "--output-log");
  add_lcm_url_option(app, options.url);
  app.add_example("hs-detect --objects my.store");
  app.add_example("hs-detect --forest out/demo/data/forest -l file://IN.lcmlog --output-log OUT.lcmlog");

  return run_tool(app, argc, argv, [&] {
    share_one_heap();
    if (!camera.empty()) options.process.camera = camera_of_option(camera);
    if (options.process.max_rate_hz > 0.0) lower_priority();
    check_options(options);
    KnownColours colours;
    if (!options.ignore_camera_colours)
      options.process.on_camera_colours = [&](const CameraChroma& learnt) { colours.update(learnt); };
    options.objects.empty() ? run_with_forest(options, colours) : run_with_store(options, colours);
  });
}
