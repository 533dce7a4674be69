#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

namespace houghstream {

/// A callable `void(Arguments...)` that outlives the call it is passed to. Unlike std::function it never allocates.
template <typename... Arguments>
class FunctionRef {
 public:
  template <typename Callable>
  FunctionRef(const Callable& callable)  // NOLINT(google-explicit-constructor): a lambda is passed as it is
      : callable_(&callable),
        call_([](const void* it, Arguments... arguments) { (*static_cast<const Callable*>(it))(arguments...); }) {}
  void operator()(Arguments... arguments) const { call_(callable_, arguments...); }

 private:
  const void* callable_;
  void (*call_)(const void*, Arguments...);
};

using ItemFunction = FunctionRef<int>;             ///< function of an item
using WorkerItemFunction = FunctionRef<int, int>;  ///< function of a worker and an item

/// Calls work(i) for every i in [0, count), on `threads` threads, the caller's among them; one thread means no others.
/// Items are handed out in order, so work must write only to item i's own place: then the result does not depend on
/// `threads`. The first exception (lowest i among those thrown) is rethrown when all have ended. May be called from
/// several threads at once and from within work. The other threads are kept from call to call.
void parallel_for(int threads, int count, const ItemFunction& work);

/// Calls work(worker, i) for each item. No two items of one worker are processed at the same time, so that they may
/// share a workspace. Workers are numbered from 0; there are at most max(threads, 1). The assignment of items to
/// workers is not deterministic.
void parallel_for_workers(int threads, int count, const WorkerItemFunction& work);

/// Thrown by parallel calls under a SerialScope whose work is cancelled.
struct WorkCancelled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// While a SerialScope exists, parallel_for() runs serially on the thread that created it, whatever `threads` says. A
/// thread of low priority uses it, since its new threads would have its priority and be kept for the calls of others.
/// Before each item the calls ask `is_cancelled`, if there is one, and throw WorkCancelled where it returns true.
class SerialScope {
 public:
  explicit SerialScope(std::function<bool()> is_cancelled = {});
  ~SerialScope();
  SerialScope(const SerialScope&) = delete;
  SerialScope& operator=(const SerialScope&) = delete;

  void throw_if_cancelled() const;

 private:
  std::function<bool()> is_cancelled_;
  const SerialScope* outer_;
};

/// Memory for each worker of parallel_for_workers, kept from call to call by whoever holds this. Each worker's lies in
/// a place of its own, which does not move.
template <typename T>
class PerWorker {
 public:
  /// Resizes the parts; called before the workers start.
  void resize(int threads) {
    while (parts_.empty() || parts_.size() < static_cast<std::size_t>(threads < 0 ? 0 : threads)) {
      parts_.push_back(std::make_unique<T>());
    }
  }
  T& operator[](int worker) { return *parts_[static_cast<std::size_t>(worker)]; }

 private:
  std::vector<std::unique_ptr<T>> parts_;
};

}  // namespace houghstream
