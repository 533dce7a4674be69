#include "tools/render/world/sequences/sequence_plan.hpp"

namespace houghstream::world {
namespace {

constexpr int kBowl = 1;
constexpr int kBox = 2;
constexpr int kMug = 3;
constexpr int kCan = 4;

const Eigen::Vector3d kBowlPlace(-0.17, 0.10, 0.0);
const Eigen::Vector3d kBoxPlace(0.20, 0.17, 0.0);
const Eigen::Vector3d kMugPlace(0.13, -0.12, 0.0);
const Eigen::Vector3d kCanPlace(-0.10, -0.14, 0.0);
const Eigen::Vector3d kGone(-1.6, -0.1, 0.35);

/// Returns the four classes, each at its place.
std::vector<Actor> standing() {
  return {{kBowl, {{0.0, kBowlPlace, 0.4, 0.0}}},
          {kBox, {{0.0, kBoxPlace, -0.5, 0.0}}},
          {kMug, {{0.0, kMugPlace, 2.2, 0.0}}},
          {kCan, {{0.0, kCanPlace, -0.3, 0.0}}}};
}

SequencePlan still(const std::string& name, double seconds) {
  SequencePlan plan;
  plan.name = name;
  plan.seconds = seconds;
  plan.actors = standing();
  return plan;
}

// Plans a slow push, a quick one, and a rotation on the spot.
SequencePlan pushed() {
  SequencePlan plan = still("pushed", 10.0);
  plan.actors[2].stops = {{2.0, kMugPlace, 2.2, 0.0},
                          {4.0, {0.13, 0.02, 0.0}, 2.2, 0.0},
                          {7.5, {0.13, 0.02, 0.0}, 2.2, 0.0},
                          {8.5, {0.13, 0.02, 0.0}, 1.2, 0.0}};
  plan.actors[3].stops = {{4.8, kCanPlace, -0.3, 0.0}, {5.4, {-0.30, -0.14, 0.0}, -0.3, 0.0}};
  return plan;
}

SequencePlan carried() {
  SequencePlan plan = still("carried", 10.0);
  plan.actors[2].stops = {{2.0, kMugPlace, 2.2, 0.0},
                          {4.5, {-0.28, -0.10, 0.0}, 1.0, 0.18},
                          {6.0, {-0.28, -0.10, 0.0}, 1.0, 0.0},
                          {8.0, {0.02, 0.02, 0.0}, 1.6, 0.12}};
  return plan;
}

SequencePlan removed() {
  SequencePlan plan = still("removed", 13.0);
  plan.actors[3].stops = {{2.0, kCanPlace, -0.3, 0.0},
                          {3.5, kGone, -0.3, 0.1},
                          {8.0, kGone, -0.3, 0.1},
                          {9.5, {-0.30, -0.02, 0.0}, 0.5, 0.1}};
  plan.actors[0].stops = {{4.5, kBowlPlace, 0.4, 0.0}, {6.0, {-1.6, 0.1, 0.35}, 0.4, 0.1}};
  return plan;
}

// Mug and can change places.
SequencePlan swapped() {
  SequencePlan plan = still("swapped", 11.0);
  const Eigen::Vector3d aside(0.0, 0.02, 0.0);
  plan.actors[2].stops = {
      {1.5, kMugPlace, 2.2, 0.0}, {2.8, aside, 2.2, 0.1}, {6.6, aside, 2.2, 0.0}, {7.9, kCanPlace, 2.2, 0.1}};
  plan.actors[3].stops = {{4.0, kCanPlace, -0.3, 0.0}, {5.4, kMugPlace, -0.3, 0.15}};
  return plan;
}

// Plans two equal cans side by side; one is carried round the other.
SequencePlan cans() {
  SequencePlan plan = still("cans", 11.0);
  plan.actors[3].stops = {{0.0, {-0.10, -0.12, 0.0}, -0.3, 0.0}};
  plan.actors.push_back({kCan,
                         {{2.5, {0.0, -0.12, 0.0}, 0.9, 0.0},
                          {3.5, {0.0, 0.02, 0.0}, 0.9, 0.0},
                          {5.0, {-0.22, -0.02, 0.0}, 0.9, 0.0},
                          {7.0, {-0.22, -0.02, 0.0}, 0.9, 0.0},
                          {8.2, {-0.22, -0.14, 0.0}, 0.9, 0.0}}});
  return plan;
}

}  // namespace

std::vector<SequencePlan> sequence_plans() {
  SequencePlan arm = still("arm", 9.0);
  arm.arm_passes = true;
  SequencePlan jerk = still("jerk", 8.0);
  jerk.cameras = CameraWork::kJerk;
  SequencePlan cameras = still("cameras", 7.0);
  cameras.cameras = CameraWork::kThreeStill;
  cameras.actors[3].stops = {{4.0, kCanPlace, -0.3, 0.0}, {5.0, {-0.26, -0.10, 0.0}, -0.3, 0.0}};
  return {{"walk", CameraWork::kWalk, 30.0, false, standing()},
          pushed(),
          carried(),
          removed(),
          swapped(),
          cans(),
          arm,
          jerk,
          cameras};
}

}  // namespace houghstream::world
