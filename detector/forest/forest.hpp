#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "detector/features/feature_settings.hpp"
#include "detector/forest/pixel_test.hpp"
#include "detector/forest/score_model.hpp"
#include "detector/forest/view_template.hpp"

namespace houghstream {

/// Kind of a detection's score. Stored in the forest file.
enum class Scoring : std::uint32_t {
  kEvidence = 0,  ///< a calibrated probability from votes and from how view templates fit, see evidence/score.hpp
  kVotes = 1,     ///< vote mass over that of a wholly visible object, at most 1 (the paper's confidence)
};

/// Inner node: a patch that passes the test goes right. A child is the index of a later node of Forest::nodes, or,
/// below 0, leaf number -1 - child.
struct TreeNode {
  PixelTest test;
  std::int32_t left = 0;
  std::int32_t right = 0;
};

/// Vote of a leaf: the object's centre as one of its patches saw it, in the frame of the patch's viewing ray (see
/// ray_rotation), metres.
struct LeafVote {
  Eigen::Vector3f offset;
  float weight = 0.0F;  ///< share of the leaf's probability for the class; a class's votes sum to 1
};

/// A training view that a patch of this leaf came from.
struct LeafView {
  std::uint32_t view = 0;  ///< index into Forest::views
  float weight = 0.0F;
};

/// Statistics of one class in a leaf.
struct LeafClass {
  std::uint32_t first_vote = 0;   ///< index into Forest::votes
  std::uint32_t first_view = 0;   ///< index into Forest::leaf_views
  float probability = 0.0F;       ///< p(class | leaf)
  std::uint16_t class_index = 0;  ///< index into Forest::classes
  std::uint8_t vote_count = 0;
  std::uint8_t view_count = 0;
};

/// A taught object.
struct ObjectClass {
  int class_id = 0;  ///< class id, from 1
  std::string name;
  float radius = 0.0F;             ///< farthest seen surface point from the centre, metres
  float nominal_vote_mass = 1.0F;  ///< vote mass of a wholly visible object, square metres
  ScoreModel score_model;
};

/// A training view as poses and boxes need it.
struct ViewTemplate {
  std::uint32_t class_index = 0;
  /// Relative to the ray through the object's centre. Not aligned: its bytes go to the file without gaps.
  Eigen::Quaternion<float, Eigen::DontAlign> R_ray_object = Eigen::Quaternion<float, Eigen::DontAlign>::Identity();
  /// Left, top, right and bottom of the mask as seen from the object's centre, metres at the centre's depth.
  std::array<float, 4> box{};
  TemplateGrid appearance;
};

/// A trained forest as its file holds it: flat arrays, trees one after another. A ForestIndex is what searches it.
struct Forest {
  std::string profile;  ///< profile that it was trained by, see training/profiles.hpp
  FeatureSettings features;
  PatchSettings patch;
  Scoring scoring = Scoring::kEvidence;
  std::uint64_t seed = 0;
  std::vector<ObjectClass> classes;
  std::vector<ViewTemplate> views;
  std::vector<std::int32_t> roots;  ///< per tree: a node, or -1 - leaf
  std::vector<TreeNode> nodes;
  std::vector<std::uint32_t> leaves;  ///< number of leaves + 1: classes of leaf i are
                                      ///< leaf_classes[leaves[i] .. leaves[i + 1])
  std::vector<float> leaf_weights;    ///< per leaf: share of what its tree learnt from; a tree's sum to 1
  std::vector<LeafClass> leaf_classes;
  std::vector<LeafVote> votes;
  std::vector<LeafView> leaf_views;
};

/// Returns the smallest rotation from the optical axis to a ray: R * (0,0,1) is parallel to the ray.
Eigen::Matrix3f ray_rotation(const Eigen::Vector3f& ray);

/// Walks one patch down one tree: the reference that find_leaves (traversal.hpp) is held against.
std::int32_t find_leaf(const Forest& forest, int tree, const PatchView& patch);

// The names of before, for one release.
using TrainedView [[deprecated("is ViewTemplate now")]] = ViewTemplate;

}  // namespace houghstream
