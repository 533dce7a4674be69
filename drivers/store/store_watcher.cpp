#include "drivers/store/store_watcher.hpp"

#include <fmt/ranges.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <utility>

#include "drivers/store/store_stamp.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/host_clock.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/base/stop_signal.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;

// Times in polling periods.
constexpr int kFirstRetry = 5;
constexpr int kLastRetry = 300;
constexpr int kReportMissing = 50;

/// Differs whenever a file that is loaded has been written or exchanged, without reading any.
std::string state_of_store(const ObjectStore& store) {
  return fmt::format("{}\n{}\n{}", file_stamp(store.folder), forest_stamp(store), mesh_stamp(store));
}

std::string state_of_store(const fs::path& folder) {
  ObjectStore store;
  store.folder = folder;
  return state_of_store(store);
}

/// Lowers the priority of the calling thread only, as Linux defines it: frames go first, and the thread still runs. A
/// robot's real-time scheduling is not inherited.
void lower_priority() {
  constexpr int kPolite = 10;
  const sched_param none{};
  const bool is_lower = sched_setscheduler(0, SCHED_OTHER, &none) == 0 && nice(kPolite) != -1;
  if (!is_lower) log_warning("the priority of loading a store cannot be lowered");
}

bool holds(const std::vector<KnownObject>& objects, const std::string& name) {
  return std::any_of(objects.begin(), objects.end(), [&](const KnownObject& known) { return known.name == name; });
}

/// Returns the names of those that `others` lack, with their change.
std::string changed(const char* what, const std::vector<KnownObject>& objects, const std::vector<KnownObject>& others) {
  std::vector<std::string> names;
  for (const KnownObject& object : objects) {
    if (!holds(others, object.name)) names.push_back(object.name);
  }
  return names.empty() ? "" : fmt::format("; {} {}", what, fmt::join(names, ", "));
}

fs::path folder_above(const fs::path& folder) {
  return fs::absolute(folder / "").lexically_normal().parent_path().parent_path();
}

/// Returns a hint at folders with a similar name, as text.
std::string describe_neighbours(const fs::path& folder) {
  constexpr std::size_t kMax = 5;
  const fs::path above = folder_above(folder);
  std::vector<std::string> names = find_stores(above);
  if (names.empty()) return fmt::format("no object store lies in {}", above.string());
  if (names.size() > kMax) {
    names.resize(kMax);
    names.emplace_back("others");
  }
  return fmt::format("in {} lies {}", above.string(), fmt::join(names, ", "));
}

bool is_of_faulty_group(const StoredObject& object, const std::vector<GroupFault>& faults) {
  return std::any_of(faults.begin(), faults.end(),
                     [&](const GroupFault& fault) { return fault.group == object.group; });
}

/// Returns one line that names the first fault and all objects that are not known by the faults; empty without any.
std::string describe_faults(const ObjectStore& store, const std::vector<GroupFault>& faults) {
  if (faults.empty()) return "";
  std::vector<std::string> names;
  for (const StoredObject& object : store.objects) {
    if (is_of_faulty_group(object, faults)) names.push_back(object.name);
  }
  const std::string others = faults.size() == 1 ? "" : fmt::format(" (and {} others)", faults.size() - 1);
  return fmt::format("{}{}; without it {}", faults.front().problem, others, fmt::join(names, ", "));
}

}  // namespace

StoreWatcherBase::StoreWatcherBase(fs::path folder, Load load) : folder_(std::move(folder)), load_(std::move(load)) {
  known_.store = folder_.string();
  taken_ = state_of_store(folder_);  // changes during the reading are noticed by follow()
  if (!fs::exists(folder_)) {
    require(fs::is_directory(folder_above(folder_)),
            "{}: no such folder, expected an object store of hs-teach, or where it can make one", folder_.string());
    refused_ = std::exchange(taken_, "");
    set_problem(fmt::format("{}: not there yet, nothing is known until hs-teach makes it", folder_.string()));
    return;
  }
  const ObjectStore store = read_store(folder_);
  if (!take(store, load_(store), taken_)) taken_.clear();
}

StoreWatcherBase::~StoreWatcherBase() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  ended_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void StoreWatcherBase::follow(std::chrono::milliseconds period) {
  const BlockStopSignals block;
  thread_ = std::thread([this, period] { run(period); });
}

void StoreWatcherBase::require_store() const {
  require(current() != nullptr, "{}: no such folder, expected an object store of hs-teach", folder_.string());
  const std::string problem = known().problem;
  if (!problem.empty()) throw InputError(problem);
}

