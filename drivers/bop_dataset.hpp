#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/frame.hpp"
#include "pipeline/training_view.hpp"

namespace houghstream {

/// One true object in one frame of a BOP scene (scene_gt.json and scene_gt_info.json).
struct TrueObject {
  int object_id = 0;
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< metres
  bool has_pose = true;                                               ///< false where the data has boxes only
  cv::Rect box_visible_px;                                            ///< bbox_visib
  double visible_fraction = 1.0;                                      ///< visib_fract
};

/// One image of a BOP scene.
struct BopImage {
  int image_id = 0;
  Camera camera;
  double depth_scale = 1.0;  ///< stored depth times this is millimetres
  std::vector<TrueObject> objects;
};

/// A scene folder in BOP format (scene_camera.json, scene_gt.json, scene_gt_info.json, rgb/, depth/, mask_visib/),
/// see bop_toolkit docs/bop_datasets_format.md. Reading the index does not read images.
class BopScene {
 public:
  /// Throws InputError when files are missing or their numbers absurd.
  explicit BopScene(std::filesystem::path folder);

  const std::filesystem::path& folder() const { return folder_; }
  const std::vector<BopImage>& images() const { return images_; }  ///< by image id
  /// Frames are stamped from `first_utime` on at 30 Hz, by their position in images().
  RgbdFrame read_frame(std::size_t index) const;
  cv::Mat read_mask(std::size_t index, std::size_t object_index) const;  ///< visible mask, CV_8UC1 0/255

 private:
  std::filesystem::path folder_;
  std::vector<BopImage> images_;
};

/// utime of image `index` of a scene played at 30 Hz; datasets have no clock, so ours starts here.
std::int64_t dataset_utime(std::size_t index);

/// models/models_info.json and the optional models/names.json ({"1": "bowl", ...}); without it names are "object_N".
struct BopModels {
  std::filesystem::path folder;
  std::map<int, std::string> names;                      ///< by object id
  std::map<int, double> diameters;                       ///< metres, by object id
  std::map<int, bool> symmetric;                         ///< has any symmetry in models_info.json
  std::filesystem::path mesh_file(int object_id) const;  ///< obj_000001.ply
};
BopModels read_bop_models(const std::filesystem::path& models_folder);

/// All training views of a BOP training folder: every scene under it, one object per image; its models/ lies beside
/// or above. Background folders (no scene_gt.json, or no objects in it) give class_id 0.
std::vector<TrainingView> read_bop_training_views(const std::filesystem::path& folder);

}  // namespace houghstream
