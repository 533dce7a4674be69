#include "tools/view/viewer.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::view {
namespace {

ViewerSettings silent_stream(const std::string& name) {
  ViewerSettings settings;
  settings.lcm_url = "memq://";
  settings.show.outputs.snapshot = fresh_folder("viewer_" + name) / "shot.png";
  return settings;
}

TEST(ViewerSettings, FilesOrThePreviewTakeThePlaceOfAWindow) {
  FrameRendererSettings settings;
  EXPECT_FALSE(settings.headless());
  settings.preview = true;
  EXPECT_TRUE(settings.headless());
  settings = {};
  settings.outputs.video = "video.mp4";
  EXPECT_TRUE(settings.headless());
}

TEST(Viewer, ASilentStreamEndsWithItsDurationAndIsAnError) {
  ViewerSettings settings = silent_stream("duration");
  settings.duration = 0.1;
  EXPECT_THROW(run_viewer(settings), InputError);
  EXPECT_FALSE(std::filesystem::exists(settings.show.outputs.snapshot));
}

TEST(Viewer, AStopSignalEndsIt) {
  ViewerSettings settings;
  settings.lcm_url = "memq://";
  settings.show.preview = true;
  std::thread user([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    std::raise(SIGTERM);
  });
  EXPECT_NO_THROW(run_viewer(settings));
  user.join();
}

TEST(Viewer, FilesAreFinishedBeforeTheLastWordWhichMayFail) {
  ViewerSettings settings = silent_stream("gone");
  settings.lcm_url = "tcpq://127.0.0.1:1";  // without a server
  settings.duration = 0.1;
  const std::string error = error_of([&] { run_viewer(settings); });
  EXPECT_NE(error, "");
  EXPECT_EQ(error.find("could not be published"), std::string::npos) << error;
}

TEST(Viewer, ABusThatIsNoneIsAnError) {
  ViewerSettings settings = silent_stream("bus");
  settings.lcm_url = "nosuch://";
  EXPECT_THROW(run_viewer(settings), InputError);
}

}  // namespace
}  // namespace houghstream::view
