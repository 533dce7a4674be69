#include "tools/render/world/takes/take_plans.hpp"

#include <array>
#include <utility>

namespace houghstream::world {
namespace {

constexpr std::array<std::pair<const char*, TakeKind>, 12> kShown = {{{"bowl", TakeKind::kHandHeld},
                                                                      {"cereal_box", TakeKind::kHandHeld},
                                                                      {"coffee_mug", TakeKind::kHandHeld},
                                                                      {"soda_can", TakeKind::kHandHeld},
                                                                      {"teapot", TakeKind::kTurntable},
                                                                      {"tumbler", TakeKind::kHandHeld},
                                                                      {"shampoo_bottle", TakeKind::kHandHeld},
                                                                      {"food_tin", TakeKind::kHandTurns},
                                                                      {"tea_box", TakeKind::kHandTurns},
                                                                      {"office_stapler", TakeKind::kHandHeld},
                                                                      {"toy_truck", TakeKind::kTurntable},
                                                                      {"flashlight", TakeKind::kHandHeld}}};

}  // namespace

std::vector<NumberedTake> twelve_objects_takes(DatasetSplit use, int world, double seconds) {
  std::vector<NumberedTake> takes;
  for (const auto& [name, kind] : kShown) {
    const std::uint64_t room = static_cast<std::uint64_t>(world) * kShown.size() + takes.size() / 2;
    for (const int take : {1, 2}) {
      TakePlan plan;
      plan.object_id = taught_object_id(name);
      plan.kind = kind;
      plan.laid_down = take == 2;
      plan.use = use;
      plan.number = room;
      plan.seconds = seconds;
      takes.push_back({static_cast<int>(takes.size()) + 1, take, name, plan});
    }
  }
  return takes;
}

}  // namespace houghstream::world
