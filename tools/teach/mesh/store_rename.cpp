#include "tools/teach/mesh/store_rename.hpp"

#include <algorithm>
#include <map>
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

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using store::ObjectStore;
using store::StoredObject;

/// The meshes, what is known of them, and the images of views. What else lies there is somebody's, which
/// StoreTransaction carries over.
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

/// The forests of other groups, bit for bit.
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
  write_title(title_of(renamed), image);
  write_png(image, store.view_image(renamed.id));
  std::vector<fs::path> images;
  for (const StoredObject& object : store.objects) images.push_back(store.view_image(object.id));
  write_contact_sheet(images, store.contact_sheet());
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
  }
  for (ObjectClass& known : forest.classes) {
    if (known.name == old_name) known.name = new_name;
  }
  save_forest(forest, store.forest_file(group));
  write_names(store);
  write_images(store, store::find_object(store, new_name));
  store::write_store_json(store);
  load_group_forest(store::read_store(build.folder()), group);  // what nothing can read takes no store's place
  build.commit();
}

}  // namespace houghstream::teach
