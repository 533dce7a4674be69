#include "pipeline/base/heap_memory.hpp"

#include <malloc.h>

#include <cstdlib>

namespace houghstream {

void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void share_one_heap() {
#ifdef __GLIBC__
  if (std::getenv("MALLOC_ARENA_MAX") == nullptr) mallopt(M_ARENA_MAX, 1);
#endif
}

}  // namespace houghstream
