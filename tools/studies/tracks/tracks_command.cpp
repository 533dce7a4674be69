#include <cmath>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "pose/tracks/camera_extrinsics.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/finder/track_models.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/tracks/add_metric.hpp"
#include "tools/studies/tracks/outline_metric.hpp"
#include "tools/studies/tracks/sequence_file.hpp"
#include "tools/studies/tracks/track_metrics.hpp"

// hs-study tracks is what tools/bench tracks runs on rendered sequences.

using namespace houghstream;
using namespace houghstream::studies;

namespace {

struct Arguments {
  std::string sequence;
  std::string out;
  std::vector<std::string> wrong;  ///< CHANNEL=x,y,z
  std::string frames;
  std::vector<std::string> results;
  std::string log;
  std::string models;
  bool single_frames = false;
  std::size_t every = 1;
};

std::map<std::string, Eigen::Vector3d> wrong_places(const std::vector<std::string>& texts) {
  std::map<std::string, Eigen::Vector3d> out;
  for (const std::string& text : texts) {
    const auto [channel, T] = tracks::parse_camera_pose(text + ",1,0,0,0");
    out[channel] = T.translation();
  }
  return out;
}

/// Returns the objects that are published as present, without those that are gone.
std::vector<PublishedObject> objects_of(const LogEvent& event) {
  std::vector<PublishedObject> out;
  const WorldObjects world = world_from_message(decode_message<objects_t>({event.data.data(), event.data.size()}));
  for (const TrackedObject& object : world.objects) {
    if (object.state == TrackState::kGone) continue;
    PublishedObject& published = out.emplace_back();
    published.track_id = object.track_id;
    published.class_name = object.class_name;
    published.T_world_object = object.T_world_object;
    published.deviation_m = std::sqrt(object.covariance.topLeftCorner<3, 3>().trace());
  }
  return out;
}

PublishedFrame poses_of(const LogEvent& event, const SequenceFile& sequence, std::size_t index) {
  PublishedFrame out{index, {}};
  const ObjectPoses poses = poses_from_message(decode_message<object_poses_t>({event.data.data(), event.data.size()}));
  for (const SequenceCamera& camera : sequence.cameras) {
    if (camera.channel != poses.frame.channel) continue;
    for (const ObjectPose& pose : poses.poses) {
      if (!pose.T_camera_object) continue;
      PublishedObject& object = out.objects.emplace_back();
      object.class_name = pose.class_name;
      object.T_world_object = camera.T_world_camera[index] * *pose.T_camera_object;
      out.qualities.push_back(static_cast<double>(pose.quality));
    }
  }
  return out;
}

std::vector<PublishedFrame> published_in(const Arguments& arguments, const SequenceFile& sequence) {
  std::vector<PublishedFrame> out;
  LogReader reader(arguments.log);
  const std::string wanted = arguments.single_frames ? channel::kPoses : channel::kObjects;
  while (const std::optional<LogEvent> event = reader.next()) {
    if (event->channel != wanted) continue;
    const FrameId frame = read_result_frame({event->data.data(), event->data.size()}, event->channel);
    const std::optional<std::size_t> index = sequence.index_of(frame.utime);
    require(index.has_value(), "{}: a result of frame {}, which is none of sequence {}", arguments.log,
            to_string(frame), sequence.name);
    out.push_back(arguments.single_frames ? poses_of(*event, sequence, *index)
                                          : PublishedFrame{*index, objects_of(*event)});
  }
  require(!out.empty(), "{}: nothing on {}, expected results", arguments.log, wanted);
  return out;
}

void compare(const Arguments& arguments) {
  const SequenceFile sequence = thinned(read_sequence(arguments.sequence), arguments.every);
  std::map<std::string, Symmetries> symmetries;
  std::map<std::string, AddModel> models;
  std::map<std::string, ObjectModel> outlined;
  for (const auto& [name, model] : load_track_models(arguments.models, 1e-3)) {
    symmetries[name] = model.symmetries;
    models[name] = make_add_model(model.mesh);
    outlined[name] = make_object_model(name, model.mesh, ModelSettings());
  }
  const std::vector<PublishedFrame> published = published_in(arguments, sequence);
  OrderedJson json = track_metrics(sequence, published, symmetries, {});
  const std::vector<MatchedPose> poses = match_published(sequence, published, symmetries);
  json.update(add_metrics(poses, models));
  if (arguments.single_frames) json["outline_px"] = outline_metrics(sequence, poses, outlined);
  json["name"] = sequence.name;
  write_json(json, arguments.out);
}

}  // namespace

int houghstream::studies::tracks_command(CommandLine& app, int argc, char** argv) {
  Arguments arguments;
  app.require_subcommand();
  app.add_example("hs-study tracks log SEQUENCES/walk frames.lcmlog");
  CommandLine log = app.add_subcommand("log", "a sequence as a log of frames and places of cameras");
  log.add_option("sequence", arguments.sequence, "folder of hs-render sequences").required();
  log.add_option("out", arguments.out, "log to write").required();
  log.add_option("--wrong", arguments.wrong, "CHANNEL=x,y,z: metres by which a camera is said to be elsewhere");
  log.add_option("--every", arguments.every, "of so many frames one: a camera of a lower rate").range(1, 1000);
  log.add_example("hs-study tracks log SEQUENCES/walk frames.lcmlog");
  CommandLine join = app.add_subcommand("join", "results of logs behind the frames of another");
  join.add_option("frames", arguments.frames, "log of frames").required();
  join.add_option("results", arguments.results, "logs of detections and poses").required();
  join.add_option("--out", arguments.out, "log to write").required();
  join.add_example("hs-study tracks join frames.lcmlog poses.lcmlog --out joined.lcmlog");
  CommandLine comparison = app.add_subcommand("compare", "what a log holds of a sequence, beside the truth, as JSON");
  comparison.add_option("sequence", arguments.sequence, "folder of hs-render sequences").required();
  comparison.add_option("log", arguments.log, "with objects_t").required();
  comparison.add_option("--models", arguments.models, "folder of the objects' models").required();
  comparison.add_option("--out", arguments.out, "JSON file to write").required();
  comparison.add_flag("--single-frames", arguments.single_frames, "judge the poses of each frame by itself");
  comparison.add_option("--every", arguments.every, "of so many frames one, as the log has them").range(1, 1000);
  comparison.add_example("hs-study tracks compare SEQUENCES/walk objects.lcmlog --models MODELS --out compared.json");
  return run_tool(app, argc, argv, [&] {
    if (log.given()) {
      write_sequence_log(read_sequence(arguments.sequence), arguments.out, wrong_places(arguments.wrong),
                         arguments.every);
    } else if (join.given()) {
      join_logs(arguments.frames, {arguments.results.begin(), arguments.results.end()}, arguments.out);
    } else {
      compare(arguments);
    }
  });
}
