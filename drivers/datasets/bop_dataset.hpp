#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream {

/// Describes one ground-truth object in one frame of a BOP scene (scene_gt.json and scene_gt_info.json).
struct GroundTruthObject {
  int object_id = 0;
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< metres
  bool has_pose = true;                                               ///< false where the data has boxes only
  cv::Rect box_visible_px;                                            ///< bbox_visib
  double visible_fraction = 1.0;                                      ///< visib_fract
};

/// Describes one image of a BOP scene.
struct BopImage {
  int image_id = 0;
  Camera camera;
  double depth_scale = 1.0;  ///< stored depth times this is millimetres
  std::vector<GroundTruthObject> objects;
};

/// Reads a scene folder in BOP format (scene_camera.json, scene_gt.json, scene_gt_info.json, rgb/, depth/,
/// mask_visib/), see bop_toolkit docs/bop_datasets_format.md. Reading the index does not read images, except one where
/// scene_camera.json lacks our additional keys "width" and "height". Without scene_gt.json it has no objects. A
/// rotation that is off by less than a per cent becomes the nearest one; larger errors are refused. An object known by
/// its box only has neither cam_R_m2c nor cam_t_m2c in scene_gt.json; its name may then come from SCENE/names.json,
/// since there is no models/.
class BopScene {
 public:
  /// Throws InputError when files are missing or their numbers absurd.
  explicit BopScene(std::filesystem::path folder);

  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<BopImage>& images() const { return images_; }  ///< in the order of their ids
  /// Frames are stamped with dataset_utime(), by their position in images().
  RgbdFrame read_frame(std::size_t index) const;
  cv::Mat read_mask(std::size_t index, std::size_t object_index) const;  ///< visible mask, CV_8UC1 0/255

 private:
  std::filesystem::path folder_;
  std::vector<BopImage> images_;
};

/// Datasets state no rate; ours are played at a camera's.
constexpr int kDatasetRateHz = 30;

/// Returns the utime of image `index` of a dataset. Datasets have no clock, so ours starts in July 2017.
std::int64_t dataset_utime(std::size_t index);

/// Returns the file of an object's mesh in a models folder: obj_000001.ply.
std::filesystem::path bop_mesh_file(const std::filesystem::path& models_folder, int object_id);

/// models/models_info.json and the optional models/names.json ({"1": "bowl", ...}); without it names are "object_N".
struct BopModels {
  std::filesystem::path folder;
  std::map<int, std::string> names;                      ///< names by object id
  std::map<int, double> diameters;                       ///< metres, by object id
  std::map<int, Eigen::AlignedBox3d> bounds;             ///< metres, object frame; of those that state min and size
  std::map<int, Symmetries> symmetries;                  ///< empty for an object without any
  std::filesystem::path mesh_file(int object_id) const;  ///< bop_mesh_file()
};
/// Throws InputError when files are missing or their numbers absurd.
BopModels read_bop_models(const std::filesystem::path& models_folder);

/// Loads the meshes of a models folder by class name, metres: a BOP one, or, without models_info.json, all NAME.ply and
/// NAME.obj in it. `unit_m` is the length of the files' unit in metres (BOP: millimetres). Throws InputError where
/// there are none or two share a name. They are read on `threads` threads.
std::map<std::string, Mesh> load_class_models(const std::filesystem::path& models_folder, double unit_m = 1e-3,
                                              int threads = 1);

/// Reads the classes' symmetries from models_info.json of a models folder, by class name; empty where there is no such
/// file. Throws InputError as read_bop_models() does.
std::map<std::string, Symmetries> load_class_symmetries(const std::filesystem::path& models_folder);

/// Reads a file such as {"1": "bowl", ...}.
std::map<int, std::string> read_bop_names(const std::filesystem::path& names_file);

/// Returns the folder models/ in the scene's folder or up to three levels above it.
std::optional<std::filesystem::path> find_bop_models(const std::filesystem::path& folder);

/// Returns the names of a scene's objects by id: its own names.json, else those of find_bop_models(); empty without
/// either.
std::map<int, std::string> find_bop_names(const std::filesystem::path& scene_folder);

/// Objects that are less visible (visib_fract) are not taught from: what hides them would be part of their image.
constexpr double kMinTrainingVisibility = 0.75;

/// Reads all training views of a BOP training folder, rendered (also PBR) or recorded: every scene in or under it, one
/// view for each object of each image, cropped around its mask_visib; its models/ lies beside or above, and its frame
/// is the model's in all of them (`object_frame` stays empty). Images without objects are background (class_id 0, not
/// cropped). Objects below kMinTrainingVisibility are left out, and those without depth, with a warning; throws
/// InputError when nothing is left.
std::vector<TrainingView> read_bop_training_views(const std::filesystem::path& folder, int threads = 1);

}  // namespace houghstream
