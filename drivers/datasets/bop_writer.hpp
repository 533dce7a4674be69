#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Writes one scene folder in BOP format, image by image from id 0 on; the JSON files are written by finish(). An
/// object with has_pose == false is written without cam_R_m2c and cam_t_m2c. scene_camera.json has two keys beyond
/// BOP's, "width" and "height"; of scene_gt_info.json only bbox_visib and visib_fract are written. Throws InputError
/// where it cannot write.
class BopWriter {
 public:
  explicit BopWriter(std::filesystem::path folder);
  /// Adds a frame; `visible_masks` (CV_8UC1 0/255, one per object) may be empty: then no masks are written.
  void add(const RgbdFrame& frame, const std::vector<GroundTruthObject>& objects,
           const std::vector<cv::Mat>& visible_masks);
  void finish();

 private:
  std::filesystem::path folder_;
  std::vector<BopImage> images_;
};

/// Returns whether a scene folder holds images already, which a BopWriter would mix with its own.
bool has_images(const std::filesystem::path& scene_folder);

/// Removes them. Throws InputError where it cannot.
void remove_images(const std::filesystem::path& scene_folder);

/// A model with its object id and name.
struct NamedModel {
  int object_id = 0;
  std::string name;
  Mesh mesh;
  Symmetries symmetries;
};

/// Writes models/obj_NNNNNN.ply, models/models_info.json (diameter, min, size and symmetries) and models/names.json.
void write_bop_models(const std::vector<NamedModel>& models, const std::filesystem::path& models_folder);

/// Returns whether a folder holds models, in BOP's format or as NAME.ply or NAME.obj.
bool has_models(const std::filesystem::path& models_folder);

/// Writes {"1": "bowl", ...}, for models/names.json or SCENE/names.json.
void write_bop_names(const std::map<int, std::string>& names, const std::filesystem::path& names_file);

}  // namespace houghstream
