#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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

/// A share of a whole, 0 to 1, in 16 bits: a forest has millions.
class Share {
 public:
  Share() = default;
  explicit Share(float value)
      : steps_(static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) / kStep))) {}
  float value() const { return kStep * static_cast<float>(steps_); }

  static constexpr float kStep = 1.0F / 65535.0F;

 private:
  std::uint16_t steps_ = 0;
};

/// Vote of a leaf: the object's centre as one of its patches saw it, in the frame of the patch's viewing ray (see
/// ray_rotation).
struct LeafVote {
  static constexpr float kStep_m = 1.0F / 16384.0F;      ///< 0.06 mm, far less than a camera measures
  static constexpr float kReach_m = 32767.0F * kStep_m;  ///< maximum of each coordinate of an offset

  LeafVote() = default;
  /// An offset beyond the reach is brought to it.
  LeafVote(const Eigen::Vector3f& offset_m, float weight_of_class);
  Eigen::Vector3f offset() const {
    return kStep_m * Eigen::Map<const Eigen::Matrix<std::int16_t, 3, 1>>(steps.data()).cast<float>();
  }

  std::array<std::int16_t, 3> steps{};  ///< offset in units of kStep_m
  Share weight;  ///< share of the leaf's probability for the class; a class's votes sum to at most 1
};

/// A training view that a patch of this leaf came from.
struct LeafView {
  static constexpr std::size_t kMaxViews = 65536;  ///< maximum number of views of a forest

  std::uint16_t view = 0;  ///< index into Forest::views
  Share weight;
};

/// Statistics of one class in a leaf. Its votes and views follow those of the entry before it, see find_leaf_starts().
struct LeafClass {
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
  std::vector<LeafVote> votes;       ///< in the order of leaf_classes
  std::vector<LeafView> leaf_views;  ///< in the order of leaf_classes
};

/// Where the votes and views of a leaf, or of one of its classes, begin.
struct LeafStart {
  std::uint32_t vote = 0;  ///< index into Forest::votes
  std::uint32_t view = 0;  ///< index into Forest::leaf_views

  /// Moves to the class that follows this one.
  void pass(const LeafClass& entry) {
    vote += entry.vote_count;
    view += entry.view_count;
  }
};

/// Returns the start of each leaf, in their order.
std::vector<LeafStart> find_leaf_starts(const Forest& forest);

/// Returns the smallest rotation from the optical axis to a ray: R * (0,0,1) is parallel to the ray.
Eigen::Matrix3f ray_rotation(const Eigen::Vector3f& ray);

/// Walks one patch down one tree: the reference that find_leaves (traversal.hpp) is held against.
std::int32_t find_leaf(const Forest& forest, int tree, const PatchView& patch);

// The names of before, for one release.
using TrainedView [[deprecated("is ViewTemplate now")]] = ViewTemplate;

}  // namespace houghstream
