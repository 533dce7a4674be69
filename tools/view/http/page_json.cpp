#include "tools/view/http/page_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace houghstream::view {
namespace {

using nlohmann::json;

// Names come off the wire and may be no UTF-8.
std::string line_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string css_colour(const cv::Scalar& bgr) {
  return fmt::format("rgb({:.0f},{:.0f},{:.0f})", bgr[2], bgr[1], bgr[0]);
}

template <typename T>
json or_null(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

// Returns the count; null for -1, which means unknown.
json counted(std::int64_t lost) {
  return lost < 0 ? json(nullptr) : json(lost);
}

const ObjectPose* pose_of(const ViewedFrame& viewed, std::size_t detection) {
  return viewed.poses ? find_pose(*viewed.poses, detection) : nullptr;
}

void set_pose(const Eigen::Isometry3d& T, json& value) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  value["position"] = {t.x(), t.y(), t.z()};
  value["quaternion"] = {q.w(), q.x(), q.y(), q.z()};
}

json pose_json(const ObjectPose& pose) {
  json value = {{"status", to_string(pose.status)},
                {"quality", pose.quality},
                {"shape_quality", pose.shape_quality},
                {"converged", pose.converged},
                {"iterations", pose.iterations},
                {"inliers", pose.inliers},
                {"inlier_fraction", pose.inlier_fraction},
                {"residual", pose.residual},
                {"visible_fraction", pose.visible_fraction},
                {"free_space_violation", pose.free_space_violation},
                {"position", nullptr},
                {"quaternion", nullptr}};
  if (pose.T_camera_object) set_pose(*pose.T_camera_object, value);
  return value;
}

json object_json(const Detection& detection, const ObjectPose* pose) {
  const cv::Rect2f& box = detection.box_px;
  const Eigen::Vector3f& centre = detection.centre_camera;
  return {{"name", detection.class_name},
          {"colour", css_colour(class_colour(detection.class_id))},
          {"score", detection.score},
          {"box", {box.x, box.y, box.width, box.height}},
          {"centre", {centre.x(), centre.y(), centre.z()}},
          {"votes", detection.vote_count},
          {"vote_weight", detection.vote_weight},
          {"rotations", detection.rotations.size()},
          {"pose", pose == nullptr ? json(nullptr) : pose_json(*pose)},
          {"why", why_no_pose(pose)}};
}

json stages_json(const std::vector<StageTime>& stages) {
  json list = json::array();
  for (std::size_t i = 0; i < stages.size(); ++i) {
    list.push_back({{"name", stages[i].stage},
                    {"ms", static_cast<double>(stages[i].duration_us) * 1e-3},
                    {"colour", css_colour(stage_colour(i))}});
  }
  return list;
}

json world_json(const WorldState& world) {
  json objects = json::array();
  for (const TrackedObject& object : world.last.objects) {
    const Eigen::Vector3d place = object.T_world_object.translation();
    objects.push_back({{"number", object.track_id},
                       {"name", object.class_name},
                       {"colour", css_colour(class_colour(object.class_id))},
                       {"state", to_string(object.state)},
                       {"probability", object.probability},
                       {"speed", object.moving ? json(object.velocity.head<3>().norm()) : json(nullptr)},
                       {"position", {place.x(), place.y(), place.z()}},
                       {"reason", object.reason}});
  }
  return {{"name", world.last.world}, {"cameras", world.T_world_camera.size()}, {"objects", objects}};
}

json box_json(const ObjectPlacement& placed) {
  json box = {{"size", {placed.box_size.x(), placed.box_size.y(), placed.box_size.z()}}};
  set_pose(placed.T_world_box, box);
  return box;
}

// The world as it is drawn in 3-D; gone objects are left out.
json scene_json(const WorldState& world) {
  json cameras = json::array();
  for (const auto& [channel, T_world_camera] : world.T_world_camera)
    set_pose(T_world_camera, cameras.emplace_back(json{{"name", channel}}));
  json objects = json::array();
  for (const TrackedObject& object : world.last.objects) {
    if (object.state == TrackState::kGone) continue;
    const auto box = world.boxes.find(object.track_id);
    json& entry = objects.emplace_back(json{{"number", object.track_id},
                                            {"name", object.class_name},
                                            {"colour", css_colour(class_colour(object.class_id))},
                                            {"state", to_string(object.state)},
                                            {"box", box == world.boxes.end() ? json(nullptr) : box_json(box->second)}});
    set_pose(object.T_world_object, entry);
  }
  return {{"name", world.last.world}, {"cameras", cameras}, {"objects", objects}};
}

}  // namespace