std::shared_ptr<const void> StoreWatcherBase::current() const {
  const std::lock_guard lock(mutex_);
  return current_;
}

KnownObjects StoreWatcherBase::known() const {
  const std::lock_guard lock(mutex_);
  return known_;
}

void StoreWatcherBase::run(std::chrono::milliseconds period) {
  lower_priority();
  const SerialScope alone([this] {
    const std::lock_guard ending(mutex_);
    return ending_;
  });
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, period, [this] { return ending_; })) {
    lock.unlock();
    try {
      poll();
    } catch (const std::bad_alloc&) {
      pending_.clear();  // it is polled again
    }
    lock.lock();
  }
}

void StoreWatcherBase::poll() {
  retired_.erase(
      std::remove_if(retired_.begin(), retired_.end(), [](const auto& loaded) { return loaded.use_count() == 1; }),
      retired_.end());
  const std::string state = state_of_store(folder_);
  const bool lasts = state == pending_;
  pending_ = state;
  report_missing_store();
  if (state == taken_) return set_problem("");
  if (!lasts || (state == refused_ && (polls_until_retry_ == 0 || ++polls_since_refusal_ < polls_until_retry_))) return;
  load(state);
}

/// Once, where nothing has ever been there: the name may be a wrong one.
void StoreWatcherBase::report_missing_store() {
  std::error_code error;
  if (current() != nullptr || polls_without_folder_ > kReportMissing || fs::exists(folder_, error)) return;
  if (++polls_without_folder_ <= kReportMissing) return;
  set_problem(fmt::format("{}: still not there, nothing is known until hs-teach makes it; {}", folder_.string(),
                          describe_neighbours(folder_)));
}

void StoreWatcherBase::load(const std::string& state) {
  try {
    const ObjectStore store = read_store(folder_);
    Loaded<void> loaded = load_(store);
    if (state_of_store(folder_) != state) return;  // parts of two stores were read
    if (!take(store, std::move(loaded), state)) return;
    taken_ = state;
  } catch (const WorkCancelled&) {
    return;
  } catch (const std::bad_alloc&) {
    refuse(state, fmt::format("{}: not enough memory to load it, expected more soon", folder_.string()));
    return;
  } catch (const std::exception& error) {
    if (state_of_store(folder_) == state) refuse(state, error.what());
    return;
  }
  set_problem("");
}

/// Adopts what was loaded, and refuses its state where groups are missing, which are adopted only where nothing is
/// known yet. Returns whether all of the store was adopted.
bool StoreWatcherBase::take(const ObjectStore& store, Loaded<void> loaded, const std::string& state) {
  const std::string problem = describe_faults(store, loaded.faults);
  const bool is_first = current() == nullptr;
  if (!problem.empty()) refuse(state, problem);
  if (problem.empty() || is_first) adopt(store, std::move(loaded));
  return problem.empty();
}

/// A state that stays the same is loaded again only after a while.
void StoreWatcherBase::refuse(const std::string& state, const std::string& problem) {
  polls_until_retry_ = state == refused_ ? std::min(2 * polls_until_retry_, kLastRetry) : kFirstRetry;
  polls_since_refusal_ = 0;
  refused_ = state;
  set_problem(problem);
}

void StoreWatcherBase::adopt(const ObjectStore& store, Loaded<void> loaded) {
  const std::int64_t now = utime_now();
  const std::lock_guard lock(mutex_);
  std::vector<KnownObject> objects;
  for (const StoredObject& object : store.objects) {
    if (is_of_faulty_group(object, loaded.faults)) continue;
    const auto known = std::find_if(known_.objects.begin(), known_.objects.end(),
                                    [&](const KnownObject& earlier) { return earlier.name == object.name; });
    objects.push_back({object.name, known == known_.objects.end() ? now : known->since_utime});
  }
  if (current_ || !known_.problem.empty()) {
    log_info("{}: {} object{} from here on{}{}", known_.store, objects.size(), objects.size() == 1 ? "" : "s",
             changed("new:", objects, known_.objects), changed("gone:", known_.objects, objects));
  }
  if (current_) retired_.push_back(std::move(current_));
  current_ = std::move(loaded.part);
  known_.objects = std::move(objects);
  known_.since_utime = now;
}

void StoreWatcherBase::set_problem(const std::string& problem) {
  const std::lock_guard lock(mutex_);
  if (problem == known_.problem) return;
  known_.problem = problem;
  if (!problem.empty()) log_warning("{}{}", problem, current_ ? "; what was known stays" : "");
}

}  // namespace houghstream::store
