#include "tools/log/export_frames.hpp"

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/datasets/open_frame_source.hpp"
#include "drivers/files/frame_folder.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

/// Calls `write` for each frame; what it refuses is counted. Returns the number of frames written.
template <typename Write>
std::int64_t for_each_frame(const RecordingSettings& settings, LossReport& losses, const Write& write) {
  const NextFrame next = open_recording(settings, losses);
  std::int64_t frames = 0;
  while (const std::optional<RecordedFrame> frame = next()) {
    require_not_stopped();
    if (write(*frame)) ++frames;
  }
  require(frames > 0, "{}: no frame could be exported: {}", settings.source, losses.line());
  return frames;
}

/// Frames of another export would be taken for this one's.
void refuse_mixture(bool holds_others, const fs::path& folder) {
  require(!holds_others, "{}: holds pictures already, expected a new folder or one without", folder.string());
}

}  // namespace

std::int64_t export_bop(const RecordingSettings& settings, const fs::path& folder, LossReport& losses) {
  require_outside_source(folder, settings.source);
  refuse_mixture(has_images(folder), folder);
  BopWriter writer(folder);
  const auto write = [&](const RecordedFrame& recorded) {
    RgbdFrame frame;
    try {
      frame = frame_from_message(recorded.message, recorded.channel, settings.camera);
    } catch (const InputError& error) {
      losses.note_refused(error.what());
      return false;
    }
    writer.add(frame, {}, {});
    return true;
  };
  const std::int64_t frames = for_each_frame(settings, losses, write);
  writer.finish();
  return frames;
}

std::int64_t export_pngs(const RecordingSettings& settings, const fs::path& folder, LossReport& losses) {
  require_outside_source(folder, settings.source);
  std::error_code error;
  refuse_mixture(fs::is_directory(folder, error) && has_frame_pairs(folder), folder);
  fs::create_directories(folder, error);
  require(!error, "{}: cannot be written: {}", folder.string(), error.message());
  std::string list = "frame,utime,timestamp\n";
  std::int64_t index = 0;
  const auto write = [&](const RecordedFrame& recorded) {
    const FrameImages images = images_from_message(recorded.message);
    const std::string name = fmt::format("{:06d}", index++);
    write_png(images.colour, folder / (name + "_color.png"));
    write_png(images.depth_mm, folder / (name + "_depth.png"));
    list += fmt::format("{},{},{}\n", name, recorded.message.utime, recorded.timestamp);
    return true;
  };
  const std::int64_t frames = for_each_frame(settings, losses, write);
  write_file_atomically(folder / "frames.csv", list);
  return frames;
}

}  // namespace houghstream::log_tools
