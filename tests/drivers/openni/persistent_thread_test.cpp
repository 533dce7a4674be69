#include "drivers/openni/persistent_thread.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

namespace houghstream::openni {
namespace {

TEST(PersistentThread, ItsEndIsTheWorksEndAndTheNextWorkGetsTheSameThread) {
  std::thread::id first;
  std::thread::id second;
  {
    const PersistentThread work([&] { first = std::this_thread::get_id(); });
  }
  {
    const PersistentThread work([&] { second = std::this_thread::get_id(); });
  }
  EXPECT_NE(first, std::thread::id());
  EXPECT_NE(first, std::this_thread::get_id());
  EXPECT_EQ(first, second);
}

TEST(PersistentThread, TwoWorksRunBesideEachOther) {
  std::promise<void> to_first;
  std::promise<void> to_second;
  const PersistentThread first([&] {
    to_second.set_value();
    to_first.get_future().wait();
  });
  const PersistentThread second([&] {
    to_second.get_future().wait();
    to_first.set_value();
  });
}

}  // namespace
}  // namespace houghstream::openni
