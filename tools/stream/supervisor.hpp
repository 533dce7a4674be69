#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/stream/child.hpp"

namespace houghstream::stream {

/// Describes a process of the stream.
struct ChildPlan {
  std::string name;                  ///< name for people, for instance "detect"
  std::vector<std::string> command;  ///< program with its path, arguments
  bool ends_stream = false;          ///< its end with status 0 ends all: the source's end, the closed window
  /// Started when all others have sent a heartbeat: the source, whose frames they receive.
  bool is_started_last = false;
};

struct SupervisorSettings {
  std::chrono::milliseconds initial_backoff{250};  ///< before a second restart; doubled by each failure that follows
  std::chrono::milliseconds max_backoff{10'000};
  std::chrono::milliseconds backoff_reset{10'000};  ///< after so long a run the next failure counts as the first
  int max_failures = 8;                             ///< consecutive failures after which the stream ends
  std::chrono::milliseconds start_time{3000};       ///< run time after which a process has started
  std::chrono::milliseconds stop_timeout{1500};     ///< time for a process to end by itself when it is asked to
  std::chrono::milliseconds finishing{600'000};     ///< the same for a process that reports that it is still writing
  std::chrono::milliseconds heartbeat_timeout{
      10'000};  ///< a process without a heartbeat for so long, after its first, counts as hung
  std::chrono::milliseconds startup_timeout{
      60'000};  ///< timeout of the first heartbeat: the process may still be loading
  std::chrono::milliseconds others_timeout{10'000};  ///< maximum wait of a process that is started last
};

/// Keeps the processes of a stream running: one that dies is started again, at once the first time, after a pause that
/// grows with each failure that follows, until it has failed `max_failures` times in a row. One that fails before it
/// has ever run is not restarted: it would fail again for the same reason. One that is started last starts when each of
/// the others has sent a heartbeat, or `others_timeout` after them. A process without a heartbeat for
/// `heartbeat_timeout` counts as hung: it is asked to end (SIGTERM), killed where it does not (SIGKILL after
/// `stop_timeout`, or `finishing` where it reports that it is still writing), and started again likewise. A process
/// that is started again replaces no existing file, whatever --replace said: it may be what it has recorded before.
/// Only time during which this process received messages counts: where it has stood still itself, or its bus was gone,
/// its children have not. Call it from one thread.
class Supervisor {
 public:
  using Clock = std::chrono::steady_clock;
  using Say = std::function<void(const std::string&)>;

  /// `say` receives a line for people about each start and end. Throws InputError when a program cannot be started.
  Supervisor(std::vector<ChildPlan> plans, const SupervisorSettings& settings, Say say);
  /// Ends them all.
  ~Supervisor();

  /// Checks the processes. Returns false once the stream is to end. Throws InputError, with its last line of stderr,
  /// when one has failed at its start or too often.
  bool step();

  /// Records a heartbeat, expected from each process every second. Returns false for an unknown pid.
  bool on_heartbeat(pid_t pid);

  /// Returns the processes that the source's last frames go through, in their order, once step() has returned that the
  /// stream ends because its source has. Returns none where another cause has ended it.
  std::vector<pid_t> downstream_pids() const;

  /// Excludes the time since the last step from all heartbeat timeouts.
  void pause_watchdog();

  /// Asks all to end, waits, and kills after `stop_timeout`, or after `finishing` for a process that reports that it
  /// needs more time. Returns the names of those that had to be killed.
  std::vector<std::string> stop();

  /// Gives the state of a process.
  struct State {
    std::string name;
    pid_t pid = 0;  ///< 0 while it waits for its restart
    int restarts = 0;
    bool waits = false;  ///< it waits for the others before its first start
  };
  std::vector<State> states() const;

 private:
  struct Member {
    ChildPlan plan;
    std::unique_ptr<ChildProcess> child;
    bool waits = false;    // it waits for the others before its first start
    bool has_run = false;  // once, since the stream began
    bool has_heartbeat = false;
    Clock::duration silent{0};                   // time without a heartbeat while the watchdog was active
    std::optional<Clock::time_point> asked_end;  // time at which it was asked to end because it hangs
    int restarts = 0;
    int failures = 0;  // consecutive failures
    std::chrono::milliseconds wait{0};
    Clock::time_point since;  // time of the start, or of the next restart
  };
  void start(Member& member);
  void start_waiting();
  bool look_after(Member& member, Clock::duration listened);
  void check_heartbeat(Member& member, Clock::duration listened);
  void plan_restart(Member& member, const std::string& words);
  void restart_if_due(Member& member);
  std::string names_of_writing();

  std::vector<Member> members_;
  bool source_has_ended_ = false;  // the source ended by itself
  SupervisorSettings settings_;
  Say say_;
  Clock::time_point begun_ = Clock::now();
  Clock::time_point last_step_ = begun_;
};

}  // namespace houghstream::stream
