#include "detector/voting.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

/// The class's entry in each tree's leaf for this patch; -1 where the leaf does not know it.
void find_entries(const Forest& forest, int class_index, const std::int32_t* leaves,
                  std::vector<std::int64_t>& entries) {
  for (std::size_t tree = 0; tree < entries.size(); ++tree) {
    entries[tree] = -1;
    const auto leaf = static_cast<std::size_t>(leaves[tree]);
    for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
      if (forest.leaf_classes[e].class_index == class_index) entries[tree] = e;
    }
  }
}

/// Appends the patch's votes whose centre is seen inside the image; `cells` gets the cell of each.
void cast_from_patch(const Forest& forest, const Eigen::Vector3f& point, std::uint32_t patch,
                     const std::vector<std::int64_t>& entries, const Camera& camera, const HoughSpace& space,
                     std::vector<Vote>& votes, std::vector<std::uint32_t>& cells) {
  const Eigen::Matrix3f R_camera_ray = ray_rotation(point);
  const float share = 1.0F / static_cast<float>(entries.size());
  for (const std::int64_t e : entries) {
    if (e < 0) continue;
    const LeafClass& entry = forest.leaf_classes[static_cast<std::size_t>(e)];
    for (std::uint32_t v = entry.first_vote; v < entry.first_vote + entry.vote_count; ++v) {
      const LeafVote& leaf_vote = forest.votes[v];
      const Eigen::Vector3f centre = point + R_camera_ray * leaf_vote.offset;
      if (centre.z() < 0.1F) continue;
      const Eigen::Vector2d px = camera.project(centre.cast<double>());
      const int x = static_cast<int>(std::floor((px.x() + 0.5) / space.cell_px));
      const int y = static_cast<int>(std::floor((px.y() + 0.5) / space.cell_px));
      if (x < 0 || y < 0 || x >= space.width || y >= space.height) continue;
      votes.push_back({centre, entry.probability * leaf_vote.weight * share, patch, static_cast<std::uint32_t>(e)});
      cells.push_back(static_cast<std::uint32_t>(y * space.width + x));
    }
  }
}

/// Counting sort: stable, so the order does not depend on anything but the votes.
void sort_by_cell(const std::vector<Vote>& votes, const std::vector<std::uint32_t>& cells, HoughSpace& space) {
  space.first_vote.assign(static_cast<std::size_t>(space.width * space.height) + 1, 0);
  for (const std::uint32_t cell : cells) ++space.first_vote[cell + 1];
  for (std::size_t c = 1; c < space.first_vote.size(); ++c) space.first_vote[c] += space.first_vote[c - 1];
  std::vector<std::uint32_t> next(space.first_vote.begin(), space.first_vote.end() - 1);
  space.votes.resize(votes.size());
  for (std::size_t v = 0; v < votes.size(); ++v) space.votes[next[cells[v]]++] = votes[v];
}

void fill_image(double sigma_px, HoughSpace& space) {
  space.image.assign(static_cast<std::size_t>(space.width * space.height), 0.0F);
  for (std::size_t c = 0; c < space.image.size(); ++c) {
    for (std::uint32_t v = space.first_vote[c]; v < space.first_vote[c + 1]; ++v)
      space.image[c] += space.votes[v].weight;
  }
  cv::Mat image(space.height, space.width, CV_32FC1, space.image.data());
  const double sigma = sigma_px / space.cell_px;
  cv::GaussianBlur(image, image, cv::Size(0, 0), sigma, sigma, cv::BORDER_CONSTANT);
}

}  // namespace

std::vector<float> class_probabilities(const Forest& forest, const std::vector<std::int32_t>& leaves, int threads) {
  const std::size_t trees = forest.roots.size();
  const std::size_t classes = forest.classes.size();
  const std::size_t patches = leaves.size() / trees;
  std::vector<float> probabilities(patches * classes, 0.0F);
  constexpr std::size_t kBand = 1024;
  parallel_for(threads, static_cast<int>((patches + kBand - 1) / kBand), [&](int band) {
    const std::size_t begin = static_cast<std::size_t>(band) * kBand;
    for (std::size_t p = begin; p < std::min(begin + kBand, patches); ++p) {
      float* sums = probabilities.data() + p * classes;
      for (std::size_t tree = 0; tree < trees; ++tree) {
        const auto leaf = static_cast<std::size_t>(leaves[p * trees + tree]);
        for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
          sums[forest.leaf_classes[e].class_index] += forest.leaf_classes[e].probability;
        }
      }
      for (std::size_t c = 0; c < classes; ++c) sums[c] /= static_cast<float>(trees);
    }
  });
  return probabilities;
}

PatchLeaves classify(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                     const DetectionSettings& settings) {
  PatchLeaves found;
  found.leaves = settings.readable ? assign_leaves_readably(forest, features, patches)
                                   : assign_leaves(forest, features, patches, settings.threads);
  found.probabilities = class_probabilities(forest, found.leaves, settings.threads);
  return found;
}

HoughSpace cast_votes(const Forest& forest, int class_index, const PatchGrid& patches, const PatchLeaves& leaves,
                      const Camera& working_camera, const DetectionSettings& settings) {
  HoughSpace space;
  space.cell_px = 2;
  space.width = (working_camera.width + space.cell_px - 1) / space.cell_px;
  space.height = (working_camera.height + space.cell_px - 1) / space.cell_px;
  std::vector<Vote> votes;
  std::vector<std::uint32_t> cells;
  std::vector<std::int64_t> entries(forest.roots.size());
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    const std::size_t belief = p * forest.classes.size() + static_cast<std::size_t>(class_index);
    if (leaves.probabilities[belief] < settings.min_class_share) continue;
    find_entries(forest, class_index, leaves.leaves.data() + p * entries.size(), entries);
    cast_from_patch(forest, patches.point_camera[p], p, entries, working_camera, space, votes, cells);
  }
  sort_by_cell(votes, cells, space);
  fill_image(settings.hough_sigma_px, space);
  return space;
}

}  // namespace houghstream
