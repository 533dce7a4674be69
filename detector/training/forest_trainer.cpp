#include "detector/training/forest_trainer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <set>

#include "detector/training/hard_negatives.hpp"
#include "detector/training/score_training.hpp"
#include "detector/training/tree_trainer.hpp"
#include "detector/training/vote_mass.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/heap_memory.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::training {
namespace {

std::int32_t moved(std::int32_t child, std::int32_t first_node, std::int32_t first_leaf) {
  return child >= 0 ? child + first_node : child - first_leaf;
}

/// Makes a forest with the settings of a profile; classes, views and trees follow.
Forest without_trees(const Profile& profile) {
  Forest forest;
  forest.profile = profile.name;
  forest.features = profile.features;
  forest.patch = profile.patch;
  forest.scoring = profile.training.scoring;
  forest.seed = profile.training.seed;
  forest.leaves.push_back(0);
  return forest;
}

/// Appends a tree grown on its own, moving its indices behind those already there.
void append_tree(const Forest& tree, Forest& forest) {
  const auto first_node = static_cast<std::int32_t>(forest.nodes.size());
  const auto first_leaf = static_cast<std::int32_t>(forest.leaves.size()) - 1;
  const auto first_class = static_cast<std::uint32_t>(forest.leaf_classes.size());
  forest.roots.push_back(moved(tree.roots.at(0), first_node, first_leaf));
  for (TreeNode node : tree.nodes) {
    node.left = moved(node.left, first_node, first_leaf);
    node.right = moved(node.right, first_node, first_leaf);
    forest.nodes.push_back(node);
  }
  forest.leaf_weights.insert(forest.leaf_weights.end(), tree.leaf_weights.begin(), tree.leaf_weights.end());
  for (std::size_t l = 1; l < tree.leaves.size(); ++l) forest.leaves.push_back(tree.leaves[l] + first_class);
  forest.leaf_classes.insert(forest.leaf_classes.end(), tree.leaf_classes.begin(), tree.leaf_classes.end());
  forest.votes.insert(forest.votes.end(), tree.votes.begin(), tree.votes.end());
  forest.leaf_views.insert(forest.leaf_views.end(), tree.leaf_views.begin(), tree.leaf_views.end());
}

void append_trees(std::vector<Forest> trees, Forest& forest) {
  for (Forest& tree : trees) {
    append_tree(tree, forest);
    tree = {};
  }
}

/// Returns whether scores are learnt; where nothing is composed, the score keeps its prior weights.
bool learns_scores(const TrainingSettings& settings) {
  return settings.scoring == Scoring::kEvidence && settings.validation_frames > 0;
}

/// Split of the views between trees and score: the score must not learn from backgrounds that the trees have memorised.
struct TrainingSplit {
  std::vector<const TrainingView*> objects;
  std::vector<const TrainingView*> for_trees;  ///< objects and rooms
  std::vector<const TrainingView*> for_score;  ///< rooms
};

TrainingSplit split_views(const std::vector<TrainingView>& views, const TrainingSettings& settings) {
  constexpr std::size_t kFew = 6;  // rooms for the score, of which trees need twice as many
  const auto is_background = [](const TrainingView& view) { return view.class_id == 0; };
  const auto all = static_cast<std::size_t>(std::count_if(views.begin(), views.end(), is_background));
  const std::size_t every = std::clamp<std::size_t>(all / kFew, 3, 6);
  const bool learns_score = learns_scores(settings);
  TrainingSplit training_split;
  std::size_t count = 0;
  for (const TrainingView& view : views) {
    const bool is_without_objects = is_background(view);
    const bool for_score = is_without_objects && learns_score && ++count % every == 0;
    if (!is_without_objects) training_split.objects.push_back(&view);
    (for_score ? training_split.for_score : training_split.for_trees).push_back(&view);
  }
  if (!learns_score || !training_split.for_score.empty()) return training_split;
  for (const TrainingView& view : views) {  // too few to share
    if (view.class_id == 0) training_split.for_score.push_back(&view);
  }
  return training_split;
}

/// Grows the trees. `old` is a forest whose trees continue to grow, or nullptr.
std::vector<Forest> grow_trees(const TrainingSet& set, const Profile& profile, const Forest* old,
                               const Progress& progress) {
  const TrainingSettings& settings = profile.training;
  std::vector<Forest> trees(static_cast<std::size_t>(settings.trees));
  std::mutex progress_mutex;
  int done = 0;
  const auto begin = std::chrono::steady_clock::now();
  parallel_for(settings.threads, settings.trees, [&](int t) {
    Forest& tree = trees[static_cast<std::size_t>(t)];
    tree = old != nullptr ? regrow_tree(set, profile.patch, settings, t, *old)
                          : grow_tree(set, profile.patch, settings, t);
    const std::lock_guard lock(progress_mutex);
    ++done;
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    const double left_s = taken.count() / done * (settings.trees - done);
    progress(fmt::format("tree {} of {}: {} leaves{}", done, settings.trees, tree.leaves.size() - 1,
                         left_s > 0.0 ? fmt::format(", about {:.0f} s for those that are left", left_s) : ""));
  });
  return trees;
}

/// Tells about every tenth of both sources' frames as they are asked for, from several threads.
class Counted {
 public:
  Counted(int count, const Progress& progress) : count_(count), progress_(progress) {}

