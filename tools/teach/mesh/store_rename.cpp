#include "tools/teach/mesh/store_rename.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "detector/forest/forest_file.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/store/object_store.hpp"
#include "drivers/store/store_transaction.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"
#include "tools/teach/mesh/store_contents.hpp"
#include "tools/teach/mesh/store_summary.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using store::ObjectStore;
using store::StoredObject;

/// Copies the meshes, their entries, and the images of views. Other files there are the user's, which StoreTransaction
/// carries over.
void copy_files(const ObjectStore& from, const fs::path& to) {
  for (const char* folder : {"models", "views"}) {
    std::error_code error;
    fs::create_directory(to / folder, error);
    for (fs::directory_iterator entry(from.folder / folder, error), end; !error && entry != end;
         entry.increment(error)) {
      const fs::path name = fs::path(folder) / entry->path().filename();
      if (store::is_store_entry(name)) fs::copy_file(entry->path(), to / name, error);
      if (error) break;
    }
    require(!error, "{}: cannot be copied to {}: {}", (from.folder / folder).string(), to.string(), error.message());
  }
}

/// Carries the forests of all groups but `group` over, bit for bit.
void carry_other_forests(const ObjectStore& from, int group, const fs::path& to) {
  ObjectStore made = from;
  made.folder = to;
  std::error_code error;
  if (from.groups().size() > 1) fs::create_directory(made.forests_folder(), error);
  require(!error, "{}: cannot make this folder: {}", made.forests_folder().string(), error.message());
  for (const int other : from.groups()) {
    if (other != group) carry_over(from.forest_file(other), made.forest_file(other));
  }
}

void write_names(const ObjectStore& store) {
  std::map<int, std::string> names;
  for (const StoredObject& object : store.objects) names[object.id] = object.name;
  write_bop_names(names, store.models_folder() / "names.json");
}

void write_images(const ObjectStore& store, const StoredObject& renamed) {
  cv::Mat image = read_colour_image(store.view_image(renamed.id));
  write_title(title_of(renamed, object_sizes(store).at(renamed.id)), image);
  write_png(image, store.view_image(renamed.id));
  std::vector<fs::path> images;
  for (const StoredObject& object : store.objects) images.push_back(store.view_image(object.id));
  write_contact_sheet(images, store.contact_sheet());
}

std::string frame_names(const std::vector<ObjectFrame>& frames) {
  std::vector<std::string> names;
  for (const ObjectFrame& frame : frames) names.push_back(frame.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void rename_in_store(const fs::path& folder, const std::string& old_name, const std::string& new_name) {
  store::recover_store(folder);
  ObjectStore store = store::read_store(folder);  // nothing is made beside what is no store
  store::StoreTransaction build(folder);
  store = store::read_store(folder);  // nobody else changes it from here on
  const int id = store::find_object(store, old_name).id;
  store::require_new_name(new_name, store.json_file().string());
  const bool is_taken = std::any_of(store.objects.begin(), store.objects.end(),
                                    [&](const StoredObject& other) { return other.name == new_name; });
  require(!is_taken, "{}: has a '{}' already, expected a new name for '{}'", store.json_file().string(), new_name,
          old_name);
  const int group = store::find_object(store, old_name).group;
  Forest forest = load_forest(store.forest_file(group));
  copy_files(store, build.folder());
  carry_other_forests(store, group, build.folder());
  store.folder = build.folder();
  for (StoredObject& object : store.objects) {
    if (object.id == id) object.name = new_name;
    if (!object.practice) continue;
    std::map<std::string, int>& taken_for = object.practice->taken_for;
    if (auto entry = taken_for.extract(old_name)) {
      entry.key() = new_name;
      taken_for.insert(std::move(entry));
    }
  }
  for (ObjectClass& known : forest.classes) {
    if (known.name == old_name) known.name = new_name;
  }
  save_forest(forest, store.forest_file(group));
  write_names(store);
  write_images(store, store::find_object(store, new_name));
  store::write_store_json(store);
  load_group_forest(store::read_store(build.folder()), group);  // an unreadable store replaces none
  build.commit();
}

Eigen::Isometry3d parse_frame_place(const std::string& text) {
  constexpr std::size_t kPlace = 3;
  constexpr std::size_t kWithRotation = 7;
  std::vector<double> numbers;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    char* end = nullptr;
    numbers.push_back(std::strtod(part.c_str(), &end));
    require(!part.empty() && *end == '\0', "place '{}': '{}' is no number, expected x,y,z or x,y,z,qw,qx,qy,qz", text,
            part);
  }
  require(numbers.size() == kPlace || numbers.size() == kWithRotation,
          "place '{}': {} numbers, expected x,y,z or x,y,z,qw,qx,qy,qz", text, numbers.size());
  if (numbers.size() == kPlace) numbers.insert(numbers.end(), {1.0, 0.0, 0.0, 0.0});
  return store::object_frame_pose({numbers[0], numbers[1], numbers[2]},
                                  {numbers[3], numbers[4], numbers[5], numbers[6]}, "place '" + text + "'");
}

void set_frame_in_store(const fs::path& folder, const std::string& object_name, const std::string& frame_name,
                        const std::optional<Eigen::Isometry3d>& T_object_frame) {
  store::recover_store(folder);
  store::read_store(folder);  // nothing is made beside what is no store
  store::StoreTransaction build(folder);
  ObjectStore store = store::read_store(folder);  // nobody else changes it from here on
  const int id = store::find_object(store, object_name).id;
  store::require_new_name(frame_name, store.json_file().string());
  std::vector<ObjectFrame>* frames = nullptr;
  for (StoredObject& object : store.objects) {
    if (object.id == id) frames = &object.frames;
  }
  const auto place =
      std::lower_bound(frames->begin(), frames->end(), frame_name,
                       [](const ObjectFrame& frame, const std::string& name) { return frame.name < name; });
  const bool is_known = place != frames->end() && place->name == frame_name;
  if (!T_object_frame) {
    require(is_known, "{}: '{}' has no frame '{}', expected one of {}", store.json_file().string(), object_name,
            frame_name, frames->empty() ? "none" : frame_names(*frames));
    frames->erase(place);
  } else if (is_known) {
    place->T_object_frame = *T_object_frame;
  } else {
    frames->insert(place, {frame_name, *T_object_frame});
  }
  constexpr int kNoGroup = 0;
  copy_files(store, build.folder());
  carry_other_forests(store, kNoGroup, build.folder());
  const fs::path sheet = store.contact_sheet();
  if (fs::exists(sheet)) carry_over(sheet, build.folder() / sheet.filename());  // a store can do without
  store.folder = build.folder();
  store::write_store_json(store);
  store::read_store(build.folder());  // an unreadable store replaces none
  build.commit();
}

}  // namespace houghstream::teach
