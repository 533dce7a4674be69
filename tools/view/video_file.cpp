#include "tools/view/video_file.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/recording_log.hpp"
#include "pipeline/base/stop_signal.hpp"

namespace houghstream::view {
namespace {

constexpr int kTicksPerFrame = 1000;  // ticks, which resolve rates of 0.1 Hz and more

struct InputCloser {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
};
struct OutputCloser {
  void operator()(AVFormatContext* context) const {
    avio_closep(&context->pb);
    avformat_free_context(context);
  }
};
struct PacketCloser {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
using Input = std::unique_ptr<AVFormatContext, InputCloser>;
using Output = std::unique_ptr<AVFormatContext, OutputCloser>;

void require_good(int code, const std::filesystem::path& file, const char* what) {
  if (code >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> words{};
  av_strerror(code, words.data(), words.size());
  fail("{}: {}: {}", file.string(), what, words.data());
}

Input open_input(const std::filesystem::path& file) {
  AVFormatContext* context = nullptr;
  require_good(avformat_open_input(&context, file.c_str(), nullptr, nullptr), file, "cannot be read as a video");
  Input input(context);
  require_good(avformat_find_stream_info(context, nullptr), file, "cannot be read as a video");
  require(context->nb_streams == 1, "{}: {} streams, expected one of a video", file.string(), context->nb_streams);
  return input;
}

Output open_output(const std::filesystem::path& file, const AVCodecParameters& video, double rate_hz) {
  AVFormatContext* context = nullptr;
  require_good(avformat_alloc_output_context2(&context, nullptr, nullptr, file.c_str()), file, "no format of a video");
  Output output(context);
  AVStream* stream = avformat_new_stream(context, nullptr);
  require(stream != nullptr && avcodec_parameters_copy(stream->codecpar, &video) >= 0,
          "{}: no memory for another stream", file.string());
  stream->codecpar->codec_tag = 0;  // each format has its own
  stream->time_base = av_d2q(1.0 / (rate_hz * kTicksPerFrame), 1'000'000'000);
  stream->avg_frame_rate = av_d2q(rate_hz, 1'000'000);
  require_good(avio_open(&context->pb, file.c_str(), AVIO_FLAG_WRITE), file, "cannot be written");
  require_good(avformat_write_header(context, nullptr), file, "cannot be written");
  return output;
}

/// Returns the time of a frame in the output's units.
std::int64_t at_rate(double frame, const AVStream& stream, double rate_hz) {
  return std::llround(frame / (rate_hz * av_q2d(stream.time_base)));
}

// Counts the frames of a finished video, since FFmpeg's writer does not report a full disk.
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

/// Returns whether the name is that of a video. FFmpeg chooses the format by the ending; these formats may hold H.264.
bool is_video_name(const std::filesystem::path& file) {
  const std::string ending = lower_extension(file);
  return needs_end(file) || ending == ".mkv" || ending == ".avi";
}

// Returns the size of the video. H.264 needs even sides, and its encoders refuse very long ones. The first image may be
// of a single row or column of pixels; those after it must be legible all the same.
cv::Size video_size(const cv::Size& image) {
  constexpr int kMaxSide = 8192;  // pixels
  constexpr int kMaxAspect = 8;
  const int longer = std::max(image.width, image.height);
  const double scale = std::min(1.0, 1.0 * kMaxSide / longer);
  const int shortest = static_cast<int>(scale * longer) / kMaxAspect;
  const auto side = [&](int side_px) { return std::max({static_cast<int>(scale * side_px), shortest, 2}) / 2 * 2; };
  return {side(image.width), side(image.height)};
}

}  // namespace

void remux_video(const std::filesystem::path& from, const std::filesystem::path& to, double rate_hz) {
  const Input input = open_input(from);
  const AVStream& source = *input->streams[0];
  const Output output = open_output(to, *source.codecpar, rate_hz);
  const AVStream& target = *output->streams[0];
  const std::unique_ptr<AVPacket, PacketCloser> packet(av_packet_alloc());
  require(packet != nullptr, "{}: no memory for a packet", from.string());
  std::int64_t first = AV_NOPTS_VALUE;
  int decoded = 0;
  int read = 0;
  for (; (read = av_read_frame(input.get(), packet.get())) >= 0; ++decoded) {
    if (first == AV_NOPTS_VALUE) first = packet->pts;
    const double shown_s = static_cast<double>(packet->pts - first) * av_q2d(source.time_base);
    packet->pts = at_rate(std::round(shown_s * rate_hz), target, rate_hz);
    // Frames come in the order in which they are decoded, as many before their turn as the encoder has put off.
    packet->dts = at_rate(decoded - source.codecpar->video_delay, target, rate_hz);
    packet->duration = at_rate(1.0, target, rate_hz);
    packet->pos = -1;
    require_good(av_interleaved_write_frame(output.get(), packet.get()), to, "cannot be written");
  }
  require(read == AVERROR_EOF, "{}: ends within a frame", from.string());
  require_good(av_write_trailer(output.get()), to, "cannot be written");
  avio_flush(output->pb);
  require_good(output->pb->error, to, "cannot be written");
}

VideoFile::VideoFile(std::filesystem::path file, double rate_hz, Existing existing)
    : file_(std::move(file)), existing_(existing), rate_hz_(rate_hz) {
  require(is_video_name(file_), "{}: no name of a video, expected one that ends with .mp4, .m4v, .mov, .mkv or .avi",
          file_.string());
  require_writable(file_);
}

void VideoFile::open(const cv::Mat& image) {
  whole_.emplace(file_, ".partial" + (needs_end(file_) ? ".mkv" : file_.extension().string()), existing_);
  log_recording_names(*whole_);
  const int codec = cv::VideoWriter::fourcc('a', 'v', 'c', '1');
  size_ = video_size(image.size());
  const bool opened = writer_.open(whole_->partial().string(), cv::CAP_FFMPEG, codec, rate_hz_, size_);
  require(opened, "{}: cannot be written as H.264 video (OpenCV without FFmpeg, or FFmpeg without H.264)",
          file_.string());
}

cv::Mat VideoFile::fitted(const cv::Mat& image) const {
  if (image.size() == size_) return image.clone();
  const double scale = std::min(1.0 * size_.width / image.cols, 1.0 * size_.height / image.rows);
  const cv::Size inner(std::clamp(cvRound(scale * image.cols), 1, size_.width),
                       std::clamp(cvRound(scale * image.rows), 1, size_.height));
  cv::Mat out = cv::Mat::zeros(size_, image.type());
  cv::Mat place = out(cv::Rect({(size_.width - inner.width) / 2, (size_.height - inner.height) / 2}, inner));
  cv::resize(image, place, inner, 0.0, 0.0, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
  return out;
}

void VideoFile::add(const cv::Mat& image, std::int64_t slot) {
  if (last_.empty()) {
    open(image);
    first_slot_ = slot;
  }
  const cv::Mat fitting = fitted(image);
  // A gap of hours is not filled after a request to end.
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
  if (remuxed) remuxed->commit();
  whole_->commit();
}

void VideoFile::finish() {
  if (!whole_) return;
  const auto start = std::chrono::steady_clock::now();
  log_info("{}: the end of the video is being written", whole_->file().string());
  writer_.release();
  try {
    complete();
  } catch (const InputError& error) {
    whole_->keep_partial();  // the recording cannot be repeated
    fail("{}; what could be written stays in {}", error.what(), whole_->partial().string());
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  log_info("{}: the video is whole, {} frames; its end took {:.1f} s", whole_->file().string(), frames_written_,
           took.count());
  whole_.reset();
}

}  // namespace houghstream::view
