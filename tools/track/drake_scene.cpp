#include "tools/track/drake_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/fnv.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/types/frame_id.hpp"
#include "pose/model/surface_colour.hpp"

namespace houghstream::track {
namespace {

namespace fs = std::filesystem;
using Triangle = std::array<std::uint32_t, 3>;

/// Triangles of nearly one colour.
struct Patch {
  std::vector<Triangle> triangles;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< sum of their colours: red, green, blue, 0 to 1

  Eigen::Vector3d colour() const { return sum / static_cast<double>(triangles.size()); }
};

/// Returns red, green, blue, 0 to 1; grey where the mesh has no colours.
Eigen::Vector3d colour_of(const Mesh& mesh, const Triangle& triangle) {
  const auto rgb = [](const cv::Vec3b& bgr) -> Eigen::Vector3d {
    return Eigen::Vector3d(bgr[2], bgr[1], bgr[0]) / 255.0;
  };
  if (!mesh.texture.empty() && !mesh.uvs.empty()) {
    const Eigen::Vector2f middle = (mesh.uvs[triangle[0]] + mesh.uvs[triangle[1]] + mesh.uvs[triangle[2]]) / 3.0F;
    return rgb(texel_at(mesh.texture, middle));
  }
  if (mesh.colours.empty()) return Eigen::Vector3d::Constant(0.7);
  return (rgb(mesh.colours[triangle[0]]) + rgb(mesh.colours[triangle[1]]) + rgb(mesh.colours[triangle[2]])) / 3.0;
}

/// Groups triangles by colour in steps of an eighth, which gives few materials, since viewers draw these one after
/// another.
std::map<int, Patch> patches_of(const Mesh& mesh) {
  constexpr double kSteps = 8.0;
  const auto step = [](double value) {
    return std::min(static_cast<int>(value * kSteps), static_cast<int>(kSteps) - 1);
  };
  std::map<int, Patch> patches;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d colour = colour_of(mesh, triangle);
    Patch& patch = patches[(step(colour.x()) * 8 + step(colour.y())) * 8 + step(colour.z())];
    patch.triangles.push_back(triangle);
    patch.sum += colour;
  }
  return patches;
}

std::string vertex_lines(const Mesh& mesh) {
  std::string text;
  for (const Eigen::Vector3f& v : mesh.vertices) text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", v.x(), v.y(), v.z());
  for (const Eigen::Vector3f& n : mesh.normals) text += fmt::format("vn {:.4f} {:.4f} {:.4f}\n", n.x(), n.y(), n.z());
  return text;
}

/// Indices of an OBJ count from 1.
std::string face_lines(const Patch& patch, bool normals) {
  std::string text;
  for (const Triangle& t : patch.triangles) {
    text += normals ? fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", t[0] + 1, t[1] + 1, t[2] + 1)
                    : fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

/// Returns a file name without blanks, since meldis takes the name of the .mtl up to the first blank.
std::string file_name(const std::string& name, std::uint64_t number) {
  std::string safe = name.substr(0, 64);
  for (char& c : safe) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return fmt::format("{}-{:016x}", safe, number);
}

void write_new_file(const fs::path& file, const std::string& text) {
  std::error_code error;
  if (!fs::exists(file, error)) write_file_atomically(file, text);
}

/// Three thin boxes along the axes of a frame: x red, y green, z blue.
void add_axes(const ObjectFrame& frame, drake_viewer_link_data_t& link) {
  constexpr double kLength_m = 0.04;
  constexpr float kThickness_m = 0.002F;
  const Eigen::Quaternionf rotation(Eigen::Quaterniond(frame.T_object_frame.linear()).cast<float>());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3f middle =
        (frame.T_object_frame * (0.5 * kLength_m * Eigen::Vector3d::Unit(axis))).cast<float>();
    drake_viewer_geometry_data_t shape{};
    shape.type = drake_viewer_geometry_data_t::BOX;
    std::copy_n(middle.data(), 3, shape.position);
    const std::array<float, 4> quaternion = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
    std::copy_n(quaternion.data(), 4, shape.quaternion);
    shape.color[axis] = shape.color[3] = 1.0F;
    shape.float_data.assign(3, kThickness_m);
    shape.float_data[static_cast<std::size_t>(axis)] = static_cast<float>(kLength_m);
    shape.num_float_data = 3;
    link.geom.push_back(std::move(shape));
  }
}

constexpr float kBox_m = 0.05F;  // side of the box in place of a mesh

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

ViewerMesh write_viewer_mesh(const Mesh& mesh, const std::string& name, const fs::path& folder) {
  Patch whole;
  std::string body = vertex_lines(mesh);
  std::string materials;
  for (const auto& [number, patch] : patches_of(mesh)) {
    const Eigen::Vector3d rgb = patch.colour();
    body += fmt::format("usemtl colour_{}\n", number) + face_lines(patch, !mesh.normals.empty());
    materials += fmt::format("newmtl colour_{}\nKd {:.3f} {:.3f} {:.3f}\n", number, rgb.x(), rgb.y(), rgb.z());
    whole.triangles.insert(whole.triangles.end(), patch.triangles.begin(), patch.triangles.end());
    whole.sum += patch.sum;
  }
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, "{}: cannot make this folder: {}", folder.string(), error.message());
  const std::string stem = file_name(name, fnv1a(materials.data(), materials.size(), fnv1a(body.data(), body.size())));
  write_new_file(folder / (stem + ".mtl"), materials);  // before the mesh that names it
  const fs::path file = fs::absolute(folder / (stem + ".obj")).lexically_normal();
  write_new_file(file, "mtllib " + stem + ".mtl\n" + body);
  const Eigen::Vector3f mean = whole.colour().cast<float>();
  return {file.string(), {mean.x(), mean.y(), mean.z()}};
}

DrakeScene::DrakeScene(std::filesystem::path mesh_folder) : folder_(std::move(mesh_folder)) {}

void DrakeScene::set_models(const tracks::TrackModels& models) {
  meshes_.clear();
  frames_.clear();
  warned_.clear();
  changed_ = true;
  for (const auto& [name, model] : models) {
    frames_[name] = model.frames;
    try {
      meshes_.emplace(name, write_viewer_mesh(model.mesh, name, folder_));
    } catch (const InputError& error) {
      log_warning("Drake's viewers show a box in place of {}: {}", name, error.what());
      warned_.insert(name);
    }
  }
}

DrakeScene::Messages DrakeScene::messages(const WorldObjects& world) {
  constexpr std::int64_t kReloadInterval_us = 10000000;
  Messages out;
  std::vector<std::string> links = shown_links(world);
  const std::int64_t age = microseconds_between(load_utime_, world.frame.utime);
  if (changed_ || !loaded_ || links != *loaded_ || age >= kReloadInterval_us || age <= -kReloadInterval_us) {
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
    if (const auto named = frames_.find(object.class_name); named != frames_.end()) {
      for (const ObjectFrame& frame : named->second) add_axes(frame, link);
    }
    link.num_geom = static_cast<std::int32_t>(link.geom.size());
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
    constexpr std::size_t kMaxWarned = 64;  // an untrusted sender may make up classes without end
    if (warned_.size() < kMaxWarned && warned_.insert(class_name).second)
      log_warning(
          "Drake's viewers show a box in place of {}: its model is not known here, expected it in --objects or "
          "--models",
          class_name);
    shape.type = drake_viewer_geometry_data_t::BOX;
    shape.float_data.assign(3, kBox_m);
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
