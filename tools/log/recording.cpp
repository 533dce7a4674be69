#include "tools/log/recording.hpp"

#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <string_view>

#include "drivers/datasets/open_frame_source.hpp"
#include "drivers/openni/camera_source.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tools/common/progress_line.hpp"
#include "tools/log/klg_file.hpp"
#include "tools/log/message_types.hpp"
#include "tools/log/third_party_frames.hpp"

namespace houghstream::log_tools {
namespace {

bool starts_with(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

/// Returns the file of FILE.KIND or KIND:FILE.
std::optional<std::string> file_of(const std::string& source, const std::string& kind) {
  if (starts_with(source, kind + ":")) return source.substr(kind.size() + 1);
  const std::string end = "." + kind;
  const bool ends_so = source.size() > end.size() && source.compare(source.size() - end.size(), end.size(), end) == 0;
  return ends_so ? std::optional<std::string>(source) : std::nullopt;
}

/// Returns whether the source is KIND:WHERE, as open_frame_source() takes it; the names of files may hold a colon too.
bool is_frame_source(const std::string& source) {
  return source.find(':') != std::string::npos && !std::filesystem::exists(source);
}

/// A format that users take for a readable recording: its first bytes and its name.
struct OtherKind {
  std::string_view begin;
  const char* name;
};
constexpr std::array<OtherKind, 3> kOtherKinds = {{{"SQLite format 3", "an SQLite database, as rosbag2 records"},
                                                   {"\x89MCAP", "an MCAP file"},
                                                   {"\x1A\x45\xDF\xA3", "Matroska, as Azure Kinect's SDK records"}}};

/// Returns the first bytes of a file; of what is none, zeros.
std::string begin_of(const std::string& file) {
  std::string begin(16, '\0');
  std::error_code unknown;
  if (std::filesystem::is_regular_file(file, unknown))
    std::ifstream(file, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin;
}

void refuse_other_kinds(const std::string& file) {
  const std::string begin = begin_of(file);
  for (const OtherKind& kind : kOtherKinds) {
    require(!starts_with(begin, std::string(kind.begin)),
            "{}: {}, expected an LCM log; let its SDK play it into a publisher (tools/examples/cpp)", file, kind.name);
  }
}

/// Gives it the camera that it lacks; throws InputError unless it is a frame with images that can be decoded.
void complete(images_t& message, const RecordingSettings& settings, std::int64_t sequence) {
  const FrameImages images = images_from_message(message);
  if (settings.camera && !read_camera_metadata(message)) {
    require(images.colour.cols == settings.camera->width && images.colour.rows == settings.camera->height,
            "frame {}: {}x{} pixels, the camera given has {}x{}", message.utime, images.colour.cols, images.colour.rows,
            settings.camera->width, settings.camera->height);
    add_camera(message, *settings.camera);
  }
  if (!read_sequence_number(message)) add_sequence(message, sequence);
}

class LogRecording {
 public:
  LogRecording(const RecordingSettings& settings, LossReport& losses)
      : settings_(settings), is_first_(settings.channel.empty()), losses_(losses), events_(settings.source, losses) {}

  std::optional<RecordedFrame> next() {
    while (std::optional<LogEvent> event = events_.next()) {
      const ByteView bytes{event->data.data(), event->data.size()};
      if (!is_wanted(*event, bytes)) continue;
      try {
        RecordedFrame frame{event->timestamp, to_images(bytes), event->channel};
        complete(frame.message, settings_, sequence_++);
        return frame;
      } catch (const InputError& error) {
        losses_.note_refused(error.what());
      }
    }
    require(sequence_ > 0, "{}: no frames {}", settings_.source,
            settings_.channel.empty() ? "on any channel" : "on channel " + settings_.channel);
    if (!others_.empty() && is_first_) {
      log_warning("{}: frames of {} only; those on {} are left out, --from-channel chooses", settings_.source,
                  settings_.channel, fmt::join(others_, ", "));
    }
    others_.clear();
    return std::nullopt;
  }

 private:
  bool is_wanted(const LogEvent& event, ByteView bytes) {
    const bool is_frame = is_frame_type(fingerprint_of(bytes));
    if (settings_.channel.empty() && is_frame) settings_.channel = event.channel;
    if (is_frame && event.channel != settings_.channel) others_.insert(event.channel);
    return event.channel == settings_.channel;
  }

  RecordingSettings settings_;
  bool is_first_;  // the channel was not chosen by the user
  std::set<std::string> others_;
  LossReport& losses_;
  IntactEvents events_;
  std::int64_t sequence_ = 0;
};

class KlgRecording {
 public:
  KlgRecording(const std::string& file, const RecordingSettings& settings, LossReport& losses)
      : settings_(settings),
        losses_(losses),
        klg_(file, settings.camera ? settings.camera->width : 640, settings.camera ? settings.camera->height : 480),
        whole_(static_cast<double>(klg_.bytes_left())),
        progress_(std::filesystem::path(file).filename().string(), whole_) {}

  std::optional<RecordedFrame> next() {
    while (std::optional<images_t> message = read()) {
      progress_.at(whole_ - static_cast<double>(klg_.bytes_left()));
      try {
        complete(*message, settings_, sequence_++);
        return RecordedFrame{message->utime, std::move(*message), ""};
      } catch (const InputError& error) {
        losses_.note_refused(error.what());
      }
    }
    return std::nullopt;
  }

 private:
  std::optional<images_t> read() {
    if (ended_) return std::nullopt;
    try {
      return klg_.next();
    } catch (const InputError& error) {
      losses_.note_damage(klg_.bytes_left(), error.what());
      ended_ = true;
      return std::nullopt;
    }
  }

  RecordingSettings settings_;
  LossReport& losses_;
  KlgFile klg_;
  double whole_;  // bytes
  ProgressLine progress_;
  std::int64_t sequence_ = 0;
  bool ended_ = false;
};

class SourceRecording {
 public:
  explicit SourceRecording(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  std::optional<RecordedFrame> next() {
    const std::optional<RgbdFrame> frame = source_->next();
    if (!frame) return std::nullopt;
    progress_.add(1.0);
    WireFormat lossless;
    lossless.jpeg = false;
    return RecordedFrame{frame->id.utime, to_message(*frame, lossless, sequence_++), ""};
  }

 private:
  std::unique_ptr<FrameSource> source_;
  ProgressLine progress_{"frames", 0.0};
  std::int64_t sequence_ = 0;
};

template <typename Recording>
NextFrame reading(std::shared_ptr<Recording> recording) {
  return [recording = std::move(recording)] { return recording->next(); };
}

}  // namespace

NextFrame open_recording(const RecordingSettings& settings, LossReport& losses) {
  if (settings.camera) check_camera(*settings.camera, "--camera");
  if (const auto file = file_of(settings.source, "klg")) {
    return reading(std::make_shared<KlgRecording>(*file, settings, losses));
  }
  if (const auto file = file_of(settings.source, "oni")) {
    openni::CameraOptions options;
    options.camera = settings.camera;
    return reading(std::make_shared<SourceRecording>(openni::open_oni_source(*file, options)));
  }
  if (is_frame_source(settings.source)) {
    return reading(std::make_shared<SourceRecording>(open_frame_source(settings.source, "LOG, FILE.klg, FILE.oni, ")));
  }
  if (starts_with(begin_of(settings.source), "#ROSBAG"))
    return reading(std::make_shared<SourceRecording>(open_frame_source("bag:" + settings.source)));
  if (std::filesystem::is_directory(settings.source)) {
    const std::string meant = suggest_source(settings.source);
    require(meant.empty(), "{}: is a folder, expected an LCM log; did you mean {}?", settings.source, meant);
  }
  refuse_other_kinds(settings.source);
  return reading(std::make_shared<LogRecording>(settings, losses));
}

std::int64_t import_log(const RecordingSettings& settings, const std::string& channel,
                        const std::filesystem::path& log_file, LossReport& losses) {
  channel::require_name(channel);
  require_outside_source(log_file, settings.source);
  const NextFrame next = open_recording(settings, losses);
  std::optional<LogWriter> log;  // made when there is something to write
  std::int64_t frames = 0;
  while (const std::optional<RecordedFrame> frame = next()) {
    require_not_stopped();
    const std::vector<std::uint8_t> bytes = encode_message(frame->message);
    if (!log) log.emplace(log_file);
    log->write(frame->timestamp, channel, {bytes.data(), bytes.size()});
    ++frames;
  }
  require(log.has_value(), "{}: no frame could be imported: {}", settings.source, losses.line());
  log->close();
  return frames;
}

}  // namespace houghstream::log_tools
