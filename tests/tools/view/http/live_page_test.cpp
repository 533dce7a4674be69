#include "tools/view/http/live_page.hpp"

#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "tests/tools/view/watched_bus.hpp"
#include "tools/view/frame_renderer.hpp"

namespace houghstream::view {
namespace {

ViewedFrame viewed_frame(std::int64_t utime, int width = 64, int height = 48) {
  ViewedFrame viewed;
  viewed.frame = make_test_frame(utime, width, height);
  viewed.detections.frame = viewed.frame.id;
  return viewed;
}

// Holds a page with a browser that may view it.
struct Looked {
  Looked() : client("127.0.0.1", page.server().port()) {}

  void show(const ViewedFrame& viewed) { page.show({viewed, models, settings, stream}); }

  /// Returns the image, while the page's own thread goes on as hs-view's loop does.
  cv::Mat fetched(const std::string& view, const ViewedFrame& viewed) {
    std::optional<httplib::Result> answer;
    std::atomic<bool> answered{false};
    std::thread browser([&] {
      answer = client.Get("/picture/" + view + ".jpg");
      answered = true;
    });
    while (!answered) {
      if (page.is_due()) page.catch_up(viewed, models, settings, stream);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    browser.join();
    const std::string bytes = (*answer)->body;
    return cv::imdecode(std::vector<char>(bytes.begin(), bytes.end()), cv::IMREAD_COLOR);
  }

  LivePage page{"127.0.0.1:0"};
  httplib::Client client;
  ClassModels models;
  FrameViewSettings settings;
  StreamView stream;
};

TEST(LivePage, ShowsTheWorldFromAboveAsItGoesOn) {
  Looked looked;
  looked.settings.show_world = true;
  looked.show(viewed_frame(5));
  const cv::Mat without = looked.fetched("world", viewed_frame(5));
  ASSERT_EQ(without.cols, 440);
  EXPECT_EQ(without.rows * viewed_frame(5).frame.colour.cols, 440 * viewed_frame(5).frame.colour.rows);
  TrackedObject mug;
  mug.track_id = 3;
  mug.state = TrackState::kVisible;
  WorldObjects world;
  world.frame = {"OPENNI_FRAME", 6};
  world.objects = {mug};
  looked.stream.state.world.emplace().add(world);
  looked.show(viewed_frame(6));
  EXPECT_GT(cv::norm(looked.fetched("world", viewed_frame(6)), without, cv::NORM_INF), 100.0);
}

TEST(LivePage, ShowsEachViewThatIsAskedFor) {
  Looked looked;
  const ViewedFrame viewed = viewed_frame(5);
  looked.show(viewed);
  for (const char* view : {"colour", "depth", "3d"}) {
    const cv::Mat image = looked.fetched(view, viewed);
    EXPECT_EQ(image.size(), viewed.frame.colour.size()) << view;
  }
}

TEST(LivePage, ARowOrAColumnOfPixelsIsAnImageOfModestSizeInEachView) {
  for (const cv::Size size : {cv::Size(16384, 1), cv::Size(1, 16384), cv::Size(1, 1)}) {
    Looked looked;
    looked.stream.state.teaching.emplace().progress = 0.5F;
    looked.stream.state.teaching->directions.resize(2);
    const ViewedFrame viewed = viewed_frame(5, size.width, size.height);
    looked.show(viewed);
    for (const char* view : {"colour", "depth", "3d", "world"}) {
      const cv::Mat image = looked.fetched(view, viewed);
      EXPECT_GE(image.total(), 1U) << view << size;
      EXPECT_LE(image.total(), 1'000'000U) << view << size;
    }
  }
}

TEST(LivePage, AViewThatCannotBeDrawnIsSaidToBeSoAndTheOthersAreDrawn) {
  Looked looked;
  ViewedFrame viewed = viewed_frame(5);
  looked.show(viewed);
  ViewedFrame wrong = viewed;
  wrong.detections.frame.utime = 6;  // time of another frame
  std::optional<httplib::Result> answer;
  std::atomic<bool> answered{false};
  std::thread browser([&] {
    answer = looked.client.Get("/picture/colour.jpg");
    answered = true;
  });
  int refused = 0;
  while (!answered) {
    try {
      if (looked.page.is_due()) looked.page.catch_up(wrong, looked.models, looked.settings, looked.stream);
    } catch (const InputError&) {
      ++refused;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  browser.join();
  EXPECT_EQ(refused, 1);
  EXPECT_EQ((*answer)->status, 503);
  EXPECT_EQ(looked.fetched("depth", viewed).size(), viewed.frame.colour.size());
}

TEST(LivePage, WithoutViewersNothingIsDue) {
  Looked looked;
  looked.show(viewed_frame(5));
  EXPECT_FALSE(looked.page.has_viewers());
  EXPECT_FALSE(looked.page.is_due());
}

TEST(LivePage, AFrameThatNobodyLooksAtIsSkippedUndrawn) {
  WatchedBus watched;
  FrameRendererSettings settings;
  settings.http = "127.0.0.1:0";
  FrameRenderer frame_show(settings);
  MatchedFrame cut = matched_frame(5);
  cut.frame_bytes.resize(cut.frame_bytes.size() / 2);  // would be refused if anybody decoded it
  frame_show.show(cut, watched.watcher);
  EXPECT_TRUE(frame_show.handle_keys(watched.watcher));
  const status_t status = watched.last_words();
  EXPECT_EQ(status.frames_skipped, 1);
  EXPECT_EQ(status.frames_refused, 0);
}

TEST(LivePage, TakesThePlaceOfAWindowAndABadAddressIsNamed) {
  FrameRendererSettings settings;
  settings.http = "8080";
  EXPECT_TRUE(settings.headless());
  EXPECT_FALSE(settings.writes());
  settings.http = "eighty";
  EXPECT_THROW(FrameRenderer{settings}, InputError);
  settings.http = "127.0.0.1:0";
  settings.http_hosts = {"robot:80"};
  EXPECT_THROW(FrameRenderer{settings}, InputError);
}

}  // namespace
}  // namespace houghstream::view
