#include "pipeline/base/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace houghstream {
namespace {

TEST(ParallelFor, EveryItemIsDoneOnceForAnyNumberOfThreads) {
  for (const int threads : {1, 2, 5}) {
    std::vector<int> done(1000, 0);
    parallel_for(threads, 1000, [&](int i) { ++done[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(done, std::vector<int>(1000, 1)) << threads << " threads";
  }
}

TEST(ParallelFor, NothingToDoIsFine) {
  parallel_for(2, 0, [](int) { FAIL() << "called"; });
}

TEST(ParallelFor, TheFirstErrorComesOut) {
  const auto work = [](int i) {
    if (i == 3 || i == 7) throw std::runtime_error("item " + std::to_string(i));
  };
  try {
    parallel_for(2, 10, work);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "item 3");
  }
}

TEST(ParallelFor, MayBeCalledFromWithinAndFromSeveralThreads) {
  std::atomic<int> done{0};
  const auto outer = [&] { parallel_for(3, 20, [&](int) { parallel_for(3, 20, [&](int) { ++done; }); }); };
  std::thread other(outer);
  outer();
  other.join();
  EXPECT_EQ(done, 2 * 20 * 20);
}

TEST(ParallelFor, KeepsItsThreads) {
  std::mutex mutex;
  std::set<std::thread::id> ids;
  for (int call = 0; call < 200; ++call) {
    parallel_for(2, 2, [&](int) {
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    });
  }
  EXPECT_LE(ids.size(), 2U);
}

TEST(ParallelFor, WhoWorksAloneGetsNoHelpers) {
  const auto threads_of = [] {
    std::mutex mutex;
    std::set<std::thread::id> ids;
    parallel_for(4, 64, [&](int) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    });
    return ids;
  };
  {
    const SerialScope alone;
    EXPECT_EQ(threads_of(), std::set<std::thread::id>{std::this_thread::get_id()});
    std::thread other([&] { EXPECT_GT(threads_of().size(), 1U) << "other threads are not meant"; });
    other.join();
  }
  EXPECT_GT(threads_of().size(), 1U);
}

TEST(ParallelFor, WhoWorksAloneGivesUpWhereItIsOver) {
  int done = 0;
  const auto work = [&] { parallel_for(4, 64, [&](int) { ++done; }); };
  {
    const SerialScope alone([&] { return done == 3; });
    EXPECT_THROW(work(), WorkCancelled);
  }
  EXPECT_EQ(done, 3);
  const SerialScope alone;
  done = 0;
  work();
  EXPECT_EQ(done, 64);
}

TEST(ParallelForWorkers, AWorkerDoesOneItemAtATime) {
  for (const int threads : {0, 1, 2, 5}) {
    const auto workers = static_cast<std::size_t>(std::max(threads, 1));
    std::vector<std::atomic<int>> at_work(workers);
    std::vector<int> by_worker(workers, 0);  // not atomic: each counts its own
    parallel_for_workers(threads, 1000, [&](int worker, int) {
      ASSERT_GE(worker, 0);
      ASSERT_LT(worker, static_cast<int>(workers));
      const auto w = static_cast<std::size_t>(worker);
      EXPECT_EQ(at_work[w]++, 0);
      ++by_worker[w];
      --at_work[w];
    });
    EXPECT_EQ(std::accumulate(by_worker.begin(), by_worker.end(), 0), 1000) << threads << " threads";
  }
}

TEST(PerWorker, MemoryStaysWhereItIsWhenThereAreMore) {
  PerWorker<std::vector<int>> memory;
  memory.resize(0);  // one worker works at any rate
  memory[0].assign(10, 7);
  const int* const before = memory[0].data();
  memory.resize(4);
  EXPECT_EQ(memory[0].data(), before);
  EXPECT_TRUE(memory[3].empty());
  memory.resize(2);
  EXPECT_TRUE(memory[3].empty());
}

}  // namespace
}  // namespace houghstream
