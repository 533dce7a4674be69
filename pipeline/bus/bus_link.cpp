#include "pipeline/bus/bus_link.hpp"

#include "pipeline/base/log_line.hpp"

namespace houghstream {

void BusLink::update(const std::string& fault, Clock::time_point now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (fault.empty() == is_up_) return;
  is_up_ = fault.empty();
  if (!is_up_) {
    since_ = now;
    unsent_before_ = unsent_;
    log_warning("{}: {}; waiting until the bus can be reached", url_, fault);
    return;
  }
  last_outage_ = fmt::format("the bus could not be reached for {:.1f} s, {} messages were not sent",
                             std::chrono::duration<double>(now - since_).count(), unsent_ - unsent_before_);
  log_info("{}: the bus can be reached again; {}", url_, last_outage_);
}

std::string BusLink::last_outage() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_outage_;
}

}  // namespace houghstream
