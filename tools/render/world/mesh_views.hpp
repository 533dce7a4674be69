#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"
#include "tools/render/world/objects/asset.hpp"

namespace houghstream::world {

/// Attitudes in which a mesh is shown.
enum class MeshAttitudes : std::uint8_t {
  kResting,  ///< at rest on a table, and leaning from there
  kUpright,  ///< its z axis up
  kAny       ///< all rotations equally often, as if held
};

/// Parses "resting", "upright" or "any". Throws InputError naming them for another.
MeshAttitudes parse_mesh_attitudes(const std::string& name);

/// Returns the directions of the object (unit length, object frame) that point up in these attitudes: the most stable
/// first, and only ones that differ clearly. For a mesh that does not rest, or encloses no volume, these are the sides
/// of the bounding box; for kAny there are none.
std::vector<Eigen::Vector3d> up_directions(const Mesh& mesh, MeshAttitudes attitudes);

/// Returns a rotation evenly distributed over all (Shoemake, "Uniform random rotations", Graphics Gems III, 1992).
Eigen::Matrix3d random_rotation(Random& random);

struct MeshViewSettings {
  MeshAttitudes attitudes = MeshAttitudes::kResting;
  int views_per_attitude = 400;    ///< all round and from low to high; fewer where there are many attitudes
  int max_views = 2200;            ///< maximum of one object, and the number of kAny
  double lowest_pitch_deg = 12.0;  ///< minimum pitch of the camera
  double highest_pitch_deg = 80.0;
  double distance_m = 0.7;        ///< camera to object; more where it would not fit the image
  double leaning_fraction = 0.2;  ///< fraction of the views of kResting
  bool has_colour = true;         ///< false: another plain colour in every view
};

/// A mesh as it is rendered: with colour unknown, plain grey. Its symmetries do not matter. See MeshViews for what it
/// must have.
AssetPtr make_taught_thing(Mesh mesh, bool has_colour);

/// Returns the asset, whose vertices have colours, in one colour.
AssetPtr plainly_painted(const Asset& thing, Random& random);

/// Renders training views of a mesh: each in a light of its own, with the noise of a structured-light camera. Axes and
/// origin of the mesh have no meaning. The same arguments give the same views; const calls are thread-safe.
class MeshViews {
 public:
  /// `mesh` has metres, triangles, normals, and a texture or a colour per vertex unless has_colour is false.
  MeshViews(Mesh mesh, const MeshViewSettings& settings, std::uint64_t seed);

  int count() const { return static_cast<int>(poses_.size()); }
  /// Returns the result of up_directions().
  const std::vector<Eigen::Vector3d>& ups() const { return ups_; }
  const AssetPtr& thing() const { return thing_; }

  /// Renders view `index`, cropped around the object; names, ids and source are left empty.
  TrainingView render(int index) const;

 private:
  struct ViewPose {
    Eigen::Matrix3d R_level_object = Eigen::Matrix3d::Identity();  ///< into a frame with z up
    double pitch_rad = 0.0;
    double roll_rad = 0.0;  ///< roll of the camera about its line of sight
    bool on_table = false;
  };

  void add_level_views();
  void add_any_views();

  MeshViewSettings settings_;
  std::uint64_t seed_;
  AssetPtr thing_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  ///< centre of the bounding box
  double radius_ = 0.0;                               ///< radius of the sphere about it, metres
  std::vector<Eigen::Vector3d> ups_;
  std::vector<ViewPose> poses_;
};

}  // namespace houghstream::world
