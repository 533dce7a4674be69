#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/stream/child.hpp"

namespace houghstream::view {

/// Describes a teaching from the stream that is shown.
struct TeachingOrder {
  std::filesystem::path executables;  ///< folder of hs-teach
  std::string store;                  ///< store to which the object is added
  bool joins_others = true;           ///< false: the store is made for it
  std::string name;                   ///< name of the object
  std::string channel;                ///< channel of the frames
  std::string lcm_url;                ///< "" = LCM's default
  std::optional<cv::Rect> box;        ///< box of the object, pixels; none = the nearest object
  std::optional<cv::Point> at;        ///< pixel to which it is nearest; none = the middle
};

/// Returns hs-teach with its arguments.
std::vector<std::string> teaching_command(const TeachingOrder& order);

/// Returns "object_1", or the first such name that is unused.
std::string free_name(const std::vector<std::string>& known);

/// Starts hs-teach show for the running stream, one at a time, and ends its take. The program ends with this.
class TeachingStarter {
 public:
  /// Starts it; while it runs its take ends instead. What cannot be started is logged.
  void press(const TeachingOrder& order);

  /// Returns whether it runs. Logs its exit status when it has ended.
  bool runs();

 private:
  std::unique_ptr<stream::ChildProcess> child_;
  bool is_asked_to_end_ = false;
};

}  // namespace houghstream::view
