#include "tools/view/http/page_board.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace houghstream::view {
namespace {

constexpr std::chrono::milliseconds kNow(0);
constexpr std::chrono::milliseconds kLong(10'000);

TEST(PageBoard, WithoutViewersNothingIsWanted) {
  PageBoard board;
  EXPECT_FALSE(board.has_viewers());
  EXPECT_TRUE(board.join());
  EXPECT_TRUE(board.has_viewers());
  EXPECT_TRUE(board.wanted().empty());
  board.leave();
  EXPECT_FALSE(board.has_viewers());
  EXPECT_EQ(board.image(PageView::kDepth, kNow).jpeg, nullptr);
  EXPECT_TRUE(board.has_viewers());
  EXPECT_EQ(board.wanted(), std::vector<PageView>{PageView::kDepth});
}

TEST(PageBoard, EachSeesTheNewestOnce) {
  PageBoard board;
  board.put_frame("a");
  board.put_frame("b");
  board.put_stream("s");
  const std::optional<PageUpdates> first = board.updates_after({}, kNow);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->frame, "b");
  EXPECT_EQ(first->stream, "s");
  board.put_stream("t");
  const std::optional<PageUpdates> second = board.updates_after(*first, kNow);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->frame, "");
  EXPECT_EQ(second->stream, "t");
  EXPECT_EQ(board.updates_after(*second, kNow)->stream, "");
}

TEST(PageBoard, AnImageThatIsWaitedForIsMissing) {
  PageBoard board;
  board.put_frame("a");
  EXPECT_TRUE(board.missing().empty());
  PageImage seen;
  std::thread viewer([&] { seen = board.image(PageView::k3d, kLong); });
  while (board.missing().empty()) std::this_thread::yield();
  EXPECT_EQ(board.missing(), std::vector<PageView>{PageView::k3d});
  board.put_image(PageView::k3d, {1, 2, 3});
  viewer.join();
  ASSERT_TRUE(seen.jpeg);
  EXPECT_EQ(seen.jpeg->size(), 3U);
  EXPECT_EQ(seen.frame_number, 1);
  EXPECT_TRUE(board.missing().empty());
}

TEST(PageBoard, AnImageNamesTheFrameThatItWasDrawnOf) {
  PageBoard board;
  board.put_frame("a");
  board.put_image(PageView::kColour, {1});
  board.put_frame("b");
  EXPECT_EQ(board.image(PageView::kColour, kNow).frame_number, 1) << "the second frame's image is not drawn yet";
  EXPECT_EQ(board.updates_after({}, kNow)->frame_number, 2);
}

TEST(PageBoard, OrdersAreTakenOnceAndTheLastCounts) {
  PageBoard board;
  EXPECT_TRUE(board.pop_commands().empty());
  PageCommands commands;
  commands.paused = true;
  commands.next_camera = true;
  board.push_command(commands);
  commands = {};
  commands.paused = false;
  commands.min_score = 0.25F;
  board.push_command(commands);
  const PageCommands taken = board.pop_commands();
  EXPECT_EQ(taken.paused, false);
  EXPECT_EQ(taken.min_score, 0.25F);
  EXPECT_TRUE(taken.next_camera);
  EXPECT_TRUE(board.pop_commands().empty());
}

TEST(PageBoard, NotMoreThanSoManyListen) {
  PageBoard board;
  for (int i = 0; i < PageBoard::kMaxViewers; ++i) EXPECT_TRUE(board.join());
  EXPECT_FALSE(board.join());
  board.leave();
  EXPECT_TRUE(board.join());
}

TEST(PageBoard, ClosingLetsAllGo) {
  PageBoard board;
  std::thread viewer([&] { EXPECT_FALSE(board.updates_after({}, kLong)); });
  board.close();
  viewer.join();
}

}  // namespace
}  // namespace houghstream::view
