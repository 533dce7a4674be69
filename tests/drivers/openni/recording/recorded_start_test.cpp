#include "drivers/openni/recording/recorded_start.hpp"

#include <gtest/gtest.h>

namespace houghstream::openni {
namespace {

constexpr std::int64_t kOpened = 5'000'000;
constexpr std::int64_t kPeriod = 33'333;

/// What a sensor sees, image after image, with a noise of its own each.
std::vector<Remembered> seen(int count) {
  cv::RNG random(7);
  std::vector<Remembered> images;
  for (int i = 0; i < count; ++i) {
    SensorImage image{SensorImage::Sensor::kColour, static_cast<std::uint64_t>(kOpened + i * kPeriod), 0, i,
                      cv::Mat(48, 64, CV_8UC3)};
    random.fill(image.image, cv::RNG::UNIFORM, 100, 130);
    images.push_back(remember(image));
  }
  return images;
}

/// The images from `first` on as a recorder gives them: times from zero.
std::vector<Remembered> recorded_from(const std::vector<Remembered>& live, int first, int count) {
  std::vector<Remembered> recorded(live.begin() + first, live.begin() + first + count);
  for (Remembered& image : recorded) image.time_us -= live[first].time_us;
  return recorded;
}

TEST(RecordedStart, IsFoundAmongWhatWasSeen) {
  const std::vector<Remembered> live = seen(20);
  const auto start = find_recorded_start(recorded_from(live, 3, 8), live);
  ASSERT_TRUE(start.has_value());
  EXPECT_EQ(start->device_us, kOpened + 3 * kPeriod);
  EXPECT_EQ(start->difference, 0.0);
  EXPECT_EQ(start->images, 8U);
}

TEST(RecordedStart, IsFoundWhereEitherSideLacksImages) {
  std::vector<Remembered> live = seen(20);
  std::vector<Remembered> recorded = recorded_from(live, 3, 8);
  live.erase(live.begin() + 3);
  live.erase(live.begin() + 6);
  recorded.erase(recorded.begin() + 5);
  const auto start = find_recorded_start(recorded, live);
  ASSERT_TRUE(start.has_value());
  EXPECT_EQ(start->device_us, kOpened + 3 * kPeriod);
  EXPECT_EQ(start->difference, 0.0);
}

TEST(RecordedStart, IsFoundWhereRecordingHasLosses) {
  const std::vector<Remembered> live = seen(20);
  std::vector<Remembered> recorded = recorded_from(live, 5, 8);
  cv::RNG random(8);
  for (Remembered& image : recorded) {
    cv::Mat loss(image.some_pixels.size(), CV_8UC3);
    random.fill(loss, cv::RNG::UNIFORM, 0, 12);
    cv::Mat lossy = image.some_pixels + loss;  // the live image stays as it is
    image.some_pixels = lossy;
  }
  const auto start = find_recorded_start(recorded, live);
  ASSERT_TRUE(start.has_value());
  EXPECT_EQ(start->device_us, kOpened + 5 * kPeriod);
  EXPECT_GT(start->difference, 0.0);
}

TEST(RecordedStart, OfASensorThatSeesNothingIsTheEarliestWithAllImages) {
  std::vector<Remembered> live = seen(20);
  for (Remembered& image : live) image.some_pixels.setTo(0);
  EXPECT_EQ(find_recorded_start(recorded_from(live, 4, 8), live)->device_us, kOpened);
}

TEST(RecordedStart, IsUnknownWhereNothingOrTooLittleWasSeen) {
  const std::vector<Remembered> live = seen(20);
  EXPECT_FALSE(find_recorded_start({}, live).has_value());
  EXPECT_FALSE(find_recorded_start(recorded_from(live, 0, 8), {}).has_value());
  EXPECT_FALSE(find_recorded_start(recorded_from(live, 0, 8), {live.begin(), live.begin() + 3}).has_value());
}

}  // namespace
}  // namespace houghstream::openni
