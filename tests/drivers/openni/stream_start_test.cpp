#include "drivers/openni/stream_start.hpp"

#include <gtest/gtest.h>

namespace houghstream::openni {
namespace {

constexpr std::int64_t kOpened = 5'000'000;
constexpr std::int64_t kPeriod = 33'333;

/// Returns images of a sensor, each with independent noise.
std::vector<ImageThumbnail> seen(int count) {
  cv::RNG random(7);
  std::vector<ImageThumbnail> images;
  for (int i = 0; i < count; ++i) {
    SensorImage image;
    image.sensor = SensorImage::Sensor::kColour;
    image.device_us = static_cast<std::uint64_t>(kOpened + i * kPeriod);
    image.number = i;
    image.image = cv::Mat(48, 64, CV_8UC3);
    random.fill(image.image, cv::RNG::UNIFORM, 100, 130);
    images.push_back(make_thumbnail(image));
  }
  return images;
}

/// Returns the images from `first` on as a recorder gives them: times from zero.
std::vector<ImageThumbnail> recorded_from(const std::vector<ImageThumbnail>& live, int first, int count) {
  std::vector<ImageThumbnail> recorded(live.begin() + first, live.begin() + first + count);
  for (ImageThumbnail& image : recorded) image.time_us -= live[first].time_us;
  return recorded;
}

/// Returns only every `step`-th image.
std::vector<ImageThumbnail> some_of(const std::vector<ImageThumbnail>& images, std::size_t step) {
  std::vector<ImageThumbnail> some;
  for (std::size_t i = 0; i < images.size(); i += step) some.push_back(images[i]);
  return some;
}

/// Makes two streams of the same scene.
std::optional<RecordedStarts> starts_in(const std::vector<ImageThumbnail>& recorded,
                                        const std::vector<ImageThumbnail>& live) {
  return find_stream_starts({recorded, recorded}, {live, live});
}

TEST(StreamStart, IsFoundAmongWhatWasSeen) {
  const std::vector<ImageThumbnail> live = seen(20);
  const auto starts = find_stream_starts({recorded_from(live, 3, 8), recorded_from(live, 4, 8)}, {live, live});
  ASSERT_TRUE(starts.has_value());
  EXPECT_EQ(starts->depth.device_us, kOpened + 3 * kPeriod);
  EXPECT_EQ(starts->colour.device_us, kOpened + 4 * kPeriod);
  EXPECT_EQ(starts->colour.difference, 0.0);
  EXPECT_EQ(starts->colour.images, 8U);
}

TEST(StreamStart, IsFoundWhereEitherSideLacksImages) {
  std::vector<ImageThumbnail> live = seen(20);
  std::vector<ImageThumbnail> recorded = recorded_from(live, 3, 8);
  live.erase(live.begin() + 3);
  live.erase(live.begin() + 6);
  recorded.erase(recorded.begin() + 5);
  const auto starts = starts_in(recorded, live);
  ASSERT_TRUE(starts.has_value());
  EXPECT_EQ(starts->depth.device_us, kOpened + 3 * kPeriod);
  EXPECT_EQ(starts->depth.difference, 0.0);
}

TEST(StreamStart, IsFoundWhereABusyMachineSawOneOfFour) {
  const std::vector<ImageThumbnail> all = seen(60);
  const auto starts = starts_in(recorded_from(all, 5, 24), some_of(all, 4));
  ASSERT_TRUE(starts.has_value());
  EXPECT_EQ(starts->colour.device_us, kOpened + 5 * kPeriod);
  EXPECT_EQ(starts->colour.difference, 0.0);
}

TEST(StreamStart, IsTheOneTogetherWithTheOtherStreamWhereImagesComeAgain) {
  constexpr int kRound = 30;
  std::vector<ImageThumbnail> live = seen(3 * kRound);
  for (std::size_t i = kRound; i < live.size(); ++i) live[i].some_pixels = live[i - kRound].some_pixels;
  const std::vector<ImageThumbnail> recorded = recorded_from(live, 2, 8);
  std::vector<ImageThumbnail> colour = live;
  colour.erase(colour.begin() + 4);  // the first round lacks one that the second has
  const auto starts = find_stream_starts({recorded, recorded}, {{live.begin(), live.begin() + kRound}, colour});
  ASSERT_TRUE(starts.has_value());
  EXPECT_EQ(starts->depth.device_us, kOpened + 2 * kPeriod);
  EXPECT_EQ(starts->colour.device_us, kOpened + 2 * kPeriod);
}

TEST(StreamStart, IsFoundWhereRecordingHasLosses) {
  const std::vector<ImageThumbnail> live = seen(20);
  const std::vector<ImageThumbnail> depth = recorded_from(live, 5, 8);
  std::vector<ImageThumbnail> colour = depth;
  cv::RNG random(8);
  for (ImageThumbnail& image : colour) {
    cv::Mat loss(image.some_pixels.size(), CV_8UC3);
    random.fill(loss, cv::RNG::UNIFORM, 0, 12);
    cv::Mat lossy = image.some_pixels + loss;  // the live image stays as it is
    image.some_pixels = lossy;
  }
  const auto starts = find_stream_starts({depth, colour}, {live, live});
  ASSERT_TRUE(starts.has_value());
  EXPECT_EQ(starts->colour.device_us, kOpened + 5 * kPeriod);
  EXPECT_GT(starts->colour.difference, 0.0);
}

TEST(StreamStart, OfASensorThatSeesNothingIsThatOfTheOther) {
  const std::vector<ImageThumbnail> live = seen(20);
  std::vector<ImageThumbnail> blind;
  for (const ImageThumbnail& image : live)
    blind.push_back({image.time_us, cv::Mat::zeros(image.some_pixels.size(), CV_8UC3)});
  const auto starts = find_stream_starts({recorded_from(blind, 0, 8), recorded_from(live, 4, 8)}, {blind, live});
  EXPECT_EQ(starts->depth.device_us, kOpened + 4 * kPeriod);
  EXPECT_EQ(starts_in(recorded_from(blind, 4, 8), blind)->depth.device_us, kOpened) << "of both: the earliest";
}

TEST(StreamStart, IsUnknownWhereNothingOrTooLittleWasSeen) {
  const std::vector<ImageThumbnail> live = seen(20);
  EXPECT_FALSE(starts_in({}, live).has_value());
  EXPECT_FALSE(starts_in(recorded_from(live, 0, 8), {}).has_value());
  EXPECT_FALSE(starts_in(recorded_from(live, 0, 8), {live.begin(), live.begin() + 3}).has_value());
}

}  // namespace
}  // namespace houghstream::openni
