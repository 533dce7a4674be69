#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>

#include "tools/view/video_file.hpp"

namespace houghstream::view {

/// Outputs of images without a display; a file with an empty path is not written.
struct OutputSettings {
  std::filesystem::path snapshot;   ///< file for one image, PNG or JPEG by its ending
  std::int64_t snapshot_after = 1;  ///< the Nth image drawn; the last one where the stream ends before
  std::filesystem::path video;      ///< MP4
  std::filesystem::path images;     ///< folder for every image drawn, UTIME.jpg
  double rate_hz = 10.0;            ///< rate of the video
  bool replace = false;             ///< replaces files that are there, instead of taking the next number
};

/// Writes images to files.
class ViewOutputs {
 public:
  /// Makes the folders. Throws InputError where that fails, or a file that is wanted cannot be written.
  explicit ViewOutputs(OutputSettings settings);

  void add(const cv::Mat& image, std::int64_t utime, std::int64_t slot);

  /// Writes a snapshot that did not come to its turn. Throws InputError when there was no image at all.
  void finish();

  /// Returns whether everything requested has been written: a snapshot alone needs no more images.
  bool complete() const;

 private:
  std::filesystem::path name_for(const std::filesystem::path& wanted) const;
  void save_snapshot(const cv::Mat& image);

  OutputSettings settings_;
  std::unique_ptr<VideoFile> video_;
  cv::Mat last_;
  std::int64_t added_ = 0;
  bool snapshot_written_ = false;
};

/// Writes an image; throws InputError where that fails.
void save_image(const std::filesystem::path& file, const cv::Mat& image);

}  // namespace houghstream::view