  ValidationSource through(const ValidationSource& source) {
    return {source.count, [this, compose = source.frame](int index) {
              tell();
              return compose(index);
            }};
  }

 private:
  void tell() {
    const std::lock_guard lock(mutex_);
    ++asked_;
    if (asked_ * 10 / count_ > (asked_ - 1) * 10 / count_)
      progress_(fmt::format("score: {} of {} composed pictures", asked_, count_));
  }

  int count_;
  const Progress& progress_;
  std::mutex mutex_;
  int asked_ = 0;
};

/// Learns the scores of objects whose views are the last of the forest's.
void learn_scores(const TrainingSplit& training_split, const Profile& profile, const Scales& scales,
                  const Progress& progress, Forest& forest) {
  std::set<int> class_ids;
  for (const TrainingView* view : training_split.objects) class_ids.insert(view->class_id);
  const auto first_view = static_cast<std::uint32_t>(forest.views.size() - training_split.objects.size());
  const ValidationSource plain = composed_frames(training_split.objects, training_split.for_score, profile.training);
  const ValidationSource hard_negatives =
      compose_hard_negative_frames(training_split.objects, training_split.for_score, profile.training);
  Counted counted(plain.count + hard_negatives.count, progress);
  const auto examples = [&](const ValidationSource& source) {
    return find_score_examples(counted.through(source), first_view, profile, forest, scales);
  };
  fit_scores(examples(plain), class_ids, forest);
  scale_log_odds(examples(hard_negatives), class_ids, forest);
  progress(fmt::format("score from {} composed pictures of {} rooms", plain.count + hard_negatives.count,
                       training_split.for_score.size()));
}

/// Makes the set that trees learn from. Views that the score does not need are freed as soon as they are in it.
TrainingSet make_set(const TrainingSplit& training_split, const Profile& profile, const Scales& scales,
                     std::vector<TrainingView>& views) {
  const bool keep = learns_scores(profile.training);
  const ImageInput input{profile.features, profile.patch, profile.training, scales};
  TrainingSet set = make_training_set(training_split.for_trees, input, [&](const TrainingView* done) {
    if (keep) return;
    TrainingView& view = views[static_cast<std::size_t>(done - views.data())];
    view.frame.colour.release();
    view.frame.depth.release();
    view.mask.release();
  });
  return_freed_memory();
  return set;
}

std::string set_summary(const TrainingSet& set) {
  return fmt::format("{} patches of {} pictures ({:.0f} MB)", set.samples.size(), set.images,
                     1e-6 * static_cast<double>(set.held_bytes()));
}

/// Gives the views class numbers that the forest has not used yet. Throws InputError for a name that it knows.
void number_after(const Forest& old, std::vector<TrainingView>& views) {
  int largest = 0;
  for (const ObjectClass& known : old.classes) largest = std::max(largest, known.class_id);
  for (TrainingView& view : views) {
    if (view.class_id == 0) continue;
    for (const ObjectClass& known : old.classes) {
      require(known.name != view.class_name, "{}: the forest knows '{}' already, expected a new object", view.source,
              view.class_name);
    }
    view.class_id += largest;
  }
}

/// Leaves name views by numbers of 16 bits.
void require_nameable_views(std::size_t count) {
  require(count <= LeafView::kMaxViews, "{} views of objects, expected at most {} in one forest", count,
          LeafView::kMaxViews);
}

void check_profile(const Profile& profile, const Scales& scales) {
  const std::string source = fmt::format("profile '{}'", profile.name);
  scales.require_teachable(profile.features, source);
  check_settings(profile.features, source + ": features");
  check_settings(profile.patch, source + ": patch");
  check_settings(profile.training, source + ": training");
}

}  // namespace

