#include "tools/evaluate/bop_targets.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

using CountsByObject = std::map<int, int>;

BopTarget parse_target(const nlohmann::json& entry, const std::string& where) {
  const BopTarget target{json_integer(entry, "scene_id", where), json_integer(entry, "im_id", where),
                         json_integer(entry, "obj_id", where), json_integer(entry, "inst_count", where)};
  require(target.count > 0, "{}: inst_count is {}, expected 1 or more", where, target.count);
  return target;
}

/// Marks an image's objects of one kind.
void mark_targets(std::vector<NamedObject>& objects, int object_id, int count, const std::string& where) {
  std::vector<NamedObject*> kind;
  for (NamedObject& object : objects) {
    if (object.truth.object_id == object_id) kind.push_back(&object);
  }
  require(static_cast<int>(kind.size()) >= count, "{}: {} of object {} asked for, the truth has {}", where, count,
          object_id, kind.size());
  std::stable_sort(kind.begin(), kind.end(), [](const NamedObject* a, const NamedObject* b) {
    return a->truth.visible_fraction > b->truth.visible_fraction;
  });
  for (int i = 0; i < count; ++i) kind[static_cast<std::size_t>(i)]->is_target = true;
}

}  // namespace

std::vector<BopTarget> read_bop_targets(const std::filesystem::path& file) {
  const nlohmann::json content = read_json_list(file);
  std::vector<BopTarget> targets;
  std::set<std::tuple<int, int, int>> asked;
  for (std::size_t i = 0; i < content.size(); ++i) {
    const std::string where = fmt::format("{} entry {}", file.string(), i + 1);
    const BopTarget target = parse_target(content[i], where);
    require(asked.insert({target.scene_id, target.image_id, target.object_id}).second,
            "{}: asks again for object {} in image {} of scene {}", where, target.object_id, target.image_id,
            target.scene_id);
    targets.push_back(target);
  }
  require(!targets.empty(), "{}: no targets", file.string());
  return targets;
}

std::vector<EvaluatedFrame> targeted_frames(std::vector<EvaluatedFrame> frames, const std::vector<BopTarget>& targets,
                                            const std::filesystem::path& source) {
  if (frames.empty()) return frames;
  const std::string scene = frames.front().scene;
  std::map<int, CountsByObject> asked;  // counts by image
  for (const BopTarget& target : targets) {
    if (target.scene_id == scene_number(scene)) asked[target.image_id][target.object_id] = target.count;
  }
  require(!asked.empty(), "{}: no targets in scene {}", source.string(), scene);
  std::vector<EvaluatedFrame> kept;
  for (EvaluatedFrame& frame : frames) {
    const auto here = asked.find(frame.image_id);
    if (here == asked.end()) continue;
    for (NamedObject& object : frame.objects) object.is_target = false;
    for (const auto& [object_id, count] : here->second) {
      mark_targets(frame.objects, object_id, count,
                   fmt::format("{}: scene {} image {}", source.string(), scene, frame.image_id));
    }
    kept.push_back(std::move(frame));
    asked.erase(here);
  }
  require(asked.empty(), "{}: image {} of scene {} is asked for, which the scene lacks", source.string(),
          asked.empty() ? 0 : asked.begin()->first, scene);
  return kept;
}

}  // namespace houghstream
