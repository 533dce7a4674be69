#include "tools/foxglove/foxglove_messages.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream::foxglove {
namespace {

using Messages = std::vector<FoxgloveMessage>;

std::vector<std::string> topics_of(const Messages& messages) {
  std::vector<std::string> topics;
  for (const FoxgloveMessage& message : messages) topics.push_back(message.topic);
  return topics;
}

bool holds(const FoxgloveMessage& message, const std::string& part) {
  return message.data.find(part) != std::string::npos;
}

const FoxgloveMessage& find_topic(const Messages& messages, const std::string& topic) {
  const auto found = std::find_if(messages.begin(), messages.end(), [&](const auto& m) { return m.topic == topic; });
  require(found != messages.end(), "no message on {}", topic);
  return *found;
}

ReportedObject followed(const std::string& name, double z) {
  ReportedObject object;
  object.pose.emplace();
  object.pose->class_name = name;
  object.pose->status = PoseStatus::kValid;
  object.pose->detection_score = 0.5F;
  object.pose->T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, z));
  return object;
}

ReportedObjects objects_of(std::vector<ReportedObject> objects) {
  ReportedObjects all;
  all.frame = {"CAM", 5};
  all.objects = std::move(objects);
  return all;
}

TEST(FoxgloveMessages, NumbersObjectsOfOneClass) {
  FoxgloveMessages messages({});
  const Messages sent = messages.convert_objects(objects_of({followed("mug", 1.0), followed("mug", 2.0)}));
  EXPECT_EQ(topics_of(sent),
            (std::vector<std::string>{"/CAM/annotations", "/transforms", "/CAM/objects/mug", "/CAM/objects/mug_2"}));
  EXPECT_TRUE(holds(sent[1], "CAM/mug_2"));
}

TEST(FoxgloveMessages, NamesAnObjectWithoutABoxWhereItsOriginIs) {
  FoxgloveMessages messages({});
  const auto label = [&] {
    return holds(messages.convert_objects(objects_of({followed("mug", 1.0)}))[0], "mug 0.50, quality");
  };
  EXPECT_FALSE(label()) << "no camera is known yet";
  messages.convert_frame(to_message(make_test_frame(5), WireFormat(), 0), "CAM", std::nullopt);
  EXPECT_TRUE(label());
  EXPECT_FALSE(holds(messages.convert_objects(objects_of({followed("mug", 0.0)}))[0], "mug 0.50"))
      << "an origin in the lens has no place in the image";
}

TEST(FoxgloveMessages, SendsAModelWhenItAppearsAndDeletesItWhenItIsGone) {
  FoxgloveMessages messages({});
  const ReportedObjects one = objects_of({followed("mug", 1.0)});
  EXPECT_EQ(messages.convert_objects(one).size(), 3U);
  EXPECT_EQ(messages.convert_objects(one).size(), 2U) << "it is there already";
  const Messages gone = messages.convert_objects(objects_of({}));
  EXPECT_EQ(topics_of(gone), (std::vector<std::string>{"/CAM/annotations", "/CAM/objects/mug"}));
  EXPECT_EQ(messages.convert_objects(one).size(), 3U) << "it is there again";
}

TEST(FoxgloveMessages, CamerasDoNotDeleteOneAnothersObjects) {
  FoxgloveMessages messages({});
  messages.convert_objects(objects_of({followed("mug", 1.0)}));
  ReportedObjects other = objects_of({});
  other.frame.channel = "SIDE";
  EXPECT_EQ(topics_of(messages.convert_objects(other)), (std::vector<std::string>{"/SIDE/annotations"}));
}

TEST(FoxgloveMessages, AFrameWithoutIntrinsicsHasNoCalibration) {
  images_t frame = to_message(make_test_frame(5), WireFormat(), 0);
  frame.images[0].metadata.clear();
  frame.images[0].nmetadata = 0;
  FoxgloveMessages messages({});
  EXPECT_EQ(topics_of(messages.convert_frame(frame, "CAM", std::nullopt)),
            (std::vector<std::string>{"/CAM/colour", "/CAM/depth"}));
  const Messages sent = messages.convert_frame(frame, "CAM", make_test_frame(5).camera);
  EXPECT_EQ(sent.at(2).topic, "/CAM/calibration");
  EXPECT_TRUE(holds(sent[0], std::string(frame.images[0].data.begin(), frame.images[0].data.end())))
      << "a JPEG stays as it is";
}

TEST(FoxgloveMessages, AFrameThatIsDamagedIsRefused) {
  images_t frame = to_message(make_test_frame(5), WireFormat(), 0);
  frame.images[0].data.resize(100);
  frame.images[0].size = 100;
  FoxgloveMessages messages({});
  EXPECT_NE(error_of([&] { messages.convert_frame(frame, "CAM", std::nullopt); }), "");
}

WorldObjects world_of(const std::string& world, TrackState state) {
  WorldObjects objects;
  objects.frame = {"CAM", 7};
  objects.world = world;
  TrackedObject mug;
  mug.track_id = 3;
  mug.class_name = "mug";
  mug.state = state;
  objects.objects = {mug};
  return objects;
}

TEST(FoxgloveMessages, AWorldOfItsCameraAloneHasNoTransformOfIt) {
  FoxgloveMessages messages({});
  const Messages own = messages.convert_world(world_of("CAM", TrackState::kHidden), std::nullopt);
  EXPECT_EQ(topics_of(own), (std::vector<std::string>{"/transforms", "/objects/mug_3"}));
  EXPECT_FALSE(holds(own[0], "WORLD"));
  const Messages world = messages.convert_world(world_of("WORLD", TrackState::kHidden), std::nullopt);
  EXPECT_TRUE(holds(world[0],
                    "\x12\x05WORLD\x1a\x03"
                    "CAM"))
      << "the camera is a child of the world";
  const Messages gone = messages.convert_world(world_of("WORLD", TrackState::kGone), std::nullopt);
  EXPECT_FALSE(holds(find_topic(gone, "/transforms"), "mug_3"));
  EXPECT_EQ(find_topic(gone, "/objects/mug_3").type, "foxglove.SceneUpdate");
}

TEST(FoxgloveMessages, ABoxOfAnotherFrameIsNotTaken) {
  ObjectPlacements placed;
  placed.frame = {"CAM", 7};
  placed.objects.resize(1);
  placed.objects[0].track_id = 3;
  placed.objects[0].box_size.setConstant(0.25);
  const auto size_of_entity = [&] {
    FoxgloveMessages messages({});
    return messages.convert_world(world_of("WORLD", TrackState::kVisible), placed).back().data.size();
  };
  const std::size_t with_box = size_of_entity();
  placed.frame.utime = 6;
  EXPECT_LT(size_of_entity(), with_box);
}

TEST(FoxgloveMessages, ACameraThatNobodyKnowsHasNoPlace) {
  FoxgloveMessages messages({});
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  EXPECT_TRUE(messages.convert_camera_pose("LEFT_CAM_TO_WORLD", 1, T).empty());
  messages.convert_frame(to_message(make_test_frame(5), WireFormat(), 0), "left-cam", std::nullopt);
  const Messages sent = messages.convert_camera_pose("LEFT_CAM_TO_WORLD", 1, T);
  EXPECT_TRUE(holds(find_topic(sent, "/transforms"), "left-cam"));
  EXPECT_TRUE(messages.convert_camera_pose("MUG_TO_LEFT_CAM", 1, T).empty());
}

}  // namespace
}  // namespace houghstream::foxglove
