#include "detector/baseline/hough_images.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/baseline/scale_space_search.hpp"

namespace houghstream::baseline {
namespace {

cv::Mat largest_over_sizes(const SearchContext& search, int class_index, const RgbdFrame& frame) {
  cv::Mat largest = cv::Mat::zeros(frame.colour.size(), CV_32FC1);
  for (const cv::Mat& image : scale_space_hough_images(search, class_index, frame)) {
    cv::Mat resized;
    cv::resize(image, resized, largest.size(), 0, 0, cv::INTER_LINEAR);
    cv::max(largest, resized, largest);
  }
  return largest;
}

/// Sums the vote mass around each cell, as if by a kernel as wide as vote_sigma at the votes' own distance.
cv::Mat masses_by_cell(const HoughSpace& space, const VotingInput& input) {
  const VotingSettings& settings = input.settings;
  cv::Mat masses = cv::Mat::zeros(space.height, space.width, CV_32FC1);
  const double sigma_at_1m = settings.vote_sigma * input.camera.fx / space.cell_px;
  const auto kernel_at_1m = static_cast<float>(2.0 * M_PI * sigma_at_1m * sigma_at_1m);
  for (int c = 0; c < space.width * space.height; ++c) {
    float& mass = masses.at<float>(c / space.width, c % space.width);
    for (std::uint32_t v = space.first_vote[c]; v < space.first_vote[c + 1]; ++v) {
      const Vote& vote = space.votes[v];
      const float distance = vote.centre_camera.z();
      mass += vote.weight * input.patches.area[space.voters[space.voter_of_vote[v]].patch] * kernel_at_1m /
              (distance * distance);
    }
  }
  const double sigma = static_cast<double>(settings.hough_sigma_px) / space.cell_px;
  cv::GaussianBlur(masses, masses, cv::Size(0, 0), sigma, sigma, cv::BORDER_CONSTANT);
  return masses;
}

/// Returns the image at the frame's size; the last row and column of cells may reach over its border.
cv::Mat at_frame_size(const cv::Mat& cells, int cell_px, const Camera& working_camera, cv::Size frame_size) {
  const auto enlarged = [&](int count, int working, int frame) {
    return static_cast<int>(std::ceil(static_cast<double>(count) * cell_px * frame / working));
  };
  const cv::Size size(enlarged(cells.cols, working_camera.width, frame_size.width),
                      enlarged(cells.rows, working_camera.height, frame_size.height));
  cv::Mat image;
  cv::resize(cells, image, size, 0, 0, cv::INTER_LINEAR);
  return image(cv::Rect(cv::Point(), frame_size)).clone();
}

}  // namespace

cv::Mat hough_image(const SearchContext& search, int class_index, const RgbdFrame& frame) {
  if (search.forest().features.handling == ScaleHandling::kScaleSpace) {
    return largest_over_sizes(search, class_index, frame);
  }
  DetectorWorkspace workspace;
  make_working_images(search, frame, workspace);
  compute_features_by(Way::kFast, search, workspace);
  find_posteriors(search, workspace);
  const VotingInput input = voting_input(search, workspace);
  CastWorkspace memory;
  HoughSpace space;
  cast_votes(input, class_index, memory, space);
  const cv::Mat masses = masses_by_cell(space, input);
  const float expected = search.forest().classes[static_cast<std::size_t>(class_index)].nominal_vote_mass;
  return at_frame_size(masses / expected, space.cell_px, input.camera, frame.colour.size());
}

}  // namespace houghstream::baseline
