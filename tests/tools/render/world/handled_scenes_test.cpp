#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>

#include "pipeline/geometry/renderer.hpp"
#include "tests/tools/render/world/scene_checks.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/held.hpp"
#include "tools/render/world/rooms/table_setter.hpp"
#include "tools/render/world/scene_frames.hpp"

namespace houghstream::world {
namespace {

const Scene& handled_scene(const std::string& name) {
  static std::map<std::string, Scene> scenes;
  const auto found = scenes.find(name);
  return found != scenes.end() ? found->second : scenes.emplace(name, make_named_scene(name)).first->second;
}

std::vector<const char*> handled_scenes() {
  std::vector<const char*> names(kHandledScenes.begin(), kHandledScenes.end());
  names.insert(names.end(), kHandledDevelopmentScenes.begin(), kHandledDevelopmentScenes.end());
  return names;
}

/// Returns the support of the item behind this one in the list: "block", "hand", or nothing.
std::string carrier(const std::vector<PlacedAsset>& items, std::size_t index) {
  const std::string name = index > 0 ? items[index - 1].thing->name : "";
  return name == "block" || name == "hand" ? name : "";
}

double upright_cosine(const PlacedAsset& placed) {
  return placed.T_world_object.linear()(2, 2);
}

TEST(HandledScenes, TiltedOnesHoldEachClassStandingLyingAndLeaning) {
  for (const char* name : {kHandledScenes[0], kHandledDevelopmentScenes[0]}) {
    SCOPED_TRACE(name);
    const std::vector<PlacedAsset>& items = handled_scene(name).world.items;
    std::map<int, int> standing;
    std::map<int, int> lying;
    std::map<int, int> leaning;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (items[i].object_id == 0) continue;
      EXPECT_NEAR(lowest_point(items[i]), 0.0, 1e-5) << "nothing reaches into the table or floats";
      if (carrier(items, i) == "block") {
        ++leaning[items[i].object_id];
      } else {
        ++(upright_cosine(items[i]) > 0.9999 ? standing : lying)[items[i].object_id];
      }
    }
    const std::map<int, int> once = {{1, 1}, {2, 1}, {3, 1}, {4, 1}};
    EXPECT_EQ(standing, once);
    EXPECT_EQ(lying, once);
    EXPECT_EQ(leaning, once);
  }
}

TEST(HandledScenes, HeldOnesHoldEachClassInAHandAndOnTheTable) {
  for (const char* name : {kHandledScenes[1], kHandledDevelopmentScenes[1]}) {
    SCOPED_TRACE(name);
    const std::vector<PlacedAsset>& items = handled_scene(name).world.items;
    std::map<int, int> held;
    std::map<int, int> put;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (items[i].thing->name == "hand") {
        EXPECT_GT(lowest_point(items[i]), 0.0);
      }
      if (items[i].object_id == 0) continue;
      if (carrier(items, i) == "hand") {
        ++held[items[i].object_id];
        EXPECT_GE(lowest_point(items[i]), kMinHeldM - 1e-6);
        EXPECT_LE(lowest_point(items[i]), kMaxHeldM + 1e-6);
      } else {
        ++put[items[i].object_id];
        EXPECT_NEAR(lowest_point(items[i]), 0.0, 1e-5);
      }
    }
    const std::map<int, int> once = {{1, 1}, {2, 1}, {3, 1}, {4, 1}};
    EXPECT_EQ(held, once);
    EXPECT_EQ(put, once);
  }
}

/// Returns the fraction of item `index` that item `other` occludes, along the camera's way.
double hidden_by(const Scene& scene, std::size_t index, std::size_t other) {
  const Camera camera = synthetic_camera();
  const cv::Rect image(-camera.width, -camera.height, 3 * camera.width, 3 * camera.height);
  double sum = 0.0;
  constexpr int kViews = 9;
  for (int i = 0; i < kViews; ++i) {
    const Eigen::Isometry3d T_camera_world = camera_at(scene.trajectory, (i + 0.5) / kViews);
    const auto depth_of = [&](std::size_t item) {
      const PlacedAsset& placed = scene.world.items[item];
      return render_depth(placed.thing->mesh, T_camera_world * placed.T_world_object, camera, image);
    };
    const cv::Mat object = depth_of(index);
    const int all = cv::countNonZero(object == object);
    sum += static_cast<double>(cv::countNonZero(depth_of(other) < object)) / all;
  }
  return sum / kViews;
}

TEST(HandledScenes, HandsHideATenthToAThirdOfWhatTheyHold) {
  for (const char* name : {kHandledScenes[1], kHandledDevelopmentScenes[1]}) {
    SCOPED_TRACE(name);
    const Scene& scene = handled_scene(name);
    for (std::size_t i = 1; i < scene.world.items.size(); ++i) {
      if (carrier(scene.world.items, i) != "hand") continue;
      const double hidden = hidden_by(scene, i, i - 1);
      EXPECT_GT(hidden, kMinGripped - 0.03) << scene.world.items[i].thing->name;
      EXPECT_LT(hidden, kMaxGripped + 0.03) << scene.world.items[i].thing->name;
    }
  }
}

TEST(HandledScenes, TrueBoxesAndPosesAreThoseOfTheMeasuredDepth) {
  for (const char* name : handled_scenes()) {
    SCOPED_TRACE(name);
    const Scene& scene = handled_scene(name);
    const RenderedFrame rendered = render_scene_frame(scene, light_world(scene.world), 2, 5);
    EXPECT_GE(rendered.objects.size(), 6U);
    for (std::size_t i = 0; i < rendered.objects.size(); ++i) {
      const GroundTruthObject& object = rendered.objects[i];
      const cv::Mat model = render_depth(make_taught_object(object.object_id).thing->mesh, object.T_camera_object,
                                         rendered.frame.camera, cv::Rect(0, 0, 640, 480));
      std::vector<float> differences;
      for (int y = 0; y < 480; ++y) {
        for (int x = 0; x < 640; ++x) {
          const float difference = rendered.frame.depth.at<float>(y, x) - model.at<float>(y, x);
          if (rendered.visible_masks[i].at<std::uint8_t>(y, x) != 0 && !std::isnan(difference))
            differences.push_back(difference);
        }
      }
      if (differences.size() < 100) continue;
      const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
      std::nth_element(differences.begin(), middle, differences.end());
      EXPECT_NEAR(*middle, 0.0, 0.004) << object.object_id;
    }
  }
}

TEST(HandledScenes, SeedsAreOddForTestsAndEvenForDevelopment) {
  for (const char* name : kHandledScenes) EXPECT_EQ(handled_scene(name).seed % 2, 1U);
  for (const char* name : kHandledDevelopmentScenes) EXPECT_EQ(handled_scene(name).seed % 2, 0U);
}

}  // namespace
}  // namespace houghstream::world
