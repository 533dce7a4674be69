#pragma once

#include <chrono>
#include <functional>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/bus/status_reporter.hpp"

namespace houghstream {

/// Processes the next item, waiting for one up to the given time; returns false where there was none.
using WorkStep = std::function<bool(std::chrono::milliseconds)>;

/// Runs a process until SIGINT or SIGTERM, or to the end of a log. On a network one thread receives, so that
/// nothing waits in LCM, and reports the status once a second, while the calling thread works; where that hangs for
/// longer than Heartbeat::kHeartbeatTimeout, the reports end. A log is read by the calling thread, and every event is
/// worked on before the next is read. A network that cannot be reached is waited for (LcmBus). Throws InputError where
/// the log is damaged or was not read to its end.
///
/// `background` is work that the rest does not wait for: on a network a second thread, of low priority and without
/// helpers, does it; in a log it runs where `work` has nothing left to do.
void run_process_loop(LcmBus& bus, StatusReporter& status, const WorkStep& work, const WorkStep& background = {});

/// Publishes the final status, so that receivers have the totals, logs its summary, and ends the output log.
/// Throws InputError where that cannot be ended, or has nothing in it (LcmBus::close()).
void end_process(LcmBus& bus, StatusReporter& status);

}  // namespace houghstream
