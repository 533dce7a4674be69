#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pose/fusion/fuse_views.hpp"

namespace houghstream {

/// The views of one object, all in one object frame.
struct ObjectViews {
  int class_id = 0;
  std::string class_name;
  bool exact_poses = true;          ///< whether poses are given with the data, not found from the views
  std::vector<TrainingView> views;  ///< never empty
  std::vector<std::string> unused;  ///< other object frames of the class, which a model cannot have
};

/// Sorts views by class. The object frame of a class with the most views is taken, the first of equals, where there are
/// several (instances of one name, videos of one instance). Background is left out. Throws InputError when nothing is
/// left.
std::vector<ObjectViews> group_views(std::vector<TrainingView> views);

/// Outputs of hs-fuse.
struct FuseOutputs {
  std::filesystem::path models;  ///< BOP models folder: obj_NNNNNN.ply, models_info.json, names.json
  std::filesystem::path images;  ///< folder for CLASS.png of each model from several sides; empty = none
  bool replace = false;          ///< whether existing models may be replaced
};

/// Checks the outputs before the views are read. Throws InputError where the outputs would lie in a folder of the views
/// (each "bop:DIR" or "uw:DIR"), as the true models of a dataset may, would replace models that they may not, or cannot
/// be written.
void check_outputs(const FuseOutputs& outputs, const std::vector<std::string>& views);

/// Fuses each object's views and writes the models, under the classes' ids and names; one line of stdout for each.
/// Views with exact poses are not aligned. Throws InputError.
void fuse_models(const std::vector<ObjectViews>& objects, fusion::FusionSettings settings, const FuseOutputs& outputs);

}  // namespace houghstream
