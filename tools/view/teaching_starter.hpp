#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/stream/child.hpp"

namespace houghstream::view {

/// What is to be taught of the stream that is shown.
struct TeachingOrder {
  std::filesystem::path executables;  ///< folder of hs-teach
  std::string store;                  ///< that the object joins,
  bool joins_others = true;           ///< or that is made for it
  std::string name;                   ///< that it gets
  std::string channel;                ///< of the frames
  std::string lcm_url;                ///< "" = LCM's default
  std::optional<cv::Rect> box;        ///< about the object, pixels; none = what stands nearest
  std::optional<cv::Point> at;        ///< to this pixel, or to the middle
};

/// hs-teach with its words.
std::vector<std::string> teaching_command(const TeachingOrder& order);

/// "object_1", or the first such name that is not known.
std::string free_name(const std::vector<std::string>& known);

/// Starts hs-teach show for the stream that goes on, one at a time, and ends its take. The program ends with this.
class TeachingStarter {
 public:
  /// Starts it; while it runs its take ends instead. What cannot be started is logged.
  void press(const TeachingOrder& order);

  /// Whether it runs. Logs how it ended.
  bool runs();

 private:
  std::unique_ptr<stream::ChildProcess> child_;
  bool is_asked_to_end_ = false;
};

}  // namespace houghstream::view
