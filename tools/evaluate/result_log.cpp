#include "tools/evaluate/result_log.hpp"

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/channels.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream {

PublishedResults read_result_log(const std::filesystem::path& log_file) {
  PublishedResults results;
  LogReader log(log_file);
  while (const auto event = log.next()) {
    const ByteView bytes{event->data.data(), event->data.size()};
    if (event->channel == channel::kDetections) {
      results.detections.push_back(detections_from_message(decode_message<detections_t>(bytes)));
    } else if (event->channel == channel::kPoses) {
      results.poses.push_back(poses_from_message(decode_message<object_poses_t>(bytes)));
    }
  }
  require(!results.detections.empty(), "{}: no message on {}, expected results", log_file.string(),
          channel::kDetections);
  return results;
}

}  // namespace houghstream
