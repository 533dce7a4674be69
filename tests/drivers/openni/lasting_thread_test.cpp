#include "drivers/openni/lasting_thread.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

namespace houghstream::openni {
namespace {

TEST(LastingThread, ItsEndIsTheWorksEndAndTheNextWorkGetsTheSameThread) {
  std::thread::id first;
  std::thread::id second;
  {
    const LastingThread work([&] { first = std::this_thread::get_id(); });
  }
  {
    const LastingThread work([&] { second = std::this_thread::get_id(); });
  }
  EXPECT_NE(first, std::thread::id());
  EXPECT_NE(first, std::this_thread::get_id());
  EXPECT_EQ(first, second);
}

TEST(LastingThread, TwoWorksRunBesideEachOther) {
  std::promise<void> to_first;
  std::promise<void> to_second;
  const LastingThread first([&] {
    to_second.set_value();
    to_first.get_future().wait();
  });
  const LastingThread second([&] {
    to_second.get_future().wait();
    to_first.set_value();
  });
}

}  // namespace
}  // namespace houghstream::openni
