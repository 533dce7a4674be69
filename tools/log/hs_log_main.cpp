#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/camera_info.hpp"
#include "drivers/openni/oni_repair.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/event_log.hpp"
#include "tools/common/new_output.hpp"
#include "tools/common/progress_line.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/common/usage_error.hpp"
#include "tools/log/export_frames.hpp"
#include "tools/log/export_mcap.hpp"
#include "tools/log/export_objects.hpp"
#include "tools/log/export_results.hpp"
#include "tools/log/filter_log.hpp"
#include "tools/log/good_events.hpp"
#include "tools/log/log_info.hpp"
#include "tools/log/record_log.hpp"
#include "tools/log/recording.hpp"

namespace houghstream::log_tools {
namespace {

struct Options {
  bool json = false;
  std::string in;
  std::string out;
  bool replace = false;
  std::string camera;
  std::string channel = "OPENNI_FRAME";
  LogFilter filter;
  std::string models;
  double model_unit_m = 1e-3;
  std::string objects;
  RecordSettings record;
  RecordingSettings recording;
};

constexpr const char* kSources =
    "an LCM log of images_t, kinect.frame_msg_t or lcmt_image_array; FILE.klg, FILE.oni or "
    "FILE.bag (ROS 1); bop:DIR, uw:DIR, tum:DIR or bag:FILE";

CommandLine add_info(CommandLine& app, Options& options) {
  CommandLine info = app.add_subcommand("info", "channels, types, rates, gaps and sizes");
  info.add_option("log", options.in, "LCM log").required();
  info.add_flag("--json", options.json, "print it as JSON, for scripts");
  info.add_example("hs-log info out/demo/data/stream.lcmlog");
  return info;
}

CommandLine add_filter(CommandLine& app, Options& options) {
  CommandLine filter = app.add_subcommand("filter", "copies a part of a log: of some time, of some channels");
  filter.add_option("log", options.in, "LCM log").required();
  filter.add_option("out", options.out, "LCM log to write").required();
  filter.add_option("-s,--start", options.filter.start_s, "seconds since the log's first event").non_negative();
  filter.add_option("-e,--end", options.filter.end_s, "seconds since the log's first event").non_negative();
  filter
      .add_option("-c,--channel,--channels", options.filter.channels,
                  "channels: a regular expression for the whole name")
      .capture_default_str();
  filter.add_flag("-i,--invert", options.filter.others, "keep the channels that do not match");
  add_replace_output_option(filter, options.replace, "OUT");
  filter.add_example("hs-log filter IN.lcmlog OUT.lcmlog -s 2.5 -e 10 -c 'OPENNI_.*'");
  return filter;
}

CommandLine add_record(CommandLine& app, Options& options) {
  CommandLine record = app.add_subcommand("record", "records what is published, until Ctrl-C");
  record.add_option("out", options.record.file, "LCM log to write").required();
  record
      .add_option("-c,--channel", options.record.channels,
                  "channels: a regular expression for the whole name; repeatable; default: all")
      .repeatable();
  record.add_option("--seconds", options.record.seconds, "end after so many seconds (0: when stopped)")
      .capture_default_str()
      .non_negative();
  add_replace_option(record, options.record.replace, "OUT");
  add_lcm_url_option(record, options.record.url);
  record.add_example("hs-log record take.lcmlog -c OPENNI_FRAME -c 'HOUGHSTREAM_.*'");
  return record;
}

void record_and_tell(const RecordSettings& settings) {
  const RecordResult result = record_log(settings);
  fmt::print("{} events on {} channels, {:.1f} MB, in {}\n", result.events, result.channels,
             static_cast<double>(result.bytes) * 1e-6, result.file);
  if (result.is_complete()) {
    log_info("{}", result.losses_line());
  } else {
    log_warning("{}: {}", result.file, result.losses_line());
  }
}

CommandLine add_seal(CommandLine& app, Options& options) {
  CommandLine seal =
      app.add_subcommand("seal", "copies a log with a checksum for each event, which every reader checks");
  seal.add_option("log", options.in, "LCM log").required();
  seal.add_option("out", options.out, "LCM log to write").required();
  add_replace_output_option(seal, options.replace, "OUT");
  seal.add_example("hs-log seal IN.lcmlog OUT.lcmlog");
  return seal;
}

CommandLine add_repair(CommandLine& app, Options& options) {
  CommandLine repair = app.add_subcommand("repair", "copies an .oni recording whose recorder was killed, with its end");
  repair.add_option("recording", options.in, "FILE.oni, or FILE.oni.partial.oni").required();
  repair.add_option("out", options.out, ".oni file to write").required();
  add_replace_output_option(repair, options.replace, "OUT");
  repair.add_example("hs-log repair take.oni.partial.oni take.oni");
  return repair;
}

CommandLine add_import(CommandLine& app, Options& options) {
  CommandLine import = app.add_subcommand("import", "makes a log of images_t of other recordings");
  import.add_option("source", options.in, kSources).required();
  import.add_option("out", options.out, "LCM log to write").required();
  import.add_option("--camera", options.camera, kCameraOptionHelp);
  import.add_option("--from-channel", options.recording.channel,
                    "the one channel to read; default: the first with frames");
  import.add_option("-c,--channel", options.channel, "the one channel to write").capture_default_str();
  add_replace_output_option(import, options.replace, "OUT");
  import.add_example("hs-log import recording.klg OUT.lcmlog --camera 640x480,525,525,319.5,239.5");
  return import;
}

CommandLine add_export(CommandLine& app, const std::string& name, const std::string& words, Options& options) {
  CommandLine part = app.add_subcommand(name, words);
  const bool frames = name == "bop" || name == "png";
  part.add_option("source", options.in, frames ? kSources : "LCM log with results").required();
  part.add_option("out", options.out, frames ? "folder to write" : "file to write").required();
  part.add_example(fmt::format("hs-log export {} {}", name,
                               frames ? "IN.lcmlog FOLDER" : "RESULTS.lcmlog OUT." + name.substr(name.rfind('-') + 1)));
  if (!frames) {
    add_replace_output_option(part, options.replace, "OUT");
    return part;
  }
  part.add_option("--camera", options.camera, kCameraOptionHelp);
  part.add_option("--from-channel", options.recording.channel,
                  "the one channel to read; default: the first with frames");
  return part;
}

CommandLine add_mcap(CommandLine& app, Options& options) {
  CommandLine mcap = app.add_subcommand(
      "mcap", "frames and results for Foxglove and Rerun: images, depth, boxes, transforms, and models in the scene");
  mcap.add_option("log", options.in, "LCM log").required();
  mcap.add_option("out", options.out, "file to write").required();
  mcap.add_option("--objects", options.objects, "object store of hs-teach with the models");
  add_model_options(mcap, options.models, options.model_unit_m);
  mcap.add_option("--camera", options.camera, kCameraOptionHelp);
  add_replace_output_option(mcap, options.replace, "OUT");
  mcap.add_example("hs-log export mcap RESULTS.lcmlog OUT.mcap --objects my.store");
  return mcap;
}

std::int64_t export_mcap_of(const Options& options, LossReport& losses) {
  require_usage(options.models.empty() || options.objects.empty(),
                "expected either --objects STORE or --models FOLDER");
  McapExtras extras;
  extras.camera = options.recording.camera;
  if (!options.models.empty()) extras.models = load_class_models(options.models, options.model_unit_m);
  if (!options.objects.empty()) extras.models = store::load_store_meshes(store::read_store(options.objects));
  return export_mcap(options.in, extras, options.out, losses);
}

/// Runs a job that a stop signal ends without a part of a file left behind; the signal then ends the program.
std::int64_t run_until_stopped(const std::string& out, bool makes_folder, const std::function<std::int64_t()>& job) {
  const BlockStopSignals held;  // its end lets the signal through
  try {
    return job();
  } catch (const Stopped&) {
    const char* below_progress = isatty(STDERR_FILENO) == 1 ? "\n" : "";
    fmt::print(stderr, "{}hs-log: stopped; {} {}\n", below_progress, out,
               makes_folder ? "holds a part of the frames" : "is as it was");
    return 0;
  }
}

std::int64_t seal_with_progress(const Options& options) {
  ProgressLine progress(std::filesystem::path(options.in).filename().string(), 1.0);
  return seal_log(options.in, options.out, [&](double fraction) {
    require_not_stopped();
    progress.at(fraction);
  });
}

}  // namespace
}  // namespace houghstream::log_tools

