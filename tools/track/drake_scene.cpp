#include "tools/track/drake_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/types/frame_id.hpp"

namespace houghstream::track {
namespace {

constexpr float kBoxM = 0.05F;  // side of the box in place of a mesh

/// Viewers make folders of "::" and "/".
std::string link_name(const TrackedObject& object) {
  std::string name = object.class_name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '/' || c == ':'; }, '_');
  return fmt::format("{}_{}", name, object.track_id);
}

bool is_shown(const TrackedObject& object) {
  return object.state != TrackState::kGone;
}

std::vector<std::string> shown_links(const WorldObjects& world) {
  std::vector<std::string> names;
  for (const TrackedObject& object : world.objects) {
    if (is_shown(object)) names.push_back(link_name(object));
  }
  return names;
}

drake_viewer_draw_t draw_message(const WorldObjects& world) {
  drake_viewer_draw_t message{};
  message.timestamp = world.frame.utime / 1000;
  for (const TrackedObject& object : world.objects) {
    if (!is_shown(object)) continue;
    const Eigen::Vector3f t = object.T_world_object.translation().cast<float>();
    const Eigen::Quaternionf q = Eigen::Quaterniond(object.T_world_object.linear()).cast<float>();
    message.link_name.push_back(link_name(object));
    message.robot_num.push_back(0);
    message.position.push_back({t.x(), t.y(), t.z()});
    message.quaternion.push_back({q.w(), q.x(), q.y(), q.z()});
  }
  message.num_links = static_cast<std::int32_t>(message.link_name.size());
  return message;
}

}  // namespace

DrakeScene::DrakeScene(std::filesystem::path mesh_folder) : folder_(std::move(mesh_folder)) {}

void DrakeScene::set_models(const tracks::TrackModels& models) {
  meshes_.clear();
  told_.clear();
  changed_ = true;
  for (const auto& [name, model] : models) {
    try {
      meshes_.emplace(name, write_viewer_mesh(model.mesh, name, folder_));
    } catch (const InputError& error) {
      log_warning("Drake's viewers show a box in place of {}: {}", name, error.what());
      told_.insert(name);
    }
  }
}

DrakeScene::Messages DrakeScene::messages(const WorldObjects& world) {
  constexpr std::int64_t kAgainUs = 10000000;
  Messages out;
  std::vector<std::string> links = shown_links(world);
  const std::int64_t age = microseconds_between(load_utime_, world.frame.utime);
  if (changed_ || !loaded_ || links != *loaded_ || age >= kAgainUs || age <= -kAgainUs) {
    out.load = load_message(world);
    loaded_ = std::move(links);
    changed_ = false;
    load_utime_ = world.frame.utime;
  }
  out.draw = draw_message(world);
  return out;
}

drake_viewer_load_robot_t DrakeScene::load_message(const WorldObjects& world) {
  drake_viewer_load_robot_t message{};
  for (const TrackedObject& object : world.objects) {
    if (!is_shown(object)) continue;
    drake_viewer_link_data_t link{};
    link.name = link_name(object);
    link.geom.push_back(shape_of(object.class_name));
    link.num_geom = 1;
    message.link.push_back(std::move(link));
  }
  message.num_links = static_cast<std::int32_t>(message.link.size());
  return message;
}

drake_viewer_geometry_data_t DrakeScene::shape_of(const std::string& class_name) {
  drake_viewer_geometry_data_t shape{};
  shape.quaternion[0] = 1.0F;
  std::fill_n(shape.color, 4, 1.0F);
  const auto mesh = meshes_.find(class_name);
  if (mesh == meshes_.end()) {
    constexpr std::size_t kMaxTold = 64;  // a sender of rubbish may make up classes without end
    if (told_.size() < kMaxTold && told_.insert(class_name).second)
      log_warning(
          "Drake's viewers show a box in place of {}: its model is not known here, expected it in --objects or "
          "--models",
          class_name);
    shape.type = drake_viewer_geometry_data_t::BOX;
    shape.float_data.assign(3, kBoxM);
  } else {
    shape.type = drake_viewer_geometry_data_t::MESH;
    shape.string_data = mesh->second.file;
    shape.float_data.assign(3, 1.0F);
    std::copy(mesh->second.colour.begin(), mesh->second.colour.end(), shape.color);
  }
  shape.num_float_data = static_cast<std::int32_t>(shape.float_data.size());
  return shape;
}

}  // namespace houghstream::track
