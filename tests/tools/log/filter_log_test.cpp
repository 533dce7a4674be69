#include "tools/log/filter_log.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

class FilterLog : public testing::Test {
 protected:
  /// Writes ten events a second apart, even ones on A_ONE, odd ones on B.
  FilterLog() : folder(fresh_folder("filter_log")) {
    LogWriter writer(folder / "in");
    for (int i = 0; i < 10; ++i) {
      const std::vector<std::uint8_t> data(5, static_cast<std::uint8_t>(i));
      writer.write(1'000'000'000 + 1'000'000 * i, i % 2 == 0 ? "A_ONE" : "B", {data.data(), data.size()});
    }
    writer.close();
  }

  /// Returns the numbers of the events that pass.
  std::vector<int> pass(const LogFilter& filter) const {
    LossReport losses;
    const std::int64_t count = filter_log(folder / "in", filter, folder / "out", losses);
    std::vector<int> numbers;
    LogReader log(folder / "out");
    while (const auto event = log.next()) {
      EXPECT_EQ(event->timestamp, 1'000'000'000 + 1'000'000 * event->data[0]);
      EXPECT_EQ(event->channel, event->data[0] % 2 == 0 ? "A_ONE" : "B");
      numbers.push_back(event->data[0]);
    }
    EXPECT_EQ(count, static_cast<std::int64_t>(numbers.size()));
    return numbers;
  }

  fs::path folder;
};

TEST_F(FilterLog, ByTime) {
  LogFilter filter;
  filter.start_s = 2.5;
  filter.end_s = 6.0;
  EXPECT_EQ(pass(filter), (std::vector<int>{3, 4, 5, 6}));
}

TEST_F(FilterLog, ByChannel) {
  LogFilter filter;
  filter.channels = "A_.*";
  EXPECT_EQ(pass(filter), (std::vector<int>{0, 2, 4, 6, 8}));
  filter.others = true;
  EXPECT_EQ(pass(filter), (std::vector<int>{1, 3, 5, 7, 9}));
  filter.channels = "A";  // not the whole name
  EXPECT_EQ(pass(filter).size(), 10U);
}

/// Filters a log whose events have these dates, seconds; returns the events that it keeps and the output.
class DatedLog {
 public:
  explicit DatedLog(const std::vector<double>& dates_s) : folder_(fresh_folder("filter_log_dates")) {
    LogWriter writer(folder_ / "in");
    for (const double date : dates_s) {
      const std::uint8_t data = 0;
      writer.write(static_cast<std::int64_t>(1e6 * date), "A", {&data, 1});
    }
    writer.close();
  }
  std::int64_t kept(const LogFilter& filter) {
    LossReport losses;
    const std::int64_t count = filter_log(folder_ / "in", filter, folder_ / "out", losses);
    words = losses.line();
    return count;
  }
  std::string words;

 private:
  fs::path folder_;
};

TEST(FilterLogDates, NothingIsDroppedUnlessAskedAndWhatLooksWrongIsSaid) {
  DatedLog flipped({4.6e12, 1e6, 1e6 + 1, 1e6 + 2, 1e6 + 3});  // a bit of the first date
  EXPECT_EQ(flipped.kept({}), 5);
  EXPECT_NE(flipped.words.find("jumps by more than an hour"), std::string::npos) << flipped.words;
  LogFilter from_second_two;
  from_second_two.start_s = 2.0;
  from_second_two.end_s = 10.0;
  EXPECT_EQ(flipped.kept(from_second_two), 2) << "counted from the first date that fits";

  DatedLog set_back({10'000, 10'001, 10'002, 6'403, 6'404});
  EXPECT_EQ(set_back.kept({}), 5);
  EXPECT_NE(set_back.words.find("2 events are dated before the log's first one, by up to 3597"), std::string::npos)
      << set_back.words;
  LogFilter from_start;
  from_start.start_s = 0.0;
  EXPECT_EQ(set_back.kept(from_start), 3);
  EXPECT_NE(set_back.words.find("2 events"), std::string::npos) << set_back.words;

  DatedLog healthy({1.0, 2.0, 3.0});
  EXPECT_EQ(healthy.kept({}), 3);
  EXPECT_EQ(healthy.words, "");
}

TEST_F(FilterLog, WhatMakesNoSenseIsRefused) {
  LogFilter filter;
  filter.channels = "(";
  EXPECT_THROW(pass(filter), InputError);
  filter = {};
  filter.start_s = 100.0;
  fs::remove(folder / "out");
  expect_says(error_of([&] { pass(filter); }),
              {"no event from 100 s to its end on channels '.*'; it lasts 9.000 s, on A_ONE, B"});
  filter.end_s = 50.0;
  expect_says(error_of([&] { pass(filter); }), {"from 100 s to 50 s, expected an end that is not before the start"});
  EXPECT_FALSE(fs::exists(folder / "out")) << "nothing is written where nothing passes";
  LossReport losses;
  EXPECT_THROW(filter_log(folder / "in", {}, folder / "in", losses), InputError);
  EXPECT_GT(fs::file_size(folder / "in"), 300U);
}

}  // namespace
}  // namespace houghstream::log_tools
