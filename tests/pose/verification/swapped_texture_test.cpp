#include "pose/verification/swapped_texture.hpp"

#include <gtest/gtest.h>

#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

std::optional<PoseEvidence> with_swapped_texture(const Mesh& box) {
  const Eigen::Isometry3d pose = standing(30.0, 30.0, 0.8);
  const RgbdFrame frame = coloured_frame(box, pose, 1);
  const ObjectModel model = make_object_model("box", box, {});
  Detection detection;
  detection.box_px = cv::Rect2f(0.0F, 0.0F, 640.0F, 480.0F);
  detection.centre_camera = pose.translation().cast<float>();
  const FrameContext seen_frame = make_frame_context(frame, {}, {});
  const ObjectObservation observation = observe_object(seen_frame, detection, model, {});
  const PoseEvidence own = gather_evidence(observation, pose, 0.9F, {});
  const std::optional<PoseEvidence> other = evidence_with_swapped_texture(observation, pose, own, {});
  if (other) {
    EXPECT_EQ(other->depth.depth_inliers, own.depth.depth_inliers) << "the surface is the same";
    EXPECT_LT(other->colour->agreement, own.colour->agreement - 0.2F);
  }
  return other;
}

TEST(SwappedTexture, ExplainsWhatIsSeenWorseThanItsOwn) {
  EXPECT_TRUE(with_swapped_texture(printed_box()).has_value());
}

TEST(SwappedTexture, APlainObjectHasNone) {
  Mesh plain = printed_box();
  for (cv::Vec3b& colour : plain.colours) colour = cv::Vec3b(40, 90, 160);
  EXPECT_FALSE(with_swapped_texture(plain).has_value());
}

}  // namespace
}  // namespace houghstream
