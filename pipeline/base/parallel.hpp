#pragma once

namespace houghstream {

/// A callable `void(int)` that outlives the call it is passed to. Unlike std::function it never allocates.
class ItemWork {
 public:
  template <typename Callable>
  ItemWork(const Callable& callable)  // NOLINT(google-explicit-constructor): a lambda is passed as it is
      : callable_(&callable), call_([](const void* it, int item) { (*static_cast<const Callable*>(it))(item); }) {}
  void operator()(int item) const { call_(callable_, item); }

 private:
  const void* callable_;
  void (*call_)(const void*, int);
};

/// Calls work(i) for every i in [0, count), on `threads` threads, the caller's among them; one thread means no others.
/// Items are handed out in order, so work must write only to item i's own place: then the result does not depend on
/// `threads`. The first exception (lowest i among those thrown) is rethrown when all have ended. May be called from
/// several threads at once and from within work. The other threads are kept from call to call, and with them whatever
/// work keeps in thread_local memory.
void parallel_for(int threads, int count, const ItemWork& work);

}  // namespace houghstream
