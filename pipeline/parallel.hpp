#pragma once

#include <functional>

namespace houghstream {

/// Calls work(i) for every i in [0, count), on `threads` threads; one thread means no threads. Items are handed
/// out in order, so work must write only to item i's own place: then the result does not depend on `threads`.
/// The first exception (lowest i among those thrown) is rethrown after all threads have ended.
void parallel_for(int threads, int count, const std::function<void(int)>& work);

}  // namespace houghstream
