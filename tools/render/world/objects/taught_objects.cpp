#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/further_objects.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/objects/taught_colours.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream::world {
namespace {

// Fixed, so that an object looks the same in every training view and scene.
constexpr std::uint64_t kObjectSeed = 7100;

const std::array<const char*, kTaughtObjectCount> kNames = {"bowl",   "cereal_box",   "coffee_mug",   "soda_can",
                                                            "bowl_2", "cereal_box_2", "coffee_mug_2", "soda_can_2"};

struct FurtherClass {
  const char* name;
  bool symmetric_about_z;
  AssetPtr (*make)(Random&);
};

// The table is ordered by id, from kFirstFurtherId on.
constexpr std::array<FurtherClass, kFurtherClassCount> kFurther = {{{"plate", true, make_plate},
                                                                    {"teapot", false, make_teapot},
                                                                    {"pitcher", false, make_pitcher},
                                                                    {"tumbler", true, make_tumbler},
                                                                    {"water_bottle", true, make_water_bottle},
                                                                    {"shampoo_bottle", false, make_shampoo_bottle},
                                                                    {"jam_jar", true, make_jam_jar},
                                                                    {"food_tin", true, make_food_tin},
                                                                    {"milk_carton", false, make_milk_carton},
                                                                    {"tea_box", false, make_tea_box},
                                                                    {"sponge", false, make_sponge},
                                                                    {"office_stapler", false, make_office_stapler},
                                                                    {"beach_ball", true, make_beach_ball},
                                                                    {"toy_truck", false, make_toy_truck},
                                                                    {"banana", false, make_banana},
                                                                    {"flashlight", false, make_flashlight}}};

AssetPtr bowl(bool second, Random& random) {
  const BowlShape shape = second ? BowlShape{0.084, 0.045, 0.056, 0.0035} : BowlShape{0.074, 0.036, 0.066, 0.004};
  const cv::Scalar colour = second ? hsv(205, 0.22, 0.72) : bgr(class_colours(1).base);
  return make_asset(second ? "bowl_2" : "bowl", bowl_mesh(shape, plain({256, 256}, colour, 0.03, random)), 0.25F);
}

AssetPtr cereal_box(bool second, Random& random) {
  const Eigen::Vector3d size = second ? Eigen::Vector3d(0.165, 0.068, 0.245) : Eigen::Vector3d(0.192, 0.058, 0.285);
  Palette palette = random_palette(random);
  palette.base = second ? hsv(28, 0.8, 0.85) : bgr(class_colours(2).base);
  palette.accent = second ? hsv(340, 0.75, 0.7) : bgr(class_colours(2).accent);
  return make_asset(second ? "cereal_box_2" : "cereal_box", carton_mesh(size, palette, random), 0.12F);
}

AssetPtr coffee_mug(bool second, Random& random) {
  const MugShape shape = second ? MugShape{0.046, 0.039, 0.102, 0.004} : MugShape{0.0405, 0.0405, 0.094, 0.0038};
  Palette palette = random_palette(random);
  palette.base = second ? hsv(150, 0.35, 0.5) : bgr(class_colours(3).base);
  palette.accent = second ? hsv(30, 0.6, 0.9) : bgr(class_colours(3).accent);
  return make_asset(second ? "coffee_mug_2" : "coffee_mug", mug_mesh(shape, palette, random), 0.3F);
}

AssetPtr soda_can(bool second, Random& random) {
  Palette palette = random_palette(random);
  palette.base = second ? hsv(212, 0.7, 0.55) : bgr(class_colours(4).base);
  palette.accent = second ? hsv(200, 0.15, 0.88) : bgr(class_colours(4).accent);
  const double radius = second ? 0.0285 : 0.033;
  const double height = second ? 0.146 : 0.122;
  return make_asset(second ? "soda_can_2" : "soda_can", can_mesh(radius, height, palette, random), 0.45F);
}

TaughtObject make_further_object(int id) {
  const FurtherClass& further = kFurther[static_cast<std::size_t>(id - kFirstFurtherId)];
  Random random(kObjectSeed + static_cast<std::uint64_t>(id));
  return {id, further.name, further.symmetric_about_z, further.make(random)};
}

/// Makes an instance, whose name holds its class and number.
TaughtObject make_instance(int id) {
  const int number = id - kFirstInstanceId;
  const int kind = number % kClassCount;
  const AssetPtr thing = make_other_instance(1 + kind, kObjectSeed + static_cast<std::uint64_t>(id));
  return {id, fmt::format("{}_{}", thing->name, number + 1), kind == 0 || kind == 3, thing};
}

bool is_instance(int id) {
  return id >= kFirstInstanceId && id < kFirstInstanceId + kTaughtInstanceCount;
}

bool is_further(int id) {
  return id >= kFirstFurtherId && id < kFirstFurtherId + kFurtherClassCount;
}

}  // namespace

std::vector<int> twenty_class_ids() {
  std::vector<int> ids(kClassCount + kFurtherClassCount);
  std::iota(ids.begin(), ids.begin() + kClassCount, 1);
  std::iota(ids.begin() + kClassCount, ids.end(), kFirstFurtherId);
  return ids;
}

std::vector<int> forty_object_ids() {
  std::vector<int> ids = twenty_class_ids();
  for (int i = 0; i < kTaughtInstanceCount; ++i) ids.push_back(kFirstInstanceId + i);
  return ids;
}

TaughtObject make_taught_object(int id) {
  if (is_further(id)) return make_further_object(id);
  if (is_instance(id)) return make_instance(id);
  require(id >= 1 && id <= kTaughtObjectCount, "taught object: id {}, expected 1 to {}, {} to {} or {} to {}", id,
          kTaughtObjectCount, kFirstFurtherId, kFirstFurtherId + kFurtherClassCount - 1, kFirstInstanceId,
          kFirstInstanceId + kTaughtInstanceCount - 1);
  const bool second = id > kClassCount;
  const int kind = (id - 1) % kClassCount;
  Random random(kObjectSeed + static_cast<std::uint64_t>(id));
  TaughtObject object{id, kNames[static_cast<std::size_t>(id - 1)], kind == 0 || kind == 3, nullptr};
  switch (kind) {
    case 0: object.thing = bowl(second, random); break;
    case 1: object.thing = cereal_box(second, random); break;
    case 2: object.thing = coffee_mug(second, random); break;
    default: object.thing = soda_can(second, random); break;
  }
  return object;
}

int taught_object_id(const std::string& name) {
  for (int i = 0; i < kTaughtObjectCount; ++i) {
    if (name == kNames[static_cast<std::size_t>(i)]) return i + 1;
  }
  std::vector<std::string> further;
  for (const FurtherClass& entry : kFurther) {
    if (name == entry.name) return kFirstFurtherId + static_cast<int>(further.size());
    further.emplace_back(entry.name);
  }
  for (int id = kFirstInstanceId; id < kFirstInstanceId + kTaughtInstanceCount; ++id) {
    if (name.rfind("other_", 0) == 0 && name == make_instance(id).name) return id;
  }
  fail("object \"{}\": expected one of {}, {}", name, fmt::join(kNames, ", "), fmt::join(further, ", "));
}

}  // namespace houghstream::world
