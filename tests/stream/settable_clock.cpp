// A host's clock that a test may set: loaded before the C library (LD_PRELOAD), it adds the whole seconds in the file
// that HOUGHSTREAM_SETTABLE_CLOCK names, a binary int64, to what a program reads of the time of day, and takes them off
// the times of day until which it waits. Clocks that nobody sets are left alone.

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <ctime>

namespace {

const volatile std::int64_t* map_seconds() {
  const char* file = std::getenv("HOUGHSTREAM_SETTABLE_CLOCK");
  const int descriptor = file == nullptr ? -1 : open(file, O_RDONLY | O_CLOEXEC);
  void* mapped = mmap(nullptr, sizeof(std::int64_t), PROT_READ, MAP_SHARED, descriptor, 0);
  if (descriptor >= 0) close(descriptor);
  return mapped == MAP_FAILED ? nullptr : static_cast<const volatile std::int64_t*>(mapped);
}

std::int64_t added_seconds() {
  static const volatile std::int64_t* const seconds = map_seconds();
  return seconds == nullptr ? 0 : *seconds;
}

/// Other clocks count from the machine's start.
bool is_time_of_day(const timespec& time) {
  constexpr time_t kNoUptime = 1'000'000'000;
  return time.tv_sec - added_seconds() > kNoUptime;
}

timespec as_the_kernel_has_it(const timespec& time) {
  timespec out = time;
  if (is_time_of_day(time)) out.tv_sec -= added_seconds();
  return out;
}

template <typename Function>
Function* next_of(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* out) noexcept {
  const auto status = static_cast<int>(syscall(SYS_clock_gettime, clock, out));
  if (status == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) out->tv_sec += added_seconds();
  return status;
}

extern "C" int gettimeofday(timeval* out, void* /*zone*/) noexcept {
  timespec now{};
  const int status = clock_gettime(CLOCK_REALTIME, &now);
  out->tv_sec = now.tv_sec;
  out->tv_usec = now.tv_nsec / 1000;
  return status;
}

extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  static auto* const next = next_of<decltype(pthread_cond_timedwait)>("pthread_cond_timedwait");
  const timespec real = as_the_kernel_has_it(*until);
  return next(condition, mutex, &real);
}

extern "C" int sem_timedwait(sem_t* semaphore, const timespec* until) {
  static auto* const next = next_of<decltype(sem_timedwait)>("sem_timedwait");
  const timespec real = as_the_kernel_has_it(*until);
  return next(semaphore, &real);
}

extern "C" time_t time(time_t* out) noexcept {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}
