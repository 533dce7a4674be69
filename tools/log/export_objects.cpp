#include "tools/log/export_objects.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tools/log/csv_text.hpp"

namespace houghstream::log_tools {
namespace {

std::vector<WorldObjects> read_worlds(const std::filesystem::path& log_file, LossReport& losses) {
  std::vector<WorldObjects> worlds;
  IntactEvents events(log_file, losses);
  while (const std::optional<LogEvent> event = events.next()) {
    if (event->channel != channel::kObjects) continue;
    try {
      worlds.push_back(world_from_message(decode_message<objects_t>({event->data.data(), event->data.size()})));
    } catch (const InputError& error) {
      losses.note_refused(error.what());
    }
  }
  require(!worlds.empty(), "{}: no message on {}, expected objects of hs-track", log_file.string(), channel::kObjects);
  return worlds;
}

std::array<double, 7> numbers_of(const Eigen::Isometry3d& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d& t = T.translation();
  return {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()};
}

std::string object_row(const WorldObjects& world, const TrackedObject& object) {
  std::string text =
      fmt::format("{},{},{},{},{},{},{},{},{:.6g},{}", world.frame.utime, quoted(world.frame.channel),
                  quoted(world.world), world.world_number, object.track_id, object.class_id, quoted(object.class_name),
                  to_string(object.state), object.probability, object.moving ? 1 : 0);
  for (const double value : numbers_of(object.T_world_object)) text += fmt::format(",{:.9g}", value);
  for (int i = 0; i < 6; ++i) text += fmt::format(",{:.9g}", std::sqrt(std::max(0.0, object.covariance(i, i))));
  for (int i = 0; i < 6; ++i) text += fmt::format(",{:.9g}", object.velocity[i]);
  return text +
         fmt::format(",{},{},{}", object.last_seen.utime, quoted(object.last_seen.channel), quoted(object.reason));
}

OrderedJson world_json(const WorldObjects& world) {
  OrderedJson json = {{"utime", world.frame.utime},
                      {"source_channel", world.frame.channel},
                      {"world", world.world},
                      {"world_number", world.world_number},
                      {"camera", numbers_of(world.T_world_camera)},
                      {"objects", OrderedJson::array()}};
  for (const TrackedObject& object : world.objects) {
    std::array<double, 6> deviations{};
    for (int i = 0; i < 6; ++i)
      deviations[static_cast<std::size_t>(i)] = std::sqrt(std::max(0.0, object.covariance(i, i)));
    json["objects"].push_back({{"track_id", object.track_id},
                               {"class_id", object.class_id},
                               {"class_name", object.class_name},
                               {"state", to_string(object.state)},
                               {"probability", finite_or_null(static_cast<double>(object.probability))},
                               {"moving", object.moving},
                               {"pose", numbers_of(object.T_world_object)},
                               {"deviation", deviations},
                               {"velocity", std::vector<double>(object.velocity.data(), object.velocity.data() + 6)},
                               {"seen_utime", object.last_seen.utime},
                               {"seen_channel", object.last_seen.channel}});
  }
  return json;
}

/// Returns each object with the changes of its state, in the order of worlds and numbers.
OrderedJson stories_of(const std::vector<WorldObjects>& worlds) {
  std::map<std::pair<int, std::int64_t>, OrderedJson> stories;
  for (const WorldObjects& world : worlds) {
    for (const TrackedObject& object : world.objects) {
      OrderedJson& story = stories[{world.world_number, object.track_id}];
      if (story.is_null())
        story = {{"world_number", world.world_number},
                 {"track_id", object.track_id},
                 {"class_name", object.class_name},
                 {"states", OrderedJson::array()}};
      const std::string state = to_string(object.state);
      if (!story["states"].empty() && story["states"].back()["state"] == state) continue;
      story["states"].push_back({{"utime", world.frame.utime}, {"state", state}, {"reason", object.reason}});
    }
  }
  OrderedJson out = OrderedJson::array();
  for (auto& [key, story] : stories) out.push_back(std::move(story));
  return out;
}

}  // namespace

std::int64_t export_objects_csv(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                LossReport& losses) {
  require_other_file(out_file, log_file);
  const std::vector<WorldObjects> worlds = read_worlds(log_file, losses);
  std::string text =
      "utime,source_channel,world,world_number,track_id,class_id,class_name,state,probability,moving,x,y,z,qw,qx,qy,qz,"
      "dev_x,dev_y,dev_z,dev_rx,dev_ry,dev_rz,vx,vy,vz,wx,wy,wz,seen_utime,seen_channel,reason\n";
  for (const WorldObjects& world : worlds) {
    for (const TrackedObject& object : world.objects) text += object_row(world, object) + '\n';
  }
  write_file_atomically(out_file, text);
  return static_cast<std::int64_t>(worlds.size());
}

std::int64_t export_objects_json(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                 LossReport& losses) {
  require_other_file(out_file, log_file);
  const std::vector<WorldObjects> worlds = read_worlds(log_file, losses);
  OrderedJson json{{"stories", stories_of(worlds)}, {"frames", OrderedJson::array()}};
  for (const WorldObjects& world : worlds) json["frames"].push_back(world_json(world));
  write_json(json, out_file);
  return static_cast<std::int64_t>(worlds.size());
}

}  // namespace houghstream::log_tools