Forest train_forest(std::vector<TrainingView> views, const Profile& profile, const Progress& progress,
                    const Scales& scales) {
  check_profile(profile, scales);
  const TrainingSettings& settings = profile.training;
  const TrainingSplit training_split = split_views(views, settings);
  require_nameable_views(training_split.objects.size());
  TrainingSet set = make_set(training_split, profile, scales, views);
  progress(fmt::format("{}, {} classes, {} planes", set_summary(set), set.classes.size(), set.layout.planes()));
  const std::size_t before = set.samples.size();
  add_hard_negatives(profile.patch, settings, set);
  progress(fmt::format("{} background patches added that scout trees mistook", set.samples.size() - before));

  Forest forest = without_trees(profile);
  forest.classes = set.classes;
  forest.views = std::move(set.views);
  append_trees(grow_trees(set, profile, nullptr, progress), forest);
  estimate_nominal_vote_mass(set, settings, profile.detection.voting.vote_sigma, forest);
  if (learns_scores(settings)) learn_scores(training_split, profile, scales, progress, forest);
  return forest;
}

Forest add_objects(const Forest& old, std::vector<TrainingView> views, const Profile& profile, const Progress& progress,
                   const Scales& scales) {
  check_profile(profile, scales);
  require(profile.training.trees == static_cast<int>(old.roots.size()),
          "adding objects: {} trees, expected the forest's {}", profile.training.trees, old.roots.size());
  number_after(old, views);
  const TrainingSplit training_split = split_views(views, profile.training);
  require_nameable_views(old.views.size() + training_split.objects.size());
  TrainingSet set = make_set(training_split, profile, scales, views);
  set.negative_pool = {};  // the old trees have learnt what is mistaken
  drop_unread_pixels(profile.patch, set);
  set.first_class = static_cast<std::uint16_t>(old.classes.size());
  set.first_view = static_cast<std::uint32_t>(old.views.size());
  progress(fmt::format("{}, {} new classes beside {}", set_summary(set), set.classes.size(), old.classes.size()));
  Forest forest = without_trees(profile);
  forest.seed = old.seed;
  forest.classes = old.classes;
  forest.classes.insert(forest.classes.end(), set.classes.begin(), set.classes.end());
  forest.views = old.views;
  for (ViewTemplate& view : set.views) {
    view.class_index += set.first_class;
    forest.views.push_back(std::move(view));
  }
  append_trees(grow_trees(set, profile, &old, progress), forest);
  rescale_nominal_vote_mass(old, forest);
  estimate_nominal_vote_mass(set, profile.training, profile.detection.voting.vote_sigma, forest);
  if (learns_scores(profile.training)) learn_scores(training_split, profile, scales, progress, forest);
  return forest;
}

Profile profile_of(const Forest& forest) {
  return profile_of(forest, make_profile(forest.profile));
}

Profile profile_of(const Forest& forest, Profile named) {
  named.features = forest.features;
  named.patch = forest.patch;
  named.training.scoring = forest.scoring;
  named.training.trees = static_cast<int>(forest.roots.size());
  return named;
}

}  // namespace houghstream::training
