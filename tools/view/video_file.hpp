#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <optional>

#include "pipeline/base/files.hpp"

namespace houghstream::view {

/// Writes the video of one file into another, whose name determines the format, without encoding it again. Its frames
/// get the times of a constant rate, which a format that counts milliseconds has rounded. Throws InputError where one
/// of the two cannot be read or written.
void remux_video(const std::filesystem::path& from, const std::filesystem::path& to, double rate_hz);

/// Writes an MP4 with H.264, which every browser plays, at a constant rate. Until it is finished the frames are in a
/// FILE.mp4.partial.mkv, which can be played however the program ends, but for the last hundred frames or so: an MP4
/// without its end cannot. An image belongs to a slot of 1/rate seconds; a slot without an image repeats the one
/// before, so that the video lasts as long as the stream did; but once the program is asked to end, a gap of more than
/// ten seconds is left out.
class VideoFile {
 public:
  /// Throws InputError where the file's name is not that of a video, or it cannot be written.
  VideoFile(std::filesystem::path file, double rate_hz, Existing existing = Existing::kReplaced);

  /// Slots must grow. The video has the size of the first image, made even in both directions; one of another size
  /// (the camera's mode has changed) is fitted into it. Throws InputError when the file cannot be written.
  void add(const cv::Mat& image, std::int64_t slot);

  /// Ends the video, commits it (AtomicFile), and logs how long that took. Throws InputError where it does not hold all
  /// frames, as on a full disk; an earlier file stays, and so does the part that could be written, under the name in
  /// the error.
  void finish();

  std::int64_t frames_written() const { return frames_written_; }

 private:
  void open(const cv::Mat& image);
  cv::Mat fitted(const cv::Mat& image) const;
  void complete();

  std::filesystem::path file_;
  Existing existing_;
  std::optional<AtomicFile> whole_;
  double rate_hz_;
  cv::VideoWriter writer_;
  cv::Size size_;
  cv::Mat last_;
  std::int64_t first_slot_ = 0;
  std::int64_t frames_written_ = 0;
};

}  // namespace houghstream::view
