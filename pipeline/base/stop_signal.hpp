#pragma once

#include <csignal>

namespace houghstream {

/// From now on SIGINT and SIGTERM only set a flag; the next one ends the program when it comes more than a second
/// later, so that nothing that hangs is deaf. Before, both end the program: call it when what takes long (a forest,
/// models) has been read, and before it is said that the program is ready.
void catch_stop_signals();

/// Returns whether one of the signals has arrived since.
bool stop_requested();

/// From now on they end the program again, as before catch_stop_signals().
void release_stop_signals();

/// While it lives, threads started by this one never receive SIGINT or SIGTERM: a library's thread is not
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
