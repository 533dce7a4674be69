#include "detector/training/object_removal.hpp"

#include <algorithm>
#include <vector>

#include "detector/training/vote_mass.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::training {
namespace {

std::size_t class_index_of(const Forest& forest, const std::string& name) {
  std::vector<std::string> names;
  for (const ObjectClass& object : forest.classes) names.push_back(object.name);
  const auto found = std::find(names.begin(), names.end(), name);
  require(found != names.end(), "the forest: no '{}', expected one of {}", name, fmt::join(names, ", "));
  require(names.size() > 1, "'{}' is the forest's only object, expected another one to remain", name);
  return static_cast<std::size_t>(found - names.begin());
}

/// Ratio between the objects' weight in a tree's leaves and that of one object: equal for all objects.
struct Shares {
  float object = 0.0F;      ///< fraction of all that a tree learnt from
  float background = 0.0F;  ///< over the object's
};

Shares measure_shares(const Forest& forest) {
  double objects = 0.0;
  for (std::size_t l = 0; l + 1 < forest.leaves.size(); ++l) {
    for (std::uint32_t e = forest.leaves[l]; e < forest.leaves[l + 1]; ++e)
      objects += static_cast<double>(forest.leaf_weights[l]) * static_cast<double>(forest.leaf_classes[e].probability);
  }
  const double one = objects / static_cast<double>(forest.roots.size() * forest.classes.size());
  const double all = objects / static_cast<double>(forest.roots.size());
  return {static_cast<float>(one), one > 0.0 ? static_cast<float>(std::max(0.0, 1.0 - all) / one) : 0.0F};
}

/// Copies views of the objects that remain, and returns each view's new number.
std::vector<std::uint32_t> keep_views(const Forest& from, std::size_t removed, Forest& to) {
  std::vector<std::uint32_t> numbers;
  for (ViewTemplate view : from.views) {
    numbers.push_back(static_cast<std::uint32_t>(to.views.size()));
    if (view.class_index == removed) continue;
    if (view.class_index > removed) --view.class_index;
    to.views.push_back(view);
  }
  return numbers;
}

/// Appends an entry with its votes and views, which start in `from` at `start`.
void keep_entry(const Forest& from, const LeafClass& entry, const LeafStart& start,
                const std::vector<std::uint32_t>& view_numbers, Forest& to) {
  const auto votes = from.votes.begin() + start.vote;
  to.votes.insert(to.votes.end(), votes, votes + entry.vote_count);
  for (std::uint32_t v = start.view; v < start.view + entry.view_count; ++v)
    to.leaf_views.push_back(
        {static_cast<std::uint16_t>(view_numbers[from.leaf_views[v].view]), from.leaf_views[v].weight});
  to.leaf_classes.push_back(entry);
}

/// Change of the leaves.
struct Removal {
  std::size_t object = 0;                   ///< index of its class
  float of_background = 1.0F;               ///< weight of the background, over its weight before
  float whole = 1.0F;                       ///< weight of all that remains in a tree, over that of all before
  std::vector<std::uint32_t> view_numbers;  ///< new numbers by old number
};

/// Appends a leaf without the object. `start` is the leaf's, and moves on to the next one's.
void keep_leaf(const Forest& from, std::size_t leaf, const Removal& removal, LeafStart& start, Forest& to) {
  const std::size_t first = to.leaf_classes.size();
  float known = 0.0F;
  float kept = 0.0F;
  for (std::uint32_t e = from.leaves[leaf]; e < from.leaves[leaf + 1]; ++e) {
    const LeafClass& entry = from.leaf_classes[e];
    known += entry.probability;
    if (entry.class_index != removal.object) {
      kept += entry.probability;
      keep_entry(from, entry, start, removal.view_numbers, to);
    }
    start.pass(entry);
  }
  const float total = kept + removal.of_background * std::max(0.0F, 1.0F - known);
  for (std::size_t e = first; e < to.leaf_classes.size(); ++e) {
    LeafClass& entry = to.leaf_classes[e];
    if (entry.class_index > removal.object) --entry.class_index;
    entry.probability = total > 0.0F ? std::min(entry.probability / total, 1.0F) : 0.0F;
  }
  to.leaf_weights.push_back(from.leaf_weights[leaf] * total / removal.whole);
  to.leaves.push_back(static_cast<std::uint32_t>(to.leaf_classes.size()));
}

/// Copies the members other than leaves and views.
Forest without_leaves(const Forest& forest, std::size_t removed) {
  Forest out;
  out.profile = forest.profile;
  out.features = forest.features;
  out.patch = forest.patch;
  out.scoring = forest.scoring;
  out.seed = forest.seed;
  out.classes = forest.classes;
  out.classes.erase(out.classes.begin() + static_cast<std::ptrdiff_t>(removed));
  out.roots = forest.roots;
  out.nodes = forest.nodes;
  out.leaves.push_back(0);
  return out;
}

}  // namespace

Forest remove_object(const Forest& forest, const std::string& name) {
  Removal removal;
  removal.object = class_index_of(forest, name);
  const Shares shares = measure_shares(forest);
  const auto remain = static_cast<float>(forest.classes.size() - 1);
  const float background = std::min(shares.background, remain);  // over one object's weight
  if (shares.background > 0.0F) removal.of_background = background / shares.background;
  if (shares.object > 0.0F) removal.whole = shares.object * (remain + background);
  Forest out = without_leaves(forest, removal.object);
  removal.view_numbers = keep_views(forest, removal.object, out);
  LeafStart start;
  for (std::size_t leaf = 0; leaf + 1 < forest.leaves.size(); ++leaf) keep_leaf(forest, leaf, removal, start, out);
  rescale_nominal_vote_mass(forest, out);
  return out;
}

}  // namespace houghstream::training
