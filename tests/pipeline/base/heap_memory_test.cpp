#include "pipeline/base/heap_memory.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

namespace houghstream {
namespace {

/// Returns how many heaps the allocator has, as it writes them.
int heap_count() {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* stream = open_memstream(&text, &size);
  malloc_info(0, stream);
  std::fclose(stream);
  const std::string info(text, size);
  std::free(text);
  int count = 0;
  for (std::size_t at = info.find("<heap nr="); at != std::string::npos; at = info.find("<heap nr=", at + 1)) ++count;
  return count;
}

/// Eight threads allocate, and all of them are there until the last has.
void allocate_in_threads() {
  constexpr int kThreads = 8;
  std::atomic<int> allocated{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&] {
      const std::vector<char> block(5000, 'x');
      allocated += block.back() == 'x' ? 1 : 0;
      while (allocated < kThreads) std::this_thread::yield();
    });
  }
  for (std::thread& thread : threads) thread.join();
}

// The allocator's heaps stay for the life of a process: the test has one of its own.
TEST(HeapMemory, AllThreadsAllocateFromOneHeap) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        share_one_heap();
        allocate_in_threads();
        std::exit(heap_count());
      },
      testing::ExitedWithCode(1), "");
}

}  // namespace
}  // namespace houghstream
