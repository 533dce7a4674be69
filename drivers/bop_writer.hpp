#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "drivers/bop_dataset.hpp"
#include "pipeline/frame.hpp"
#include "pipeline/mesh.hpp"

namespace houghstream {

/// Writes one scene folder in BOP format, image by image; the JSON files are written by finish().
class BopWriter {
 public:
  explicit BopWriter(std::filesystem::path folder);
  /// `visible_masks` (CV_8UC1 0/255, one per object) may be empty: then no masks are written.
  void add(const RgbdFrame& frame, const std::vector<TrueObject>& objects, const std::vector<cv::Mat>& visible_masks);
  void finish();

 private:
  std::filesystem::path folder_;
  std::vector<BopImage> images_;
};

/// Writes models/obj_NNNNNN.ply, models/models_info.json and models/names.json.
struct NamedModel {
  int object_id = 0;
  std::string name;
  Mesh mesh;
  bool symmetric_about_z = false;  ///< continuous symmetry about the object's z axis
};
void write_bop_models(const std::vector<NamedModel>& models, const std::filesystem::path& models_folder);

}  // namespace houghstream
