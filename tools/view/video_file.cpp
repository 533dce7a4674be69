#include "tools/view/video_file.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/recording_log.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "tools/view/video_remux.hpp"

namespace houghstream::view {
namespace {

// FFmpeg's writer tells nobody that the disk is full.
std::int64_t frames_in(const std::filesystem::path& video) {
  const cv::VideoCapture written(video.string(), cv::CAP_FFMPEG);
  return written.isOpened() ? std::llround(written.get(cv::CAP_PROP_FRAME_COUNT)) : 0;
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

/// Formats whose index comes last: without it nothing of them can be played.
bool needs_end(const std::filesystem::path& file) {
  const std::string ending = lower_extension(file);
  return ending == ".mp4" || ending == ".m4v" || ending == ".mov";
}

/// FFmpeg chooses the format by it; these may hold H.264.
bool is_video_name(const std::filesystem::path& file) {
  const std::string ending = lower_extension(file);
  return needs_end(file) || ending == ".mkv" || ending == ".avi";
}

// H.264 wants even sides, and its encoders refuse very long ones. The first picture may be of a single row or column of
// pixels; those after it must be legible all the same.
cv::Size video_size(const cv::Size& picture) {
  constexpr int kMaxSide = 8192;  // pixels
  constexpr int kMaxAspect = 8;
  const int longer = std::max(picture.width, picture.height);
  const double scale = std::min(1.0, 1.0 * kMaxSide / longer);
  const int shortest = static_cast<int>(scale * longer) / kMaxAspect;
  const auto side = [&](int side_px) { return std::max({static_cast<int>(scale * side_px), shortest, 2}) / 2 * 2; };
  return {side(picture.width), side(picture.height)};
}

}  // namespace

VideoFile::VideoFile(std::filesystem::path file, double rate_hz, Existing existing)
    : file_(std::move(file)), existing_(existing), rate_hz_(rate_hz) {
  require(is_video_name(file_), "{}: no name of a video, expected one that ends with .mp4", file_.string());
  require_writable(file_);
}

void VideoFile::open(const cv::Mat& picture) {
  whole_.emplace(file_, ".partial" + (needs_end(file_) ? ".mkv" : file_.extension().string()), existing_);
  log_recording_names(*whole_);
  const int codec = cv::VideoWriter::fourcc('a', 'v', 'c', '1');
  size_ = video_size(picture.size());
  const bool opened = writer_.open(whole_->partial().string(), cv::CAP_FFMPEG, codec, rate_hz_, size_);
  require(opened, "{}: cannot be written as H.264 video (OpenCV without FFmpeg, or FFmpeg without H.264)",
          file_.string());
}

cv::Mat VideoFile::fitted(const cv::Mat& picture) const {
  if (picture.size() == size_) return picture.clone();
  const double scale = std::min(1.0 * size_.width / picture.cols, 1.0 * size_.height / picture.rows);
  const cv::Size inner(std::clamp(cvRound(scale * picture.cols), 1, size_.width),
                       std::clamp(cvRound(scale * picture.rows), 1, size_.height));
  cv::Mat out = cv::Mat::zeros(size_, picture.type());
  cv::Mat place = out(cv::Rect({(size_.width - inner.width) / 2, (size_.height - inner.height) / 2}, inner));
  cv::resize(picture, place, inner, 0.0, 0.0, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
  return out;
}

void VideoFile::add(const cv::Mat& picture, std::int64_t slot) {
  if (last_.empty()) {
    open(picture);
    first_slot_ = slot;
  }
  const cv::Mat fitting = fitted(picture);
  // Who is asked to end does not fill a gap of hours first.
  constexpr double kLongGapS = 10.0;
  const auto is_given_up = [&] {
    return stop_requested() && static_cast<double>(slot - first_slot_ - frames_written_) > kLongGapS * rate_hz_;
  };
  while (!last_.empty() && frames_written_ < slot - first_slot_ && !is_given_up()) {
    writer_.write(last_);
    ++frames_written_;
  }
  writer_.write(fitting);
  ++frames_written_;
  last_ = fitting;
}

// The frames are in a format that needs no end; the one that was asked for is made of it, and takes its place.
void VideoFile::complete() {
  std::optional<AtomicFile> remuxed;
  if (needs_end(file_)) {
    remuxed.emplace(whole_->partial(), lower_extension(file_));
    remux_video(whole_->partial(), remuxed->partial(), rate_hz_);
  }
  const std::int64_t frames = frames_in(remuxed ? remuxed->partial() : whole_->partial());
  require(frames == frames_written_,
          "{}: the video holds {} frames, expected the {} that were drawn; is the disk full?", file_.string(), frames,
          frames_written_);
  if (remuxed) remuxed->publish();
  whole_->publish();
}

void VideoFile::finish() {
  if (!whole_) return;
  const auto start = std::chrono::steady_clock::now();
  log_info("{}: the end of the video is being written", whole_->file().string());
  writer_.release();
  try {
    complete();
  } catch (const InputError& error) {
    whole_->keep();  // what was seen cannot be had again
    fail("{}; what could be written stays in {}", error.what(), whole_->partial().string());
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  log_info("{}: the video is whole, {} frames; its end took {:.1f} s", whole_->file().string(), frames_written_,
           took.count());
  whole_.reset();
}

}  // namespace houghstream::view
