#pragma once

#include <array>
#include <filesystem>
#include <houghstream/drake_viewer_draw_t.hpp>
#include <houghstream/drake_viewer_load_robot_t.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/tracked_object.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::track {

/// A mesh as other programs' viewers take it.
struct ViewerMesh {
  std::string file;             ///< OBJ in metres, absolute path
  std::array<float, 3> colour;  ///< red, green, blue, 0 to 1: the mean of the mesh, for viewers without its materials
};

/// Writes NAME-NUMBER.obj, and beside it the .mtl with the colours of the mesh (or of its texture, each triangle in one
/// colour), into the folder, which is made where it is missing. NUMBER is made of the mesh: equal ones are one file,
/// which is not written again, and another one never takes its place while a viewer reads it. Not PLY as models are:
/// meldis shows OBJ, glTF and DAE only. Throws InputError where it cannot write.
ViewerMesh write_viewer_mesh(const Mesh& mesh, const std::string& name, const std::filesystem::path& folder);

/// Makes the messages of the world's objects for Drake's viewers (drake_visualizer, meldis): a load message with their
/// shapes, and a draw message with their poses for each frame. Objects that are gone are in neither. A viewer puts a
/// loaded shape without a pose at the origin, so that both messages always list the same objects. Not thread-safe.
class DrakeScene {
 public:
  /// Meshes go to files in this folder, for viewers on this machine.
  explicit DrakeScene(std::filesystem::path mesh_folder);

  /// Replaces the classes' meshes and the axes of their named frames (x red, y green, z blue). For a mesh that cannot
  /// be written the reason is logged, and a box takes its place.
  void set_models(const tracks::TrackModels& models);

  struct Messages {
    /// Message to send first: at the beginning, when the set of objects changes, and every ten seconds for viewers that
    /// started later. meldis ignores one that is equal to its last; drake_visualizer loads its files again.
    std::optional<drake_viewer_load_robot_t> load;
    drake_viewer_draw_t draw;
  };
  Messages messages(const WorldObjects& world);

 private:
  drake_viewer_geometry_data_t shape_of(const std::string& class_name);
  drake_viewer_load_robot_t load_message(const WorldObjects& world);

  std::filesystem::path folder_;
  std::map<std::string, ViewerMesh> meshes_;                // meshes by class
  std::map<std::string, std::vector<ObjectFrame>> frames_;  // named frames by class
  std::set<std::string> warned_;                            // classes without a mesh, of which a warning was logged
  std::optional<std::vector<std::string>> loaded_;
  bool changed_ = false;
  std::int64_t load_utime_ = 0;
};

}  // namespace houghstream::track
