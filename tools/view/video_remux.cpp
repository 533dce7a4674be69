#include "tools/view/video_remux.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {
namespace {

constexpr int kTicksPerFrame = 1000;  // what a rate of 0.1 Hz and more is counted in

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

/// The time of a frame in the output's units.
std::int64_t at_rate(double frame, const AVStream& stream, double rate_hz) {
  return std::llround(frame / (rate_hz * av_q2d(stream.time_base)));
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

}  // namespace houghstream::view
