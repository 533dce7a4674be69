#include "pipeline/process/process_loop.hpp"

#include <unistd.h>

#include <filesystem>
#include <houghstream/status_t.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/event_log.hpp"
#include "tests/pipeline/process_test.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

/// A log with `count` empty results on channel X; removed in the end.
class SmallLog {
 public:
  explicit SmallLog(int count)
      : path(std::filesystem::temp_directory_path() / ("process_loop_test." + std::to_string(getpid()))) {
    LogWriter writer(path);
    for (int i = 0; i < count; ++i) {
      Detections none;
      none.frame.utime = i;
      const std::vector<std::uint8_t> bytes = encode_message(to_message(none));
      writer.write(i, "X", {bytes.data(), bytes.size()});
    }
    writer.close();
  }
  ~SmallLog() { std::filesystem::remove(path); }
  SmallLog(const SmallLog&) = delete;
  SmallLog& operator=(const SmallLog&) = delete;

  std::filesystem::path path;
};

TEST(ProcessLoop, EveryEventOfALogIsWorkedOnBeforeTheNextIsRead) {
  const SmallLog log(5);
  catch_stop_signals();
  LcmBus bus("file://" + log.path.string());
  StatusReporter status("test");
  std::vector<int> waiting;
  int events = 0;
  int worked = 0;
  bus.subscribe("X", [&](const ReceivedMessage&) { ++events; });
  run_process_loop(bus, status, [&](milliseconds) {
    if (worked == events) return false;
    waiting.push_back(events - worked++);
    return true;
  });
  EXPECT_EQ(waiting, std::vector<int>(5, 1));
}

TEST(ProcessLoop, ADamagedLogIsAnError) {
  const SmallLog log(3);
  std::filesystem::resize_file(log.path, std::filesystem::file_size(log.path) - 4);
  catch_stop_signals();
  LcmBus bus("file://" + log.path.string());
  StatusReporter status("test");
  EXPECT_THROW(run_process_loop(bus, status, [](milliseconds) { return false; }), InputError);
}

TEST(ProcessLoop, ALogThatIsStoppedWritesNothing) {
  const SmallLog log(5);
  const std::filesystem::path output = log.path.string() + ".out";
  {
    catch_stop_signals();
    LcmBus bus("file://" + log.path.string(), output.string());
    StatusReporter status("test");
    const WorkStep stop = [](milliseconds) {
      std::raise(SIGTERM);
      return false;
    };
    EXPECT_THROW(run_process_loop(bus, status, stop), InputError);
  }
  catch_stop_signals();
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST(ProcessLoop, OnANetworkReceivingGoesOnWhileWorkTakesItsTime) {
  ProcessOnMemq test({channel::kStatus});
  std::atomic<int> received{0};
  std::atomic<int> received_during_work{0};
  test.bus.subscribe("X", [&](const ReceivedMessage&) { ++received; });
  StatusReporter status("test");
  test.start([&](LcmBus& bus) {
    run_process_loop(bus, status, [&](milliseconds) {
      const int before = received;
      std::this_thread::sleep_for(milliseconds(100));
      received_during_work += received - before;
      return true;
    });
    end_process(bus, status);
  });
  for (int i = 0; i < 20; ++i) {
    test.bus.publish("X", to_message(Detections{}));
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_LT(test.stop(), 1000.0);
  EXPECT_EQ(received, 20);
  EXPECT_GT(received_during_work, 5) << "most come while work is done";
  ASSERT_GE(test.count(channel::kStatus), 1U) << "the last word at least";
  EXPECT_EQ(test.last<status_t>(channel::kStatus).process, "test");
}

}  // namespace
}  // namespace houghstream
