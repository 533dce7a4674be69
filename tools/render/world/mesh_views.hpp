#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/base/random.hpp"
#include "pipeline/types/training_view.hpp"
#include "tools/render/world/objects/asset.hpp"

namespace houghstream::world {

/// In which attitudes a mesh is shown.
enum class MeshAttitudes : std::uint8_t {
  kResting,  ///< as it comes to rest on a table, and leaning from there
  kUpright,  ///< its z axis up
  kAny       ///< all rotations alike, as if held
};

/// "resting", "upright" or "any". Throws InputError naming them for another.
MeshAttitudes parse_mesh_attitudes(const std::string& name);

/// Which directions of the object (unit length, object frame) point up in these attitudes: what stands firmest first,
/// such as differ clearly. The sides of the bounding box for a mesh that does not rest, or encloses nothing that could
/// weigh; none for kAny.
std::vector<Eigen::Vector3d> up_directions(const Mesh& mesh, MeshAttitudes attitudes);

/// Evenly distributed over all rotations (Shoemake, "Uniform random rotations", Graphics Gems III, 1992).
Eigen::Matrix3d random_rotation(Random& random);

struct MeshViewSettings {
  MeshAttitudes attitudes = MeshAttitudes::kResting;
  int views_per_attitude = 400;  ///< of each way of resting, all round and from low to high; fewer where there are many
  int max_views = 2200;          ///< of one object; so many are shown of kAny
  double lowest_pitch_deg = 12.0;  ///< of the camera over the level
  double highest_pitch_deg = 80.0;
  double distance_m = 0.7;        ///< camera to object; more where it would not fit the image
  double leaning_fraction = 0.2;  ///< of the views of kResting
  bool has_colour = true;         ///< false: another plain colour in every view
};

/// A mesh as it is rendered: with colour unknown, plain grey. Its symmetries do not matter. See MeshViews for what it
/// must have.
AssetPtr make_taught_thing(Mesh mesh, bool has_colour);

/// The thing, whose vertices have colours, in one colour.
AssetPtr plainly_painted(const Asset& thing, Random& random);

/// Training views of a mesh: each in a light of its own, as a structured-light camera sees it. Neither axis nor origin
/// of the mesh mean anything. Same arguments, same views; const calls are thread-safe.
class MeshViews {
 public:
  /// `mesh` has metres, triangles, normals, and a texture or a colour per vertex unless has_colour is false.
  MeshViews(Mesh mesh, const MeshViewSettings& settings, std::uint64_t seed);

  int count() const { return static_cast<int>(poses_.size()); }
  /// See up_directions().
  const std::vector<Eigen::Vector3d>& ups() const { return ups_; }
  const AssetPtr& thing() const { return thing_; }

  /// View `index`, cropped around the object; names, ids and source are left empty.
  TrainingView render(int index) const;

 private:
  struct ViewPose {
    Eigen::Matrix3d R_level_object = Eigen::Matrix3d::Identity();  ///< into a frame with z up
    double pitch_rad = 0.0;
    double roll_rad = 0.0;  ///< of the camera about its line of sight
    bool on_table = false;
  };

  void add_level_views();
  void add_any_views();

  MeshViewSettings settings_;
  std::uint64_t seed_;
  AssetPtr thing_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  ///< of the bounding box
  double radius_ = 0.0;                               ///< of the sphere about it, metres
  std::vector<Eigen::Vector3d> ups_;
  std::vector<ViewPose> poses_;
};

}  // namespace houghstream::world