int main(int argc, char** argv) {
  using namespace houghstream;
  using namespace houghstream::log_tools;
  CommandLine app(
      "Looks into LCM logs, records and cuts them, makes them of other recordings and writes what is in them to files. "
      "What is damaged is passed over and reported.",
      "hs-log");
  app.require_subcommand();
  app.add_example("hs-log info out/demo/data/stream.lcmlog");
  app.add_example("hs-log export csv RESULTS.lcmlog results.csv");
  Options options;
  const CommandLine info = add_info(app, options);
  const CommandLine record = add_record(app, options);
  const CommandLine filter = add_filter(app, options);
  const CommandLine seal = add_seal(app, options);
  const CommandLine repair = add_repair(app, options);
  const CommandLine import = add_import(app, options);
  CommandLine exporter = app.add_subcommand("export", "writes frames or results to files");
  exporter.require_subcommand();
  exporter.add_example("hs-log export bop IN.lcmlog FOLDER");
  const CommandLine bop = add_export(exporter, "bop", "frames as a BOP scene folder", options);
  const CommandLine png = add_export(exporter, "png", "frames as NNNNNN_color.png, NNNNNN_depth.png", options);
  const CommandLine csv =
      add_export(exporter, "csv",
                 "detections and poses of all cameras and detectors, one row each; of an object that is followed "
                 "without a detection (hs-pose --follow) detection is -1 and the box is empty",
                 options);
  const CommandLine json = add_export(
      exporter, "json", "detections and poses of all cameras and detectors by frame, with stage times", options);
  const CommandLine mcap = add_mcap(exporter, options);
  const CommandLine objects_csv =
      add_export(exporter, "objects-csv", "hs-track's objects, a row for each after each frame", options);
  add_export(exporter, "objects-json", "hs-track's objects by frame, and when and why each one's state changed",
             options);

  return run_tool(app, argc, argv, [&] {
    if (record.given()) return record_and_tell(options.record);
    const bool makes_folder = bop.given() || png.given();
    if (!makes_folder) require_new_output(options.out, options.replace);
    LossReport losses;
    options.recording.source = options.in;
    if (!options.camera.empty()) options.recording.camera = camera_of_option(options.camera);
    if (info.given()) {
      const LogInfo read = read_log_info(options.in, losses);
      if (options.json) print_json(to_json(read));
      if (!options.json) fmt::print("{}", to_text(read));
    } else if (repair.given()) {
      fmt::print("{} images in {}; colour may lie an image beside its depth\n",
                 openni::copy_repaired_oni(options.in, options.out), options.out);
    } else {
      const auto job = [&] {
        return filter.given()        ? filter_log(options.in, options.filter, options.out, losses)
               : seal.given()        ? seal_with_progress(options)
               : import.given()      ? import_log(options.recording, options.channel, options.out, losses)
               : bop.given()         ? export_bop(options.recording, options.out, losses)
               : png.given()         ? export_pngs(options.recording, options.out, losses)
               : mcap.given()        ? export_mcap_of(options, losses)
               : csv.given()         ? export_results_csv(options.in, options.out, losses)
               : json.given()        ? export_results_json(options.in, options.out, losses)
               : objects_csv.given() ? export_objects_csv(options.in, options.out, losses)
                                     : export_objects_json(options.in, options.out, losses);
      };
      const std::int64_t count = run_until_stopped(options.out, makes_folder, job);
      fmt::print("{} {} in {}\n", count, filter.given() || seal.given() ? "events" : "frames", options.out);
    }
    if (!losses.line().empty()) log_warning("{}: {}", options.in, losses.line());
  });
}
