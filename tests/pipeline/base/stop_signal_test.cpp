#include "pipeline/base/stop_signal.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

namespace houghstream {
namespace {

TEST(StopSignal, BothOnlySetAFlagWhichAFreshStartClears) {
  for (const int number : {SIGINT, SIGTERM}) {
    catch_stop_signals();
    EXPECT_FALSE(stop_requested());
    std::raise(number);
    EXPECT_TRUE(stop_requested());
    EXPECT_TRUE(stop_requested()) << "it stays";
  }
  catch_stop_signals();
  EXPECT_FALSE(stop_requested());
}

TEST(StopSignal, ASecondOneLaterEndsAProgramThatHangs) {
  const pid_t child = fork();
  if (child == 0) {
    catch_stop_signals();
    std::raise(SIGTERM);
    std::raise(SIGTERM);  // the same request by another way
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    std::raise(SIGTERM);
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
}

TEST(StopSignal, ReleasedTheyEndTheProgramAgain) {
  const pid_t child = fork();
  if (child == 0) {
    catch_stop_signals();
    release_stop_signals();
    std::raise(SIGINT);
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
}

bool takes(int number) {
  sigset_t blocked;
  pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
  return sigismember(&blocked, number) == 0;
}

TEST(BlockStopSignals, ThreadsThatAreStartedMeanwhileNeverGetThem) {
  bool threads_takes = true;
  {
    const BlockStopSignals block;
    std::thread([&] { threads_takes = takes(SIGINT) || takes(SIGTERM); }).join();
  }
  EXPECT_FALSE(threads_takes);
  EXPECT_TRUE(takes(SIGINT) && takes(SIGTERM)) << "this thread does, as before";
  std::thread([&] { threads_takes = takes(SIGINT) && takes(SIGTERM); }).join();
  EXPECT_TRUE(threads_takes);
}

}  // namespace
}  // namespace houghstream
