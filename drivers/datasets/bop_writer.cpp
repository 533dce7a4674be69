#include "drivers/datasets/bop_writer.hpp"

#include <algorithm>
#include <array>

#include "drivers/datasets/bop_symmetries.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 3> kImageFolders = {"rgb", "depth", "mask_visib"};

OrderedJson camera_entry(const BopImage& image) {
  const Camera& c = image.camera;
  OrderedJson entry;
  entry["cam_K"] = {c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0};
  entry["depth_scale"] = image.depth_scale;
  entry["width"] = c.width;
  entry["height"] = c.height;
  return entry;
}

OrderedJson object_entry(const GroundTruthObject& object) {
  OrderedJson entry;
  if (object.has_pose) {
    const Eigen::Matrix3d R = object.T_camera_object.linear();
    const Eigen::Vector3d t_mm = object.T_camera_object.translation() * 1e3;
    entry["cam_R_m2c"] = {R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
    entry["cam_t_m2c"] = {t_mm.x(), t_mm.y(), t_mm.z()};
  }
  entry["obj_id"] = object.object_id;
  return entry;
}

OrderedJson info_entry(const GroundTruthObject& object) {
  const cv::Rect& box = object.box_visible_px;
  OrderedJson entry;
  if (box.empty()) {
    entry["bbox_visib"] = {-1, -1, -1, -1};
  } else {
    entry["bbox_visib"] = {box.x, box.y, box.width, box.height};
  }
  entry["visib_fract"] = object.visible_fraction;
  return entry;
}

OrderedJson model_entry(const NamedModel& model) {
  const Eigen::AlignedBox3f bounds = mesh_bounds(model.mesh);
  const Eigen::Vector3f low_mm = bounds.min() * 1e3F;
  const Eigen::Vector3f size_mm = bounds.max() * 1e3F - low_mm;
  OrderedJson entry;
  entry["diameter"] = mesh_diameter(model.mesh) * 1e3;
  entry["min_x"] = low_mm.x();
  entry["min_y"] = low_mm.y();
  entry["min_z"] = low_mm.z();
  entry["size_x"] = size_mm.x();
  entry["size_y"] = size_mm.y();
  entry["size_z"] = size_mm.z();
  add_symmetries(model.symmetries, entry);
  return entry;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, "{}: cannot make this folder: {}", folder.string(), error.message());
}

}  // namespace

BopWriter::BopWriter(fs::path folder) : folder_(std::move(folder)) {
  for (const char* part : {"rgb", "depth"}) make_folder(folder_ / part);
}

void BopWriter::add(const RgbdFrame& frame, const std::vector<GroundTruthObject>& objects,
                    const std::vector<cv::Mat>& visible_masks) {
  check_frame(frame, folder_.string());
  require(visible_masks.empty() || visible_masks.size() == objects.size(), "{}: {} masks for {} objects",
          folder_.string(), visible_masks.size(), objects.size());
  const int image_id = static_cast<int>(images_.size());
  const std::string name = fmt::format("{:06d}", image_id);
  write_png(frame.colour, folder_ / "rgb" / (name + ".png"));
  write_png(depth_to_millimetres(frame.depth), folder_ / "depth" / (name + ".png"));
  if (!visible_masks.empty()) make_folder(folder_ / "mask_visib");
  for (std::size_t i = 0; i < visible_masks.size(); ++i) {
    write_png(visible_masks[i], folder_ / "mask_visib" / fmt::format("{}_{:06d}.png", name, i));
  }
  images_.push_back({image_id, frame.camera, 1.0, objects});
}

void BopWriter::finish() {
  OrderedJson cameras = OrderedJson::object();
  OrderedJson truth = OrderedJson::object();
  OrderedJson info = OrderedJson::object();
  for (const BopImage& image : images_) {
    const std::string key = std::to_string(image.image_id);
    cameras[key] = camera_entry(image);
    truth[key] = OrderedJson::array();
    info[key] = OrderedJson::array();
    for (const GroundTruthObject& object : image.objects) {
      truth[key].push_back(object_entry(object));
      info[key].push_back(info_entry(object));
    }
  }
  write_json(cameras, folder_ / "scene_camera.json");
  write_json(truth, folder_ / "scene_gt.json");
  write_json(info, folder_ / "scene_gt_info.json");
}

bool has_images(const fs::path& scene_folder) {
  return std::any_of(kImageFolders.begin(), kImageFolders.end(), [&](const char* part) {
    std::error_code error;
    return fs::is_directory(scene_folder / part, error) && !fs::is_empty(scene_folder / part, error);
  });
}

void remove_images(const fs::path& scene_folder) {
  for (const char* part : kImageFolders) {
    std::error_code error;
    fs::remove_all(scene_folder / part, error);
    require(!error, "{}: cannot be emptied: {}", (scene_folder / part).string(), error.message());
  }
}

void write_bop_names(const std::map<int, std::string>& names, const fs::path& names_file) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [object_id, name] : names) json[std::to_string(object_id)] = name;
  write_json(json, names_file);
}

void write_bop_models(const std::vector<NamedModel>& models, const fs::path& models_folder) {
  make_folder(models_folder);
  OrderedJson info = OrderedJson::object();
  std::map<int, std::string> names;
  for (const NamedModel& model : models) {
    require(!model.mesh.vertices.empty(), "{}: model {} '{}' has no vertices", models_folder.string(), model.object_id,
            model.name);
    save_ply(model.mesh, bop_mesh_file(models_folder, model.object_id));
    info[std::to_string(model.object_id)] = model_entry(model);
    names[model.object_id] = model.name;
  }
  write_json(info, models_folder / "models_info.json");
  write_bop_names(names, models_folder / "names.json");
}

bool has_models(const fs::path& models_folder) {
  const auto is_of_models = [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    const std::string extension = entry.path().extension().string();
    return extension == ".ply" || extension == ".obj" || name == "models_info.json" || name == "names.json";
  };
  std::error_code error;  // a folder that is not there has no entries
  return std::any_of(fs::directory_iterator(models_folder, error), fs::directory_iterator(), is_of_models);
}

}  // namespace houghstream
