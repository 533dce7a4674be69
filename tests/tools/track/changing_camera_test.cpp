#include <gtest/gtest.h>

#include <houghstream/status_t.hpp>

#include "tests/pipeline/geometry/tetrahedron.hpp"
#include "tests/pipeline/process_test.hpp"
#include "tests/tools/track/one_bowl.hpp"
#include "tools/track/track_process.hpp"

// Objects when the frames of their camera change their size.

namespace houghstream::track {
namespace {

constexpr int kKnown = 10;  // frames, after which a bowl that is seen in each is an object

images_t sized_frame(int frame, int width, int height) {
  return to_message(make_test_frame(time_of(frame), width, height), WireFormat{}, frame);
}

/// Returns the message of a third-party driver.
images_t without_camera(images_t message) {
  for (image_t& image : message.images) {
    image.metadata.clear();
    image.nmetadata = 0;
  }
  return message;
}

/// A bowl behind what the frames' depth shows, and whether it is found.
void send_with_bowl(ProcessOnMemq& test, const images_t& message, bool found) {
  ObjectPoses poses = one_bowl(message.utime);
  if (!found) poses.poses.clear();
  test.bus.publish(channel::kFrame, message);
  test.bus.publish(channel::kPoses, to_message(poses));
}

std::function<void(LcmBus&)> tracking_bowls(const std::optional<Camera>& camera) {
  TrackProcessOptions options;
  options.wait_s = 0.02;
  options.camera = camera;
  return [options](LcmBus& bus) {
    auto models =
        std::make_shared<const tracks::TrackModels>(tracks::make_track_models({{"bowl", tetrahedron(0.4F)}}, {}));
    run_track_process(bus, options, [&] { return models; });
  };
}

TEST(ChangingCamera, AnObjectIsJudgedByFramesOfTheirNewSize) {
  ProcessOnMemq test({channel::kObjects, channel::kStatus});
  test.start(tracking_bowls(std::nullopt));
  for (int i = 0; i < 2 * kKnown; ++i) {
    const bool before = i < kKnown;
    send_with_bowl(test, before ? sized_frame(i, 64, 48) : sized_frame(i, 32, 24), before);
    ASSERT_TRUE(test.wait_for(channel::kObjects, static_cast<std::size_t>(i + 1))) << i;
  }
  test.stop();
  const WorldObjects last = world_from_message(test.last<objects_t>(channel::kObjects));
  ASSERT_EQ(last.objects.size(), 1U);
  EXPECT_EQ(last.objects[0].track_id, 1);
  EXPECT_EQ(last.objects[0].state, TrackState::kHidden) << last.objects[0].reason;
  EXPECT_EQ(test.last<status_t>(channel::kStatus).frames_refused, 0);
}

TEST(ChangingCamera, AFrameOfAnotherSizeThanTheCameraThatWasGivenIsRefusedAndTheNextGoodOneGoesOn) {
  ProcessOnMemq test({channel::kObjects, channel::kStatus});
  test.start(tracking_bowls(make_test_frame(0).camera));
  for (int i = 0; i < kKnown; ++i) {
    send_with_bowl(test, without_camera(sized_frame(i, 64, 48)), true);
    ASSERT_TRUE(test.wait_for(channel::kObjects, static_cast<std::size_t>(i + 1))) << i;
  }
  send_with_bowl(test, without_camera(sized_frame(kKnown, 32, 24)), false);
  send_with_bowl(test, without_camera(sized_frame(kKnown + 1, 64, 48)), false);
  ASSERT_TRUE(test.wait_for(channel::kObjects, kKnown + 1));
  test.stop();
  EXPECT_EQ(test.count(channel::kObjects), static_cast<std::size_t>(kKnown + 1));
  const WorldObjects last = world_from_message(test.last<objects_t>(channel::kObjects));
  EXPECT_EQ(last.frame.utime, sized_frame(kKnown + 1, 64, 48).utime);
  ASSERT_EQ(last.objects.size(), 1U);
  EXPECT_EQ(last.objects[0].track_id, 1);
  EXPECT_EQ(last.objects[0].state, TrackState::kHidden) << last.objects[0].reason;
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_refused, 1);
  EXPECT_NE(status.last_error.find("depth 32x24 and camera 64x48, expected equal sizes"), std::string::npos)
      << status.last_error;
}

}  // namespace
}  // namespace houghstream::track
