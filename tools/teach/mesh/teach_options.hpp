#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "detector/training/profiles.hpp"
#include "tools/render/world/mesh_views.hpp"
#include "tools/teach/mesh/score_calibration.hpp"
#include "tools/teach/mesh/teach_sources.hpp"

namespace houghstream::teach {

/// Tone in which objects are searched that hs-teach has taught. Real cameras' tones vary more than rendered rooms':
/// some two fifths of these are as bright as this, nine in ten no more contrasty.
constexpr BrightnessRange kCalibrationBrightness{100.0F, 130.0F, 50.0F};

/// Options of hs-teach mesh.
struct TeachOptions {
  MeshSources meshes;
  std::vector<TaughtMesh> shown;  ///< meshes of shown objects, checked as those are (mesh_checks.hpp)
  /// Views of a camera, by class_name, beside the rendered ones; in the mesh's frame.
  std::vector<TrainingView> own_views;
  BackgroundSettings backgrounds;
  std::filesystem::path out;          ///< the store
  std::string attitudes = "resting";  ///< see world::parse_mesh_attitudes
  bool add = false;                   ///< adds to the existing store
  bool replace = false;               ///< replaces that store; with neither an existing one is refused
  /// Largest group of objects that one forest is taught: objects that lose AUC in a forest of 21 keep it in one of
  /// seven, and the fewer groups there are, the less time a frame takes.
  int max_group_objects = 7;
  std::filesystem::path dump_views;  ///< BOP training folder to write the views to as well; empty = none
  world::MeshViewSettings views;     ///< attitudes and colour are those of the object
  /// Profile, of which `add` reads the training alone; the rest is the forest's.
  Profile profile = make_profile("realtime");
  CalibrationSettings calibration;  ///< seed and threads are those below
  std::uint64_t seed = 1;
  int threads = 2;
};

}  // namespace houghstream::teach
