#include "tools/view/teaching_starter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tests/test_files.hpp"

namespace houghstream::view {
namespace {

using Words = std::vector<std::string>;

TeachingOrder order_at(const std::filesystem::path& executables) {
  TeachingOrder order;
  order.executables = executables;
  order.channel = "LEFT";
  return order;
}

TEST(TeachingStarter, TheCommandNamesStreamStoreAndObject) {
  TeachingOrder order = order_at("/bin");
  order.store = "my.store";
  order.name = "object_3";
  EXPECT_EQ(teaching_command(order), (Words{"/bin/hs-teach", "show", "--from-stream", "--name", "object_3", "--out",
                                            "my.store", "--channel", "LEFT", "--add"}));
  order.lcm_url = "udpm://x";
  order.box = cv::Rect(1, 2, 30, 40);
  const Words words = teaching_command(order);
  order.joins_others = false;
  const Words first = teaching_command(order);
  EXPECT_EQ(std::count(first.begin(), first.end(), "--add"), 0) << "the first object makes the store";
  EXPECT_EQ(Words(words.end() - 4, words.end()), (Words{"--lcm-url", "udpm://x", "--box", "1,2,30,40"}));
  order.box.reset();
  order.at = cv::Point(7, 8);
  const Words clicked = teaching_command(order);
  EXPECT_EQ(Words(clicked.end() - 2, clicked.end()), (Words{"--at", "7,8"}));
}

TEST(TeachingStarter, ANameThatNobodyHas) {
  EXPECT_EQ(free_name({}), "object_1");
  EXPECT_EQ(free_name({"object_1", "mug", "object_3"}), "object_2");
}

bool comes_true(const std::function<bool()>& what) {
  for (int i = 0; i < 1000 && !what(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return what();
}

TEST(TeachingStarter, TheKeyStartsItAndEndsItsTakeOnce) {
  const std::filesystem::path folder = fresh_folder("starter");
  write_text(folder / "hs-teach",
             "#!/bin/sh\n"
             "trap 'echo take >>\"$6\"; sleep 0.5; echo taught >>\"$6\"; exit 0' INT\n"
             "echo start >>\"$6\"\n"
             "while :; do sleep 0.05; done\n");
  std::filesystem::permissions(folder / "hs-teach", std::filesystem::perms::owner_all);
  const std::filesystem::path said = folder / "said";
  TeachingOrder order = order_at(folder);
  order.store = said.string();
  order.name = "object_1";
  TeachingStarter starter;
  EXPECT_FALSE(starter.runs());
  starter.press(order);
  ASSERT_TRUE(comes_true([&] { return read_text(said) == "start\n"; }));
  EXPECT_TRUE(starter.runs());
  starter.press(order);
  ASSERT_TRUE(comes_true([&] { return read_text(said) == "start\ntake\n"; })) << read_text(said);
  starter.press(order);
  ASSERT_TRUE(comes_true([&] { return !starter.runs(); }));
  EXPECT_EQ(read_text(said), "start\ntake\ntaught\n") << "a further press leaves it alone";
  starter.press(order);
  ASSERT_TRUE(comes_true([&] { return read_text(said) == "start\ntake\ntaught\nstart\n"; })) << "the next one";
  TeachingStarter without;
  without.press(order_at(folder / "nowhere"));
  EXPECT_FALSE(without.runs());
}

}  // namespace
}  // namespace houghstream::view
