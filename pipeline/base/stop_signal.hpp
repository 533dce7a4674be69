#pragma once

#include <csignal>

namespace houghstream {

/// From now on SIGINT and SIGTERM only set a flag.
void catch_stop_signals();

/// Whether one of them has come since.
bool stop_requested();

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
