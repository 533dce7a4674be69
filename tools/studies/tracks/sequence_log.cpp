#include "tools/studies/tracks/sequence_log.hpp"

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream::studies {
namespace {

template <typename Message>
void write_message(LogWriter& writer, const std::string& channel, const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  writer.write(message.utime, channel, {bytes.data(), bytes.size()});
}

/// Results of a log by frame, in their order.
std::map<FrameId, std::vector<LogEvent>> results_of(const std::filesystem::path& log) {
  std::map<FrameId, std::vector<LogEvent>> out;
  LogReader reader(log);
  while (std::optional<LogEvent> event = reader.next()) {
    if (event->channel != channel::kDetections && event->channel != channel::kPoses) continue;
    const FrameId frame = read_result_frame({event->data.data(), event->data.size()}, event->channel);
    out[frame].push_back(std::move(*event));
  }
  return out;
}

}  // namespace

void write_sequence_log(const SequenceFile& sequence, const std::filesystem::path& log,
                        const std::map<std::string, Eigen::Vector3d>& wrong_m) {
  LogWriter writer(log);
  std::vector<BopScene> scenes;
  for (const SequenceCamera& camera : sequence.cameras) scenes.emplace_back(camera.scene);
  for (std::size_t i = 0; i < sequence.utimes.size(); ++i) {
    for (std::size_t c = 0; c < scenes.size(); ++c) {
      const SequenceCamera& camera = sequence.cameras[c];
      Eigen::Isometry3d T_world_camera = camera.T_world_camera[i];
      if (const auto wrong = wrong_m.find(camera.channel); wrong != wrong_m.end())
        T_world_camera.pretranslate(wrong->second);
      write_message(writer, channel::to_world(camera.channel), to_message(sequence.utimes[i], T_world_camera));
      RgbdFrame frame = scenes[c].read_frame(i);
      frame.id = {camera.channel, sequence.utimes[i]};
      write_message(writer, camera.channel, to_message(frame, WireFormat{}, static_cast<std::int64_t>(i)));
    }
  }
  writer.close();
}

void join_logs(const std::filesystem::path& frames, const std::vector<std::filesystem::path>& results,
               const std::filesystem::path& out) {
  std::vector<std::map<FrameId, std::vector<LogEvent>>> found;
  found.reserve(results.size());
  for (const std::filesystem::path& log : results) found.push_back(results_of(log));
  LogReader reader(frames);
  LogWriter writer(out);
  while (const std::optional<LogEvent> event = reader.next()) {
    const ByteView bytes{event->data.data(), event->data.size()};
    writer.write(event->timestamp, event->channel, bytes);
    if (!is_frame_message(bytes)) continue;
    const FrameId frame{event->channel, read_frame_header(bytes).utime};
    for (const auto& log : found) {
      const auto of_frame = log.find(frame);
      if (of_frame == log.end()) continue;
      for (const LogEvent& result : of_frame->second)
        writer.write(event->timestamp, result.channel, {result.data.data(), result.data.size()});
    }
  }
  writer.close();
}

}  // namespace houghstream::studies
