#include "tools/studies/tracks/sequence_file.hpp"

#include <algorithm>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream::studies {
namespace {

Eigen::Isometry3d pose_from(const nlohmann::json& numbers) {
  const auto n = numbers.get<std::vector<double>>();
  require(n.size() == 7, "a pose of {} numbers, expected 7", n.size());
  return Eigen::Translation3d(n[0], n[1], n[2]) * Eigen::Quaterniond(n[3], n[4], n[5], n[6]).normalized();
}

SequenceFile sequence_from(const nlohmann::json& json, const std::filesystem::path& folder) {
  SequenceFile out;
  out.name = json.at("name").get<std::string>();
  out.fps = json.at("fps").get<double>();
  for (const auto& camera : json.at("cameras"))
    out.cameras.push_back(
        {folder / camera.at("scene").get<std::string>(), camera.at("channel").get<std::string>(), {}});
  for (const auto& frame : json.at("frames")) {
    out.utimes.push_back(frame.at("utime").get<std::int64_t>());
    std::vector<TrueInstance> instances;
    for (std::size_t i = 0; i < json.at("objects").size(); ++i) {
      const auto& object = json.at("objects").at(i);
      TrueInstance truth{object.at("instance").get<int>(), object.at("name").get<std::string>(), std::nullopt, 0.0};
      if (const auto& pose = frame.at("objects").at(i); !pose.is_null()) truth.T_world_object = pose_from(pose);
      for (const auto& camera : frame.at("cameras"))
        truth.visible = std::max(truth.visible, camera.at("visible").at(i).get<double>());
      instances.push_back(std::move(truth));
    }
    out.frames.push_back(std::move(instances));
    for (std::size_t c = 0; c < out.cameras.size(); ++c)
      out.cameras[c].T_world_camera.push_back(pose_from(frame.at("cameras").at(c).at("T_world_camera")));
  }
  return out;
}

template <typename Message>
void write_message(LogWriter& writer, const std::string& channel, const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  writer.write(message.utime, channel, {bytes.data(), bytes.size()});
}

/// Returns the results of a log by frame, in their order.
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

std::optional<std::size_t> SequenceFile::index_of(std::int64_t utime) const {
  const auto found = std::lower_bound(utimes.begin(), utimes.end(), utime);
  if (found == utimes.end() || *found != utime) return std::nullopt;
  return static_cast<std::size_t>(found - utimes.begin());
}

SequenceFile thinned(const SequenceFile& sequence, std::size_t every) {
  SequenceFile out = sequence;
  out.fps = sequence.fps / static_cast<double>(every);
  out.utimes.clear();
  out.frames.clear();
  for (SequenceCamera& camera : out.cameras) camera.T_world_camera.clear();
  for (std::size_t i = 0; i < sequence.utimes.size(); i += every) {
    out.utimes.push_back(sequence.utimes[i]);
    out.frames.push_back(sequence.frames[i]);
    for (std::size_t c = 0; c < out.cameras.size(); ++c)
      out.cameras[c].T_world_camera.push_back(sequence.cameras[c].T_world_camera[i]);
  }
  return out;
}

SequenceFile read_sequence(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "sequence.json";
  const nlohmann::json json = read_json_object(file);
  try {
    return sequence_from(json, folder);
  } catch (const nlohmann::json::exception& error) {
    fail("{}: {}, expected what hs-render sequences writes", file.string(), error.what());
  } catch (const InputError& error) {
    fail("{}: {}", file.string(), error.what());
  }
}

void write_sequence_log(const SequenceFile& sequence, const std::filesystem::path& log,
                        const std::map<std::string, Eigen::Vector3d>& wrong_m, std::size_t every) {
  LogWriter writer(log);
  std::vector<BopScene> scenes;
  for (const SequenceCamera& camera : sequence.cameras) scenes.emplace_back(camera.scene);
  for (std::size_t i = 0; i < sequence.utimes.size(); i += every) {
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
