#include "tools/teach/mesh/store_merge.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "detector/stages.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/store/store_transaction.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"
#include "tools/teach/mesh/store_contents.hpp"
#include "tools/teach/mesh/store_summary.hpp"
#include "tools/teach/mesh/teach_jobs.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using store::ObjectStore;
using store::StoredObject;

/// An object of one of the stores.
struct MergedObject {
  StoredObject object;
  const StoreContents* from = nullptr;

  /// Returns the id that it was taught with, whatever merges made of it.
  int taught_id() const { return object.taught_id != 0 ? object.taught_id : object.id; }
  const Mesh& mesh() const { return from->meshes.at(object.name); }
};

std::string folder_of(const StoreContents& contents) {
  return contents.list.folder.string();
}

template <typename Value>
bool have_same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

bool have_same_pixels(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && (a.empty() || cv::norm(a, b, cv::NORM_INF) == 0.0);
}

bool is_same_mesh(const Mesh& a, const Mesh& b) {
  return have_same_bytes(a.vertices, b.vertices) && have_same_bytes(a.triangles, b.triangles) &&
         have_same_bytes(a.colours, b.colours) && have_same_bytes(a.uvs, b.uvs) &&
         have_same_pixels(a.texture, b.texture);
}

/// Returns a setting of a store; null where the store does not state it.
OrderedJson setting_of(const StoreContents& contents, const char* key) {
  const OrderedJson& settings = contents.list.settings;
  return settings.is_object() && settings.contains(key) ? settings.at(key) : OrderedJson();
}

/// Refuses a store that was taught with other settings: it does not share a frame's features, or is another teaching
/// than it says.
void require_fitting(const StoreContents& first, const StoreContents& other) {
  for (const char* key : {"profile", "seed"}) {
    const OrderedJson expected = setting_of(first, key);
    const OrderedJson found = setting_of(other, key);
    require(found == expected, "{}: taught with {} {}, expected {} as {}", other.list.json_file().string(), key,
            found.dump(), expected.dump(), folder_of(first));
  }
  for (const GroupForest& it : other.groups)
    require(can_share_features(it.forest, first.groups.front().forest),
            "{}: taught with other settings of features, patches or scores than {}, expected the same",
            it.file.string(), first.groups.front().file.string());
}

void require_different(const std::vector<MergedObject>& objects) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const auto& [one, from] = objects[k];
      const auto& [other, other_from] = objects[i];
      require(one.name != other.name, "{}: has a '{}' as {} has, expected one of each name: hs-teach rename or remove",
              folder_of(*other_from), other.name, folder_of(*from));
      require(!is_same_mesh(objects[k].mesh(), objects[i].mesh()),
              "{}: '{}' has the mesh of '{}' in {}, expected each object once: hs-teach remove takes one out",
              folder_of(*other_from), other.name, one.name, folder_of(*from));
    }
  }
}

/// Gives ids to merged objects. The first by name keeps the id of several that were taught with one.
void give_merged_ids(std::vector<MergedObject>& objects) {
  std::sort(objects.begin(), objects.end(), [](const MergedObject& a, const MergedObject& b) {
    return std::make_tuple(a.taught_id(), a.object.name) < std::make_tuple(b.taught_id(), b.object.name);
  });
  std::set<int> taken;
  for (const MergedObject& it : objects) taken.insert(it.taught_id());
  int last = 0;
  int next = 1;
  for (MergedObject& it : objects) {
    const int taught = it.taught_id();
    it.object.id = taught;
    it.object.taught_id = 0;
    if (taught == last) {
      while (taken.count(next) > 0) ++next;
      taken.insert(next);
      it.object.id = next;
      it.object.taught_id = taught;
    }
    last = taught;
  }
  std::sort(objects.begin(), objects.end(),
            [](const MergedObject& a, const MergedObject& b) { return a.object.id < b.object.id; });
}

