#include "tools/train/training_sources.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/train/uw_dataset.hpp"

namespace houghstream {
namespace {

std::pair<std::string, std::string> split_kind(const std::string& source, const std::string& expected) {
  const std::size_t colon = source.find(':');
  require(colon != std::string::npos && colon + 1 < source.size(), "'{}': no such training source, expected {}", source,
          expected);
  return {source.substr(0, colon), source.substr(colon + 1)};
}

Camera camera_option(const TrainingSources& sources, const std::string& source) {
  require(sources.camera.has_value(), "{}: this layout publishes no camera, expected --camera WIDTHxHEIGHT,fx,fy,cx,cy",
          source);
  return parse_camera(*sources.camera);
}

void append(std::vector<TrainingView> from, std::vector<TrainingView>& to) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

/// Returns new names by old ones. Throws InputError where one has no effect.
std::map<std::string, std::string> parse_renames(const std::vector<std::string>& renames,
                                                 const std::set<std::string>& there) {
  std::map<std::string, std::string> new_names;
  for (const std::string& rename : renames) {
    const std::size_t equals = rename.find('=');
    require(equals != std::string::npos && equals > 0 && equals + 1 < rename.size(),
            "--rename '{}', expected OLD=NEW, for instance can_1=can", rename);
    const std::string old_name = rename.substr(0, equals);
    require(there.count(old_name) == 1, "--rename '{}': no instance '{}' is read, but {}", rename, old_name,
            fmt::join(there, ", "));
    const bool is_first = new_names.emplace(old_name, rename.substr(equals + 1)).second;
    require(is_first, "--rename '{}': '{}' has another new name already", rename, old_name);
  }
  return new_names;
}

/// Renames classes and numbers them by name, so that instances of one name become one class.
void rename_classes(const std::vector<std::string>& renames, std::vector<TrainingView>& views) {
  std::set<std::string> there;
  for (const TrainingView& view : views) there.insert(view.class_name);
  const std::map<std::string, std::string> new_names = parse_renames(renames, there);
  std::map<std::string, int> ids;
  for (TrainingView& view : views) {
    const auto new_name = new_names.find(view.class_name);
    if (new_name != new_names.end()) view.class_name = new_name->second;
    ids[view.class_name] = 0;
  }
  int next = 1;
  for (auto& [name, id] : ids) id = next++;
  for (TrainingView& view : views) view.class_id = ids[view.class_name];
}

}  // namespace

std::vector<TrainingView> read_training_sources(const TrainingSources& sources, int threads) {
  if (sources.camera) parse_camera(*sources.camera);  // checks it also where no source needs it
  std::vector<TrainingView> all;
  std::vector<TrainingView> turntable;
  for (const std::string& source : sources.views) {
    const auto [kind, folder] = split_kind(source, "bop:DIR or uw:DIR");
    if (kind == "bop") {
      append(read_bop_training_views(folder, threads), all);
    } else if (kind == "uw") {
      append(read_uw_training_views(folder, {sources.instances, false}, camera_option(sources, source)), turntable);
    } else {
      fail("'{}': no such training source, expected bop:DIR or uw:DIR", source);
    }
  }
  require(all.empty() || turntable.empty(),
          "--views: bop: and uw: number their classes differently, expected one kind");
  require(!turntable.empty() || (sources.renames.empty() && sources.instances.empty()),
          "{} goes with --views uw:DIR; the objects of bop:DIR have their names from models/names.json",
          sources.renames.empty() ? "--instances" : "--rename");
  if (!turntable.empty()) rename_classes(sources.renames, turntable);
  append(std::move(turntable), all);
  for (const std::string& source : sources.backgrounds) {
    const auto [kind, folder] = split_kind(source, "bop:DIR or images:DIR");
    if (kind == "bop") {
      append(read_bop_training_views(folder, threads), all);
    } else if (kind == "images") {
      append(read_background_views(folder, camera_option(sources, source)), all);
    } else {
      fail("'{}': no such background, expected bop:DIR or images:DIR", source);
    }
  }
  return all;
}

}  // namespace houghstream
