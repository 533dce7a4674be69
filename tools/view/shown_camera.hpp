#pragma once

#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace houghstream::view {

/// Which camera's frames are shown, of those that are on the bus: the first that is heard until another one is asked
/// for. May be used from any thread.
class ShownCamera {
 public:
  /// A frame of this camera has come.
  void note(const std::string& channel);

  /// The next camera in the order of their names.
  void next();

  /// While none was heard, each one is.
  bool is_shown(const std::string& channel) const;

  /// The channels of all cameras that were heard, in order.
  std::vector<std::string> heard() const;

 private:
  mutable std::mutex mutex_;
  std::set<std::string> heard_;
  std::string shown_;
};

}  // namespace houghstream::view
