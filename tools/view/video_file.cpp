#include "tools/view/video_file.hpp"

#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {

VideoFile::VideoFile(std::filesystem::path file, double rate_hz) : file_(std::move(file)), rate_hz_(rate_hz) {}

void VideoFile::open(const cv::Mat& picture) {
  const int codec = cv::VideoWriter::fourcc('a', 'v', 'c', '1');
  const bool opened = writer_.open(file_.string(), cv::CAP_FFMPEG, codec, rate_hz_, picture.size());
  require(opened, "{}: cannot be written as H.264 video (folder missing, or OpenCV without FFmpeg)", file_.string());
}

void VideoFile::add(const cv::Mat& picture, std::int64_t slot) {
  if (last_.empty()) {
    open(picture);
    first_slot_ = slot;
  }
  require(last_.empty() || picture.size() == last_.size(), "{}: picture of {}x{} in a video of {}x{}", file_.string(),
          picture.cols, picture.rows, last_.cols, last_.rows);
  while (!last_.empty() && frames_written_ < slot - first_slot_) {
    writer_.write(last_);
    ++frames_written_;
  }
  writer_.write(picture);
  ++frames_written_;
  last_ = picture.clone();
}

}  // namespace houghstream::view
