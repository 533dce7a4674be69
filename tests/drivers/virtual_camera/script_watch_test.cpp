#include "drivers/virtual_camera/script_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/test_files.hpp"

namespace houghstream::virtual_camera {
namespace {

TEST(ScriptWatch, NoticesAChangeAndOutlivesAMistake) {
  const auto file = fresh_folder("script_watch") / "script";
  write_text(file, "plugged yes\n");
  ScriptWatch watch(file);
  std::atomic<int> changes{0};
  watch.start([&](const CameraScript& before, const CameraScript& after) {
    EXPECT_NE(before.plugged, after.plugged);
    ++changes;
  });
  const auto replace = [&](const std::string& text) {
    write_text(file.string() + ".new", text);
    std::filesystem::rename(file.string() + ".new", file);
  };
  replace("plugged maybe\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(watch.current()->plugged) << "as before";
  replace("plugged no\n");
  for (int i = 0; i < 500 && changes == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(changes, 1);
  EXPECT_FALSE(watch.current()->plugged);
}

// The clock that stamps files ticks every few milliseconds only.
TEST(ScriptWatch, NoticesAChangeThatKeepsTheFilesTime) {
  const auto file = fresh_folder("script_watch_time") / "script";
  write_text(file, "plugged yes\n");
  const auto time = std::filesystem::last_write_time(file);
  ScriptWatch watch(file);
  watch.start([](const CameraScript&, const CameraScript&) {});
  write_text(file.string() + ".new", "plugged no\n");
  std::filesystem::last_write_time(file.string() + ".new", time);
  std::filesystem::rename(file.string() + ".new", file);
  for (int i = 0; i < 500 && watch.current()->plugged; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(watch.current()->plugged);
}

}  // namespace
}  // namespace houghstream::virtual_camera
