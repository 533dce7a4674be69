#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "pipeline/checks.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/log/export_frames.hpp"
#include "tools/log/export_results.hpp"
#include "tools/log/filter_log.hpp"
#include "tools/log/import_log.hpp"
#include "tools/log/log_info.hpp"

namespace houghstream {
namespace {

struct Options {
  std::string in;
  std::string out;
  std::string camera;
  std::string channel = "OPENNI_FRAME";
  LogFilter filter;
  RecordingSettings recording;
};

constexpr const char* kSources =
    "an LCM log of images_t, kinect.frame_msg_t or lcmt_image_array; FILE.klg or FILE.oni; bop:DIR, uw:DIR or tum:DIR";

CLI::App* add_info(CLI::App& app, Options& options) {
  CLI::App* info = app.add_subcommand("info", "channels, types, rates, gaps and sizes");
  info->add_option("log", options.in, "LCM log")->required();
  return info;
}

CLI::App* add_filter(CLI::App& app, Options& options) {
  CLI::App* filter = app.add_subcommand("filter", "copies a part of a log: of some time, of some channels");
  filter->add_option("log", options.in, "LCM log")->required();
  filter->add_option("out", options.out, "LCM log to write")->required();
  filter->add_option("-s,--start", options.filter.start_s, "seconds since the log's first event");
  filter->add_option("-e,--end", options.filter.end_s, "seconds since the log's first event");
  filter->add_option("-c,--channels", options.filter.channels, "regular expression for the whole name")
      ->capture_default_str();
  filter->add_flag("-i,--invert", options.filter.others, "keep the channels that do not match");
  return filter;
}

CLI::App* add_import(CLI::App& app, Options& options) {
  CLI::App* import = app.add_subcommand("import", "makes a log of images_t of other recordings");
  import->add_option("source", options.in, kSources)->required();
  import->add_option("out", options.out, "LCM log to write")->required();
  import->add_option("--camera", options.camera, "WIDTHxHEIGHT,fx,fy,cx,cy for frames without a camera of their own");
  import->add_option("--from-channel", options.recording.channel, "channel to read; default: the first with frames");
  import->add_option("-c,--channel", options.channel, "channel to write")->capture_default_str();
  return import;
}

CLI::App* add_export(CLI::App& app, const std::string& name, const std::string& words, Options& options) {
  CLI::App* part = app.add_subcommand(name, words);
  const bool frames = name == "bop" || name == "png";
  part->add_option("source", options.in, frames ? kSources : "LCM log with results")->required();
  part->add_option("out", options.out, frames ? "folder to write" : "file to write")->required();
  if (!frames) return part;
  part->add_option("--camera", options.camera, "WIDTHxHEIGHT,fx,fy,cx,cy for frames without a camera of their own");
  part->add_option("--from-channel", options.recording.channel, "channel to read; default: the first with frames");
  return part;
}

}  // namespace
}  // namespace houghstream

int main(int argc, char** argv) {
  using namespace houghstream;
  CLI::App app(
      "Looks into LCM logs, cuts them, makes them of other recordings and writes what is in them to files. "
      "What is damaged is passed over and reported.",
      "hs-log");
  app.require_subcommand(1);
  Options options;
  const CLI::App* info = add_info(app, options);
  const CLI::App* filter = add_filter(app, options);
  const CLI::App* import = add_import(app, options);
  CLI::App* exporter = app.add_subcommand("export", "writes frames or results to files")->require_subcommand(1);
  const CLI::App* bop = add_export(*exporter, "bop", "frames as a BOP scene folder", options);
  const CLI::App* png = add_export(*exporter, "png", "frames as NNNNNN_color.png, NNNNNN_depth.png", options);
  const CLI::App* csv = add_export(*exporter, "csv", "detections and poses, one row each", options);
  add_export(*exporter, "json", "detections and poses by frame, with stage times", options);

  return run_tool(app, argc, argv, [&] {
    LossAccount losses;
    options.recording.source = options.in;
    if (!options.camera.empty()) options.recording.camera = parse_camera(options.camera);
    if (*info) {
      fmt::print("{}", to_text(read_log_info(options.in, losses)));
    } else {
      const std::int64_t count = *filter   ? filter_log(options.in, options.filter, options.out, losses)
                                 : *import ? import_log(options.recording, options.channel, options.out, losses)
                                 : *bop    ? export_bop(options.recording, options.out, losses)
                                 : *png    ? export_pngs(options.recording, options.out, losses)
                                 : *csv    ? export_results_csv(options.in, options.out, losses)
                                           : export_results_json(options.in, options.out, losses);
      fmt::print("{} {} in {}\n", count, *filter ? "events" : "frames", options.out);
    }
    if (!losses.line().empty()) spdlog::warn("{}: {}", options.in, losses.line());
  });
}