std::string why_no_pose(const ObjectPose* pose) {
  if (pose == nullptr) return "No pose has come for this detection: hs-pose does not run, or was too late.";
  switch (pose->status) {
    case PoseStatus::kValid: return "";
    case PoseStatus::kValidUpToSymmetry:
      return "Its print does not tell this pose from others that look alike by the shape: a box turned over, a can "
             "turned "
             "about its axis.";
    case PoseStatus::kNoModel: return "hs-pose knows no 3-D model of this class: give it --models or --objects.";
    case PoseStatus::kTooFewPoints:
      return "Hardly any depth was measured inside the box: the object is too far, too small, shiny or transparent.";
    case PoseStatus::kNoInitialPose:
      return "The votes carry no rotation to start from: the forest was taught without poses.";
    case PoseStatus::kNotConverged: return "From no start did the model come to rest on the measured points.";
    case PoseStatus::kRejectedByDepth:
      return "The model, drawn at the best pose, contradicts the measured depth: see what is seen through and what "
             "agrees, or the quality was below hs-pose --min-quality.";
    case PoseStatus::kLowScore:
      return "The score is low: hardly an object, so its pose was not looked for or not believed.";
    case PoseStatus::kRejectedByOutline:
      return "The measured surface goes on where the model ends: a larger thing of similar shape stands there.";
    case PoseStatus::kOccluded:
      return "Something stands before it: it is followed on where it was expected, and has no pose until it is seen.";
    case PoseStatus::kRejectedByColour: return "The model's colours do not explain those that are seen.";
    case PoseStatus::kRefuted:
      return "The model at its best pose fits so badly that the object is less probably there than not.";
    default: return fmt::format("hs-pose says: {}.", to_string(pose->status));
  }
}

std::string frame_json(const ViewedFrame& viewed, double age_ms, const std::optional<WorldState>& world) {
  json objects = json::array();
  for (std::size_t i = 0; i < viewed.detections.detections.size(); ++i)
    objects.push_back(object_json(viewed.detections.detections[i], pose_of(viewed, i)));
  return line_of({{"channel", viewed.frame.id.channel},
                  {"utime", viewed.frame.id.utime},
                  {"width", viewed.frame.camera.width},
                  {"height", viewed.frame.camera.height},
                  {"camera",
                   {{"fx", viewed.frame.camera.fx},
                    {"fy", viewed.frame.camera.fy},
                    {"cx", viewed.frame.camera.cx},
                    {"cy", viewed.frame.camera.cy}}},
                  {"world", world ? scene_json(*world) : json(nullptr)},
                  {"age_ms", age_ms},
                  {"detect_ms", or_null(viewed.detect_latency_ms)},
                  {"pose_ms", or_null(viewed.pose_latency_ms)},
                  {"weak", viewed.weak},
                  {"objects", objects},
                  {"stages", stages_json(viewed.poses ? viewed.poses->stages : viewed.detections.stages)}});
}

std::string stream_json(const StreamView& stream, const FrameViewSettings& settings) {
  json processes = json::array();
  for (const ProcessState& process : stream.state.processes) {
    processes.push_back({{"name", process.name},
                         {"pid", process.pid},
                         {"hz", process.ended ? json(nullptr) : json(process.rate_hz)},
                         {"ended", process.ended},
                         {"skipped", process.skipped},
                         {"lost", counted(process.lost)},
                         {"refused", process.refused}});
  }
  json teaching = nullptr;
  if (stream.state.teaching) {
    const Teaching& told = *stream.state.teaching;
    teaching = {{"name", told.name},
                {"state", to_string(told.state)},
                {"message", told.message},
                {"progress", or_null(told.progress)}};
  }
  json colours = json::object();
  for (const auto& [camera, map] : stream.state.colours) {
    colours[camera] = {{"saturation", map.saturation()},
                       {"white_a", map.white().x()},
                       {"white_b", map.white().y()},
                       {"sigma", map.sigma()},
                       {"objects", map.objects()}};
  }
  return line_of({{"frames_hz", stream.state.frames_hz},
                  {"lost", counted(stream.frames_lost)},
                  {"cameras", stream.cameras},
                  {"processes", processes},
                  {"colours", colours},
                  {"teaching", teaching},
                  {"world", stream.state.world ? world_json(*stream.state.world) : json(nullptr)},
                  {"show_world", settings.show_world},
                  {"paused", settings.paused},
                  {"min_score", settings.min_score}});
}

}  // namespace houghstream::view