/// Copies the images of an object's views, under the title of its id.
void copy_views(const MergedObject& merged, const StoredObject& before, const Eigen::Vector3d& size_m,
                const ObjectStore& new_store) {
  cv::Mat image = read_colour_image(merged.from->list.view_image(before.id));
  write_title(title_of(merged.object, size_m), image);
  write_png(image, new_store.view_image(merged.object.id));
}

std::vector<MergedObject> objects_of(const std::vector<StoreContents>& stores) {
  std::vector<MergedObject> objects;
  for (const StoreContents& contents : stores) {
    for (const StoredObject& object : contents.list.objects) objects.push_back({object, &contents});
  }
  return objects;
}

/// Returns the settings that all of them have in common.
OrderedJson settings_of(const std::vector<MergedObject>& objects, const StoreContents& first) {
  OrderedJson settings = OrderedJson::object();
  const std::string& attitudes = objects.front().object.attitudes;
  const bool are_alike = std::all_of(objects.begin(), objects.end(),
                                     [&](const MergedObject& it) { return it.object.attitudes == attitudes; });
  if (are_alike) settings["attitudes"] = attitudes;
  for (const char* key : {"seed", "profile"}) {
    if (const OrderedJson value = setting_of(first, key); !value.is_null()) settings[key] = value;
  }
  return settings;
}

/// Entries of a store's models_info.json, by object id.
struct ModelEntries {
  std::map<int, OrderedJson> entries;
  std::map<int, Eigen::Vector3d> sizes_m;
};

/// Adds the objects to the list and the models, their views to the folder. A group is called by an id of one of its
/// objects.
std::vector<StoreModel> add_objects(const std::vector<MergedObject>& objects, ObjectStore& new_store) {
  std::vector<StoreModel> models;
  std::map<std::pair<const StoreContents*, int>, int> groups;
  std::map<const StoreContents*, ModelEntries> known;
  for (const MergedObject& it : objects) {
    const StoredObject& before = store::find_object(it.from->list, it.object.name);
    StoredObject& object = new_store.objects.emplace_back(it.object);
    object.group = groups.emplace(std::make_pair(it.from, before.group), object.id).first->second;
    const ObjectStore& list = it.from->list;
    if (known.count(it.from) == 0) known[it.from] = {read_model_entries(list), object_sizes(list)};
    const ModelEntries& stated = known.at(it.from);
    models.push_back({{object.id, object.name, it.mesh(), list.symmetries.at(before.id)},
                      list.mesh_file(before.id),
                      stated.entries.at(before.id)});
    copy_views(it, before, stated.sizes_m.at(before.id), new_store);
  }
  return models;
}

}  // namespace

void merge_stores(const std::vector<fs::path>& stores, const fs::path& out, bool replace) {
  require(stores.size() > 1, "{} store, expected at least two to merge", stores.size());
  store::StoreTransaction build(out);
  if (!replace) require_no_store(out);
  std::vector<StoreContents> contents;
  for (const fs::path& folder : stores) {
    contents.push_back(read_contents(folder));
    stored_quality(contents.back().list, QualitySettings{});
    require_fitting(contents.front(), contents.back());
  }
  std::vector<MergedObject> objects = objects_of(contents);
  require_different(objects);
  give_merged_ids(objects);
  ObjectStore new_store = start_store(build.folder());
  new_store.settings = settings_of(objects, contents.front());
  const std::vector<StoreModel> models = add_objects(objects, new_store);
  std::vector<GroupForest> groups;
  for (StoreContents& it : contents) std::move(it.groups.begin(), it.groups.end(), std::back_inserter(groups));
  write_store(new_store, models, groups, Carrying::kCopied);
  build.commit();
  log_lookalikes(models, new_store);
  fmt::print(
      "{} objects in {} groups in {}; their scores were learnt apart: 'hs-teach practise {}' learns them among one "
      "another\n",
      objects.size(), groups.size(), out.string(), out.string());
}

}  // namespace houghstream::teach
