#include "detector/voting.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

/// Appends the patch's votes whose centre is seen inside the image; `cells` gets the cell of each.
void cast_from_patch(const Forest& forest, const Eigen::Vector3f& point, std::uint32_t patch,
                     const std::uint32_t* entries, std::uint32_t count, const Camera& camera, const HoughSpace& space,
                     std::vector<Vote>& votes, std::vector<std::uint32_t>& cells) {
  const Eigen::Matrix3f R_camera_ray = ray_rotation(point);
  const float share = 1.0F / static_cast<float>(forest.roots.size());
  for (const std::uint32_t* e = entries; e != entries + count; ++e) {
    const LeafClass& entry = forest.leaf_classes[*e];
    for (std::uint32_t v = entry.first_vote; v < entry.first_vote + entry.vote_count; ++v) {
      const LeafVote& leaf_vote = forest.votes[v];
      const Eigen::Vector3f centre = point + R_camera_ray * leaf_vote.offset;
      if (centre.z() < 0.1F) continue;
      const Eigen::Vector2d px = camera.project(centre.cast<double>());
      const int x = static_cast<int>(std::floor((px.x() + 0.5) / space.cell_px));
      const int y = static_cast<int>(std::floor((px.y() + 0.5) / space.cell_px));
      if (x < 0 || y < 0 || x >= space.width || y >= space.height) continue;
      votes.push_back({centre, entry.probability * leaf_vote.weight * share, patch, *e});
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

HoughSpace cast_votes(const Forest& forest, int class_index, const PatchGrid& patches, const PatchBeliefs& beliefs,
                      const Camera& working_camera, const DetectionSettings& settings) {
  HoughSpace space;
  space.cell_px = 2;
  space.width = (working_camera.width + space.cell_px - 1) / space.cell_px;
  space.height = (working_camera.height + space.cell_px - 1) / space.cell_px;
  std::vector<Vote> votes;
  std::vector<std::uint32_t> cells;
  beliefs.for_believers(class_index, [&](std::uint32_t p, const std::uint32_t* entries, std::uint32_t count) {
    cast_from_patch(forest, patches.point_camera[p], p, entries, count, working_camera, space, votes, cells);
  });
  sort_by_cell(votes, cells, space);
  fill_image(settings.hough_sigma_px, space);
  return space;
}

}  // namespace houghstream
