#include "tools/log/export_results.hpp"

#include <algorithm>
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
#include "pipeline/types/frame_results.hpp"
#include "tools/log/csv_text.hpp"

namespace houghstream::log_tools {
namespace {

/// Returns the rows of a frame, each object once.
struct ExportedFrame {
  FrameResult look;                  ///< joined results of its detectors; empty where none processed it
  std::vector<ObjectPose> followed;  ///< poses followed from frame to frame for which there is no detection
};

const ObjectPose* pose_of(const FrameResult& look, std::size_t detection) {
  return look.poses ? find_pose(*look.poses, detection) : nullptr;
}

/// Returns whether a detection is written. Candidates that no pose has confirmed are not objects of the frame. If
/// hs-pose has not answered a detection result, the followed poses are more reliable than detections of the same class.
bool is_written(const ExportedFrame& frame, std::size_t index) {
  const Detection& detection = frame.look.detections.detections[index];
  const auto is_same_class = [&](const ObjectPose& pose) { return pose.class_name == detection.class_name; };
  if (!frame.look.poses && std::any_of(frame.followed.begin(), frame.followed.end(), is_same_class)) return false;
  return is_reported(detection, pose_of(frame.look, index));
}

bool is_same_object(const ObjectPose& a, const ObjectPose& b) {
  if (a.class_name != b.class_name || a.status != b.status) return false;
  if (!a.T_camera_object || !b.T_camera_object) return !a.T_camera_object && !b.T_camera_object;
  return a.T_camera_object->isApprox(*b.T_camera_object, 1e-9);
}

/// The detection of a followed object is answered with the followed pose (object_poses_t).
std::vector<ObjectPose> followed_beside(const FrameResult& look, const ObjectPoses& followed) {
  std::vector<ObjectPose> answers;
  for (std::size_t i = 0; i < look.detections.detections.size(); ++i) {
    const ObjectPose* pose = pose_of(look, i);
    if (pose != nullptr && is_reported(look.detections.detections[i], pose)) answers.push_back(*pose);
  }
  std::vector<ObjectPose> others;
  for (const ObjectPose& pose : followed.poses) {
    const auto same = std::find_if(answers.begin(), answers.end(),
                                   [&](const ObjectPose& answer) { return is_same_object(answer, pose); });
    if (same == answers.end()) {
      others.push_back(pose);
    } else {
      answers.erase(same);
    }
  }
  return others;
}

/// Returns nothing where the frame has neither detections nor followed poses.
std::optional<ExportedFrame> exported(const FrameResults& all) {
  std::optional<FrameResult> look = all.merge();
  if (!look && !all.followed()) return std::nullopt;
  if (!all.followed()) return ExportedFrame{std::move(*look), {}};
  const ObjectPoses& followed = *all.followed();
  if (!look) return ExportedFrame{{{followed.frame, {}, followed.stages}, std::nullopt}, followed.poses};
  std::vector<ObjectPose> others = followed_beside(*look, followed);
  return ExportedFrame{std::move(*look), std::move(others)};
}

/// Reads all frames of the log, of all cameras, in the order of time.
std::vector<ExportedFrame> read_results(const std::filesystem::path& log_file, LossReport& losses) {
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
  std::vector<ExportedFrame> results;
  for (const auto& [frame, all] : found) {
    if (std::optional<ExportedFrame> one = exported(all)) results.push_back(std::move(*one));
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

std::string pose_fields(const ObjectPose* pose) {
  if (pose == nullptr) return ",not looked for,,,,,,,,";
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

std::string row(const FrameResult& frame, std::size_t index) {
  const Detection& d = frame.detections.detections[index];
  std::string text = fmt::format("{},{},{},{},{}", frame.detections.frame.utime, quoted(frame.detections.frame.channel),
                                 index, d.class_id, quoted(d.class_name));
  for (const float value : {d.score, d.box_px.x, d.box_px.y, d.box_px.width, d.box_px.height, d.centre_camera.x(),
                            d.centre_camera.y(), d.centre_camera.z()}) {
    text += field(static_cast<double>(value));
  }
  return text + pose_fields(pose_of(frame, index));
}

std::string followed_row(const FrameId& frame, const ObjectPose& pose) {
  return fmt::format("{},{},-1,{},{}", frame.utime, quoted(frame.channel), pose.class_id, quoted(pose.class_name)) +
         field(static_cast<double>(pose.detection_score)) + ",,,,,,," + pose_fields(&pose);
}

OrderedJson number(float value) {
  return finite_or_null(static_cast<double>(value));
}

OrderedJson pose_json(const ObjectPose* pose) {
  if (pose == nullptr) return nullptr;
  OrderedJson json = {{"status", to_string(pose->status)}, {"quality", number(pose->quality)}};
  if (pose->T_camera_object) {
    const Eigen::Vector3d t = pose->T_camera_object->translation();
    const Eigen::Quaterniond q(pose->T_camera_object->linear());
    json["trans"] = {t.x(), t.y(), t.z()};
    json["quat"] = {q.w(), q.x(), q.y(), q.z()};
  }
  return json;
}

OrderedJson detection_json(const Detection& d, const ObjectPose* pose) {
  return {{"class_id", d.class_id},
          {"class_name", d.class_name},
          {"score", number(d.score)},
          {"box", {number(d.box_px.x), number(d.box_px.y), number(d.box_px.width), number(d.box_px.height)}},
          {"centre", {number(d.centre_camera.x()), number(d.centre_camera.y()), number(d.centre_camera.z())}},
          {"pose", pose_json(pose)}};
}

OrderedJson followed_json(const ObjectPose& pose) {
  return {{"class_id", pose.class_id},
          {"class_name", pose.class_name},
          {"score", number(pose.detection_score)},
          {"box", nullptr},
          {"centre", nullptr},
          {"pose", pose_json(&pose)}};
}

OrderedJson frame_json(const ExportedFrame& frame) {
  const FrameResult& look = frame.look;
  OrderedJson json = {{"utime", look.detections.frame.utime}, {"source_channel", look.detections.frame.channel}};
  json["detections"] = OrderedJson::array();
  for (std::size_t i = 0; i < look.detections.detections.size(); ++i) {
    if (is_written(frame, i))
      json["detections"].push_back(detection_json(look.detections.detections[i], pose_of(look, i)));
  }
  for (const ObjectPose& pose : frame.followed) json["detections"].push_back(followed_json(pose));
  // The poses' stages begin with the detections'.
  const bool posed = look.poses && !look.poses->stages.empty();
  json["stages_us"] = OrderedJson::object();
  for (const StageTime& stage : posed ? look.poses->stages : look.detections.stages) {
    OrderedJson& sum = json["stages_us"][stage.stage];  // several detectors list the same stage, each with its time
    sum = (sum.is_null() ? 0 : sum.get<std::int64_t>()) + stage.duration_us;
  }
  return json;
}

}  // namespace

std::int64_t export_results_csv(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                LossReport& losses) {
  require_other_file(out_file, log_file);
  const std::vector<ExportedFrame> results = read_results(log_file, losses);
  std::string text =
      "utime,source_channel,detection,class_id,class_name,score,box_x,box_y,box_width,box_height,"
      "centre_x,centre_y,centre_z,pose_status,x,y,z,qw,qx,qy,qz,quality\n";
  for (const ExportedFrame& frame : results) {
    for (std::size_t i = 0; i < frame.look.detections.detections.size(); ++i) {
      if (is_written(frame, i)) text += row(frame.look, i) + '\n';
    }
    for (const ObjectPose& pose : frame.followed) text += followed_row(frame.look.detections.frame, pose) + '\n';
  }
  write_file_atomically(out_file, text);
  return static_cast<std::int64_t>(results.size());
}

std::int64_t export_results_json(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                 LossReport& losses) {
  require_other_file(out_file, log_file);
  const std::vector<ExportedFrame> results = read_results(log_file, losses);
  OrderedJson json;
  json["frames"] = OrderedJson::array();
  for (const ExportedFrame& frame : results) json["frames"].push_back(frame_json(frame));
  write_json(json, out_file);
  return static_cast<std::int64_t>(results.size());
}

}  // namespace houghstream::log_tools
