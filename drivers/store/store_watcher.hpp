#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/store/object_store.hpp"
#include "pipeline/types/known_objects.hpp"

namespace houghstream::store {

/// A group of a store that cannot be loaded, while the others can.
struct GroupFault {
  int group = 0;
  std::string problem;  ///< one line that names the file, the value and what was expected
};

/// A program's part of a store.
template <typename T>
struct Loaded {
  // NOLINTNEXTLINE(google-explicit-constructor): most programs load all of it or nothing
  Loaded(std::shared_ptr<const T> all) : part(std::move(all)) {}
  Loaded(std::shared_ptr<const T> whole_groups, std::vector<GroupFault> others)
      : part(std::move(whole_groups)), faults(std::move(others)) {}

  std::shared_ptr<const T> part;
  std::vector<GroupFault> faults;  ///< the groups that `part` lacks, in ascending order
};

/// Watches an object store that changes while a program runs: the program's part of it is loaded in a thread of low
/// priority, and replaces the previous one atomically. A truncated or invalid store leaves the previous state; one line
/// of the log and known() state the reason. Where there is no previous state, the groups that can be loaded are taken
/// without those that cannot. A faulty store is retried after five periods, then with exponential backoff up to 300,
/// since memory or file descriptors may have been missing. Every function may be called from any thread.
class StoreWatcherBase {
 public:
  using Load = std::function<Loaded<void>(const ObjectStore&)>;

  /// Loads the store at once. `load` throws where its parts are bad; it may be called again later, from another thread.
  /// Where there is no folder of this name yet, but one that it could be made in, no object is known so far; this is
  /// logged, and 50 periods later once more, with the stores beside it. Throws InputError as read_store() and `load`
  /// do.
  StoreWatcherBase(std::filesystem::path folder, Load load);
  ~StoreWatcherBase();  ///< waits for a load that is under way
  StoreWatcherBase(const StoreWatcherBase&) = delete;
  StoreWatcherBase& operator=(const StoreWatcherBase&) = delete;

  /// Starts polling every `period`, and loads the store when it has changed and then stayed the same for a period,
  /// since copying into it takes a while.
  void follow(std::chrono::milliseconds period);

  /// Instead of follow(), where all is to go by the same: throws InputError if there is no store yet, or not all of it
  /// could be loaded.
  void require_store() const;

  /// Returns the object that was loaded last; null while there is no store yet.
  std::shared_ptr<const void> current() const;

  KnownObjects known() const;

 private:
  void run(std::chrono::milliseconds period);
  void poll();
  void load(const std::string& state);
  bool take(const ObjectStore& store, Loaded<void> loaded, const std::string& state);
  void refuse(const std::string& state, const std::string& problem);
  void report_missing_store();
  void adopt(const ObjectStore& store, Loaded<void> loaded);
  void set_problem(const std::string& problem);

  std::filesystem::path folder_;
  Load load_;
  std::string taken_;                                 // the files' state when they were loaded
  std::string refused_;                               // the files' state when they were refused
  int polls_since_refusal_ = 0;                       // polls of the same state
  int polls_until_retry_ = 0;                         // after the refusal
  int polls_without_folder_ = 0;                      // since the start, while nothing is known
  std::string pending_;                               // seen last: one that may not last
  std::vector<std::shared_ptr<const void>> retired_;  // released here, where their end keeps no frame waiting
  mutable std::mutex mutex_;
  std::condition_variable ended_;
  bool ending_ = false;
  std::shared_ptr<const void> current_;
  KnownObjects known_;
  std::thread thread_;
};

/// Watches a store with the type of the loaded object.
template <typename T>
class StoreWatcher {
 public:
  using Load = std::function<Loaded<T>(const ObjectStore&)>;

  StoreWatcher(const std::filesystem::path& folder, Load load)
      : watcher_(folder, [load = std::move(load)](const ObjectStore& store) {
          Loaded<T> loaded = load(store);
          return Loaded<void>(std::move(loaded.part), std::move(loaded.faults));
        }) {}

  void follow(std::chrono::milliseconds period = std::chrono::milliseconds(200)) { watcher_.follow(period); }
  void require_store() const { watcher_.require_store(); }
  std::shared_ptr<const T> current() const { return std::static_pointer_cast<const T>(watcher_.current()); }
  KnownObjects known() const { return watcher_.known(); }

 private:
  StoreWatcherBase watcher_;
};

}  // namespace houghstream::store
