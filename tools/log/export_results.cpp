#include "tools/log/export_results.hpp"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "pipeline/types/reported_objects.hpp"
#include "tools/log/csv_text.hpp"

namespace houghstream::log_tools {
namespace {

/// Reads all frames of the log, of all cameras, in the order of time.
std::vector<ReportedObjects> read_results(const std::filesystem::path& log_file, LossReport& losses) {
  std::map<FrameId, FrameResults> found;
  IntactEvents events(log_file, losses);
  while (const std::optional<LogEvent> event = events.next()) {
    const ByteView bytes{event->data.data(), event->data.size()};
    try {
      if (event->channel == channel::kDetections) {
        Detections detections = detections_from_message(decode_message<detections_t>(bytes));
        FrameResults& of_frame = found[detections.frame];
        of_frame.add(std::move(detections));
      } else if (event->channel == channel::kPoses) {
        ObjectPoses poses = poses_from_message(decode_message<object_poses_t>(bytes));
        FrameResults& of_frame = found[poses.frame];
        of_frame.add(std::move(poses));
      }
    } catch (const InputError& error) {
      losses.note_refused(error.what());
    }
  }
  std::vector<ReportedObjects> results;
  for (const auto& [frame, all] : found) {
    if (std::optional<ReportedObjects> one = report_objects(all)) results.push_back(std::move(*one));
    for (std::size_t i = 0; i < all.unmatched().size(); ++i) {
      losses.note_refused(fmt::format("poses of frame {}, of no detections in the log", to_string(frame)));
    }
  }
  require(!results.empty(),
          "{}: no message on {}, and none of followed objects on {}, expected results; hs-pose --keep-frames keeps "
          "detections beside its poses",
          log_file.string(), channel::kDetections, channel::kPoses);
  return results;
}

/// Empty for what is not finite.
std::string field(double value) {
  return std::isfinite(value) ? fmt::format(",{:.9g}", value) : ",";
}

std::string pose_fields(const std::optional<ObjectPose>& pose) {
  if (!pose) return ",not looked for,,,,,,,,";
  std::string text = fmt::format(",{}", to_string(pose->status));
  if (pose->T_camera_object) {
    const Eigen::Vector3d t = pose->T_camera_object->translation();
    const Eigen::Quaterniond q(pose->T_camera_object->linear());
    for (const double value : {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) text += field(value);
  } else {
    text += ",,,,,,,";
  }
  return text + field(pose->quality);
}

std::string row(const FrameId& frame, const ReportedObject& object) {
  std::string text = fmt::format("{},{},{}", frame.utime, quoted(frame.channel), object.detection_index);
  if (!object.detection) {
    const ObjectPose& pose = *object.pose;
    return text + fmt::format(",{},{}", pose.class_id, quoted(pose.class_name)) +
           field(static_cast<double>(pose.detection_score)) + ",,,,,,," + pose_fields(object.pose);
  }
  const Detection& d = *object.detection;
  text += fmt::format(",{},{}", d.class_id, quoted(d.class_name));
  for (const float value : {d.score, d.box_px.x, d.box_px.y, d.box_px.width, d.box_px.height, d.centre_camera.x(),
                            d.centre_camera.y(), d.centre_camera.z()}) {
    text += field(static_cast<double>(value));
  }
  return text + pose_fields(object.pose);
}

OrderedJson number(float value) {
  return finite_or_null(static_cast<double>(value));
}

OrderedJson pose_json(const std::optional<ObjectPose>& pose) {
  if (!pose) return nullptr;
  OrderedJson json = {{"status", to_string(pose->status)}, {"quality", number(pose->quality)}};
  if (pose->T_camera_object) {
    const Eigen::Vector3d t = pose->T_camera_object->translation();
    const Eigen::Quaterniond q(pose->T_camera_object->linear());
    json["trans"] = {t.x(), t.y(), t.z()};
    json["quat"] = {q.w(), q.x(), q.y(), q.z()};
  }
  return json;
}

OrderedJson object_json(const ReportedObject& object) {
  if (!object.detection) {
    const ObjectPose& pose = *object.pose;
    return {{"class_id", pose.class_id},
            {"class_name", pose.class_name},
            {"score", number(pose.detection_score)},
            {"box", nullptr},
            {"centre", nullptr},
            {"pose", pose_json(object.pose)}};
  }
  const Detection& d = *object.detection;
  return {{"class_id", d.class_id},
          {"class_name", d.class_name},
          {"score", number(d.score)},
          {"box", {number(d.box_px.x), number(d.box_px.y), number(d.box_px.width), number(d.box_px.height)}},
          {"centre", {number(d.centre_camera.x()), number(d.centre_camera.y()), number(d.centre_camera.z())}},
          {"pose", pose_json(object.pose)}};
}

OrderedJson frame_json(const ReportedObjects& frame) {
  OrderedJson json = {{"utime", frame.frame.utime}, {"source_channel", frame.frame.channel}};
  json["detections"] = OrderedJson::array();
  for (const ReportedObject& object : frame.objects) json["detections"].push_back(object_json(object));
  json["stages_us"] = OrderedJson::object();
  for (const StageTime& stage : frame.stages) {
    OrderedJson& sum = json["stages_us"][stage.stage];  // several detectors list the same stage, each with its time
    sum = (sum.is_null() ? 0 : sum.get<std::int64_t>()) + stage.duration_us;
  }
  return json;
}

}  // namespace

std::int64_t export_results_csv(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                LossReport& losses) {
  require_other_file(out_file, log_file);
  const std::vector<ReportedObjects> results = read_results(log_file, losses);
  std::string text =
      "utime,source_channel,detection,class_id,class_name,score,box_x,box_y,box_width,box_height,"
      "centre_x,centre_y,centre_z,pose_status,x,y,z,qw,qx,qy,qz,quality\n";
  for (const ReportedObjects& frame : results) {
    for (const ReportedObject& object : frame.objects) text += row(frame.frame, object) + '\n';
  }
  write_file_atomically(out_file, text);
  return static_cast<std::int64_t>(results.size());
}

std::int64_t export_results_json(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                 LossReport& losses) {
  require_other_file(out_file, log_file);
  const std::vector<ReportedObjects> results = read_results(log_file, losses);
  OrderedJson json;
  json["frames"] = OrderedJson::array();
  for (const ReportedObjects& frame : results) json["frames"].push_back(frame_json(frame));
  write_json(json, out_file);
  return static_cast<std::int64_t>(results.size());
}

}  // namespace houghstream::log_tools
