#include "tools/evaluate/metrics/result_log.hpp"

#include <fmt/ranges.h>

#include <optional>
#include <set>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream {
namespace {

template <typename Result>
void keep(Result result, const ChannelPattern& cameras, std::vector<Result>& kept) {
  if (cameras.matches(result.frame.channel)) kept.push_back(std::move(result));
}

}  // namespace

PublishedResults read_result_log(const std::filesystem::path& log_file, const std::string& frame_channels) {
  const ChannelPattern cameras(frame_channels);
  PublishedResults results;
  LogReader log(log_file);
  std::optional<pose_probabilities_t> probabilities;  // last ones of the log; those of poses come just before them
  while (const auto event = log.next()) {
    const ByteView bytes{event->data.data(), event->data.size()};
    if (event->channel == channel::kDetections) {
      keep(detections_from_message(decode_message<detections_t>(bytes)), cameras, results.detections);
    } else if (event->channel == channel::kPoseProbabilities) {
      probabilities = decode_message<pose_probabilities_t>(bytes);
    } else if (event->channel == channel::kPoses) {
      ObjectPoses poses = poses_from_message(decode_message<object_poses_t>(bytes));
      if (probabilities) apply_probabilities(*probabilities, poses);
      keep(std::move(poses), cameras, results.poses);
    }
  }
  require(!results.detections.empty(), "{}: no message on {} of frames on {}, expected results", log_file.string(),
          channel::kDetections, frame_channels);
  std::set<std::string> found;
  for (const Detections& detections : results.detections) found.insert(detections.frame.channel);
  for (const ObjectPoses& poses : results.poses) found.insert(poses.frame.channel);
  require(found.size() == 1, "{}: results of {} cameras, {}, expected one; choose with --channel", log_file.string(),
          found.size(), fmt::join(found, ", "));
  return results;
}

}  // namespace houghstream
