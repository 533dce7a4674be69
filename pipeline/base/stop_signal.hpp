#pragma once

#include <csignal>

namespace houghstream {

/// Makes SIGINT and SIGTERM only set a flag from now on; the next one ends the program if it comes more than a second
/// later, so that a program that hangs can be ended. Before, both end the program: call this after everything that
/// takes long (a forest, models) has been read, and before the program reports that it is ready.
void catch_stop_signals();

/// Returns whether one of the signals has arrived since.
bool stop_requested();

/// Makes them end the program again, as before catch_stop_signals().
void release_stop_signals();

/// While it exists, threads started by this one never receive SIGINT or SIGTERM, so that a library's thread is not
/// interrupted in its system calls.
class BlockStopSignals {
 public:
  BlockStopSignals();
  ~BlockStopSignals();
  BlockStopSignals(const BlockStopSignals&) = delete;
  BlockStopSignals& operator=(const BlockStopSignals&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace houghstream
