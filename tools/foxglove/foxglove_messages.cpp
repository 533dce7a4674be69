#include "tools/foxglove/foxglove_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/codecs.hpp"
#include "pipeline/messages/messages.hpp"
#include "tools/foxglove/glb_mesh.hpp"
#include "tools/foxglove/protobuf_message.hpp"

namespace houghstream::foxglove {
namespace {

constexpr double kLineThickness_px = 2.0;
constexpr double kFontSize_px = 14.0;
constexpr double kTextHeight_m = 0.02;

struct Rgba {
  double r, g, b, a;
};
constexpr Rgba kSure{0.0, 0.75, 0.45, 1.0};    // an object with a pose
constexpr Rgba kUnsure{0.95, 0.65, 0.0, 1.0};  // one without
constexpr Rgba kWhite{1.0, 1.0, 1.0, 1.0};
constexpr Rgba kNothing{0.0, 0.0, 0.0, 0.0};
constexpr Rgba kGlass{0.3, 0.6, 0.9, 0.4};  // a box in place of a model

ProtobufMessage colour_field(const Rgba& colour) {
  ProtobufMessage message("foxglove.Color");
  return message.add_number("r", colour.r)
      .add_number("g", colour.g)
      .add_number("b", colour.b)
      .add_number("a", colour.a);
}

ProtobufMessage time_field(std::int64_t utime) {
  constexpr std::int64_t kPerSecond = 1'000'000;
  ProtobufMessage message("google.protobuf.Timestamp");
  return message.add_integer("seconds", utime / kPerSecond).add_integer("nanos", utime % kPerSecond * 1000);
}

ProtobufMessage point_field(double x_px, double y_px) {
  return ProtobufMessage("foxglove.Point2").add_number("x", x_px).add_number("y", y_px);
}

ProtobufMessage vector_field(const Eigen::Vector3d& v) {
  return ProtobufMessage("foxglove.Vector3").add_number("x", v.x()).add_number("y", v.y()).add_number("z", v.z());
}

ProtobufMessage rotation_field(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  ProtobufMessage message("foxglove.Quaternion");
  return message.add_number("x", q.x()).add_number("y", q.y()).add_number("z", q.z()).add_number("w", q.w());
}

ProtobufMessage pose_field(const Eigen::Isometry3d& T) {
  ProtobufMessage message("foxglove.Pose");
  return message.add_message("position", vector_field(T.translation())).add_message("orientation", rotation_field(T));
}

/// Names two coordinate frames: T_parent_child maps points of the child into the parent.
struct FramePair {
  std::string parent;
  std::string child;
};

void add_transform(ProtobufMessage& transforms, std::int64_t utime, const FramePair& frames,
                   const Eigen::Isometry3d& T_parent_child) {
  ProtobufMessage message("foxglove.FrameTransform");
  message.add_message("timestamp", time_field(utime)).add_text("parent_frame_id", frames.parent);
  message.add_text("child_frame_id", frames.child);
  message.add_message("translation", vector_field(T_parent_child.translation()));
  transforms.add_message("transforms", message.add_message("rotation", rotation_field(T_parent_child)));
}

FoxgloveMessage finish(const std::string& topic, std::int64_t utime, const ProtobufMessage& message) {
  FoxgloveMessage finished;
  finished.topic = topic;
  finished.type = message.type();
  finished.utime = utime;
  finished.data = message.bytes();
  return finished;
}

std::string_view view_of(const std::vector<std::uint8_t>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns the colour image as JPEG: as it came, where it came so.
std::vector<std::uint8_t> jpeg_of(const images_t& frame, const FrameImages& images) {
  const auto left = std::find(frame.image_types.begin(), frame.image_types.end(), images_t::LEFT);
  const image_t& colour = frame.images[static_cast<std::size_t>(left - frame.image_types.begin())];
  return colour.pixelformat == image_t::PIXEL_FORMAT_MJPEG ? colour.data
                                                           : encode_jpeg(images.colour, WireFormat{}.jpeg_quality);
}

FoxgloveMessage depth_message(const cv::Mat& depth_mm, const std::string& channel, std::int64_t utime) {
  require(depth_mm.isContinuous(), "depth of {}x{} pixels with gaps between its rows", depth_mm.cols, depth_mm.rows);
  ProtobufMessage message("foxglove.RawImage");
  message.add_message("timestamp", time_field(utime)).add_text("frame_id", channel);
  message.add_integer("width", depth_mm.cols).add_integer("height", depth_mm.rows);
  message.add_text("encoding", "16UC1").add_integer("step", 2 * depth_mm.cols);
  message.add_text("data", {reinterpret_cast<const char*>(depth_mm.data), depth_mm.total() * depth_mm.elemSize()});
  return finish("/" + channel + "/depth", utime, message);
}

/// A camera without distortion, as all are here.
FoxgloveMessage calibration_message(const Camera& camera, const std::string& channel, std::int64_t utime) {
  ProtobufMessage message("foxglove.CameraCalibration");
  message.add_message("timestamp", time_field(utime)).add_text("frame_id", channel);
  message.add_integer("width", camera.width).add_integer("height", camera.height);
  message.add_text("distortion_model", "plumb_bob").add_numbers("D", {0, 0, 0, 0, 0});
  message.add_numbers("K", {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1});
  message.add_numbers("R", {1, 0, 0, 0, 1, 0, 0, 0, 1});
  message.add_numbers("P", {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0});
  return finish("/" + channel + "/calibration", utime, message);
}

bool has_valid_pose(const ReportedObject& object) {
  return object.pose && object.pose->T_camera_object;
}

const std::string& class_of(const ReportedObject& object) {
  return object.detection ? object.detection->class_name : object.pose->class_name;
}

ProtobufMessage box_annotation(const ReportedObject& object, std::int64_t utime) {
  constexpr int kLineLoop = 2;
  const cv::Rect2f& box = object.detection->box_px;
  ProtobufMessage message("foxglove.PointsAnnotation");
  message.add_message("timestamp", time_field(utime)).add_integer("type", kLineLoop);
  for (const auto& [x, y] : {std::pair(box.x, box.y), std::pair(box.x + box.width, box.y),
                             std::pair(box.x + box.width, box.y + box.height), std::pair(box.x, box.y + box.height)})
    message.add_message("points", point_field(x, y));
  message.add_message("outline_color", colour_field(has_valid_pose(object) ? kSure : kUnsure));
  return message.add_message("fill_color", colour_field(kNothing)).add_number("thickness", kLineThickness_px);
}

/// Returns "mug 0.93", or with a pose "mug 0.93, quality 0.87".
std::string label_of(const ReportedObject& object) {
  const float score = object.detection ? object.detection->score : object.pose->detection_score;
  std::string label = fmt::format("{} {:.2f}", class_of(object), score);
  if (has_valid_pose(object)) label += fmt::format(", quality {:.2f}", object.pose->quality);
  return label;
}

/// Returns where the name of an object stands: at its box, else where its origin is in the image. Foxglove's pixels
/// begin at the corner of the first one.
std::optional<Eigen::Vector2d> label_place(const ReportedObject& object, const Camera* camera) {
  constexpr double kMinDepth_m = 0.05;
  if (object.detection) return Eigen::Vector2d(object.detection->box_px.x, object.detection->box_px.y);
  if (camera == nullptr || !has_valid_pose(object)) return std::nullopt;
  const Eigen::Vector3d origin = object.pose->T_camera_object->translation();
  if (origin.z() < kMinDepth_m) return std::nullopt;
  return camera->project(origin) + Eigen::Vector2d(0.5, 0.5);
}

ProtobufMessage text_annotation(const std::string& text, const Eigen::Vector2d& place, std::int64_t utime) {
  constexpr Rgba kShade{0.0, 0.0, 0.0, 0.6};
  ProtobufMessage message("foxglove.TextAnnotation");
  message.add_message("timestamp", time_field(utime)).add_message("position", point_field(place.x(), place.y()));
  message.add_text("text", text).add_number("font_size", kFontSize_px);
  return message.add_message("text_color", colour_field(kWhite)).add_message("background_color", colour_field(kShade));
}

FoxgloveMessage annotations_message(const ReportedObjects& objects, const Camera* camera) {
  const std::int64_t utime = objects.frame.utime;
  ProtobufMessage message("foxglove.ImageAnnotations");
  for (const ReportedObject& object : objects.objects) {
    if (object.detection) message.add_message("points", box_annotation(object, utime));
    const std::optional<Eigen::Vector2d> place = label_place(object, camera);
    if (place) message.add_message("texts", text_annotation(label_of(object), *place, utime));
  }
  return finish("/" + objects.frame.channel + "/annotations", utime, message);
}

std::string numbered_name(const TrackedObject& object) {
  return fmt::format("{}_{}", object.class_name, object.track_id);
}

FoxgloveMessage deletion_message(const std::string& topic, std::int64_t utime) {
  constexpr int kAll = 1;
  ProtobufMessage deletion("foxglove.SceneEntityDeletion");
  deletion.add_message("timestamp", time_field(utime)).add_integer("type", kAll);
  return finish(topic, utime, ProtobufMessage("foxglove.SceneUpdate").add_message("deletions", deletion));
}

ProtobufMessage model_primitive(const std::string& glb) {
  ProtobufMessage model("foxglove.ModelPrimitive");
  model.add_message("pose", pose_field(Eigen::Isometry3d::Identity()));
  model.add_message("scale", vector_field(Eigen::Vector3d::Ones())).add_message("color", colour_field(kWhite));
  return model.add_flag("override_color", false).add_text("media_type", "model/gltf-binary").add_text("data", glb);
}

ProtobufMessage box_primitive(const Eigen::Isometry3d& T_object_box, const Eigen::Vector3d& size) {
  ProtobufMessage cube("foxglove.CubePrimitive");
  cube.add_message("pose", pose_field(T_object_box)).add_message("size", vector_field(size));
  return cube.add_message("color", colour_field(kGlass));
}

ProtobufMessage name_primitive(const std::string& name) {
  ProtobufMessage text("foxglove.TextPrimitive");
  text.add_message("pose", pose_field(Eigen::Isometry3d::Identity())).add_flag("billboard", true);
  return text.add_number("font_size", kTextHeight_m).add_message("color", colour_field(kWhite)).add_text("text", name);
}

}  // namespace

FoxgloveMessages::FoxgloveMessages(const std::map<std::string, Mesh>& models) {
  set_models(models);
}

void FoxgloveMessages::set_models(const std::map<std::string, Mesh>& models) {
  models_.clear();
  for (const auto& [name, mesh] : models) models_[name] = encode_glb(mesh);
}

std::vector<FoxgloveMessage> FoxgloveMessages::convert_frame(const images_t& frame, const std::string& channel,
                                                             const std::optional<Camera>& fallback_camera) {
  const FrameImages images = images_from_message(frame);
  const std::optional<Camera> own = read_camera_metadata(frame);
  const std::optional<Camera> camera = own ? own : fallback_camera;
  if (camera) check_camera(*camera, "frame " + to_string(FrameId{channel, frame.utime}));
  channels_.insert(channel);
  ProtobufMessage colour("foxglove.CompressedImage");
  colour.add_message("timestamp", time_field(frame.utime)).add_text("frame_id", channel);
  colour.add_text("data", view_of(jpeg_of(frame, images))).add_text("format", "jpeg");
  std::vector<FoxgloveMessage> messages = {finish("/" + channel + "/colour", frame.utime, colour),
                                           depth_message(images.depth_mm, channel, frame.utime)};
  if (camera) {
    messages.push_back(calibration_message(*camera, channel, frame.utime));
    cameras_[channel] = *camera;
  }
  return messages;
}

std::vector<FoxgloveMessage> FoxgloveMessages::convert_objects(const ReportedObjects& objects) {
  const auto& [channel, utime] = objects.frame;
  const auto camera = cameras_.find(channel);
  std::vector<FoxgloveMessage> messages = {
      annotations_message(objects, camera == cameras_.end() ? nullptr : &camera->second)};
  ProtobufMessage transforms("foxglove.FrameTransforms");
  std::vector<Shown> shown;
  std::map<std::string, int> counts;
  for (const ReportedObject& object : objects.objects) {
    if (!has_valid_pose(object)) continue;
    const int count = ++counts[class_of(object)];
    const std::string name = count == 1 ? class_of(object) : fmt::format("{}_{}", class_of(object), count);
    Shown entity;
    entity.topic = fmt::format("/{}/objects/{}", channel, name);
    entity.frame = fmt::format("{}/{}", channel, name);
    add_transform(transforms, utime, {channel, entity.frame}, *object.pose->T_camera_object);
    entity.class_name = class_of(object);
    shown.push_back(std::move(entity));
  }
  if (!shown.empty()) messages.push_back(finish("/transforms", utime, transforms));
  update_scene(channel, shown, utime, messages);
  return messages;
}

std::vector<FoxgloveMessage> FoxgloveMessages::convert_world(const WorldObjects& world,
                                                             const std::optional<ObjectPlacements>& placed) {
  const bool is_placed = placed && placed->frame == world.frame;
  const std::int64_t utime = world.frame.utime;
  ProtobufMessage transforms("foxglove.FrameTransforms");
  if (world.world != world.frame.channel)
    add_transform(transforms, utime, {world.world, world.frame.channel}, world.T_world_camera);
  std::vector<Shown> shown;
  for (const TrackedObject& object : world.objects) {
    if (object.state == TrackState::kGone) continue;
    Shown entity;
    entity.frame = numbered_name(object);
    entity.topic = "/objects/" + entity.frame;
    entity.class_name = object.class_name;
    entity.T_world_object = object.T_world_object;
    add_transform(transforms, utime, {world.world, entity.frame}, object.T_world_object);
    if (const ObjectPlacement* place = is_placed ? placed->find(object.track_id) : nullptr) {
      entity.place = *place;
      for (const PlacedObjectFrame& frame : place->frames)
        add_transform(transforms, utime, {world.world, entity.frame + "/" + frame.name}, frame.T_world_frame);
    }
    shown.push_back(std::move(entity));
  }
  std::vector<FoxgloveMessage> messages;
  if (!transforms.bytes().empty()) messages.push_back(finish("/transforms", utime, transforms));
  update_scene("", shown, utime, messages);
  return messages;
}

std::vector<FoxgloveMessage> FoxgloveMessages::convert_camera_pose(const std::string& channel, std::int64_t utime,
                                                                   const Eigen::Isometry3d& T_world_camera) const {
  const auto camera = std::find_if(channels_.begin(), channels_.end(),
                                   [&](const std::string& known) { return channel::to_world(known) == channel; });
  if (camera == channels_.end()) return {};
  ProtobufMessage transforms("foxglove.FrameTransforms");
  add_transform(transforms, utime, {"WORLD", *camera}, T_world_camera);
  return {finish("/transforms", utime, transforms)};
}

FoxgloveMessage FoxgloveMessages::entity_message(const Shown& object, std::int64_t utime) const {
  ProtobufMessage entity("foxglove.SceneEntity");
  entity.add_message("timestamp", time_field(utime)).add_text("frame_id", object.frame);
  entity.add_text("id", object.frame).add_flag("frame_locked", true);
  const auto model = models_.find(object.class_name);
  if (model != models_.end()) {
    entity.add_message("models", model_primitive(model->second));
  } else if (object.place) {
    const Eigen::Isometry3d T_object_box = object.T_world_object.inverse() * object.place->T_world_box;
    entity.add_message("cubes", box_primitive(T_object_box, object.place->box_size));
  }
  entity.add_message("texts", name_primitive(object.class_name));
  return finish(object.topic, utime, ProtobufMessage("foxglove.SceneUpdate").add_message("entities", entity));
}

void FoxgloveMessages::update_scene(const std::string& owner, const std::vector<Shown>& objects, std::int64_t utime,
                                    std::vector<FoxgloveMessage>& messages) {
  std::set<std::string> now;
  for (const Shown& object : objects) {
    now.insert(object.topic);
    if (shown_[owner].count(object.topic) == 0) messages.push_back(entity_message(object, utime));
  }
  for (const std::string& topic : shown_[owner]) {
    if (now.count(topic) == 0) messages.push_back(deletion_message(topic, utime));
  }
  shown_[owner] = std::move(now);
}

}  // namespace houghstream::foxglove
