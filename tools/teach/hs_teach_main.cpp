#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <optional>
#include <sstream>

#include "pipeline/base/checks.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/common/usage_error.hpp"
#include "tools/teach/mesh/store_merge.hpp"
#include "tools/teach/mesh/store_rename.hpp"
#include "tools/teach/mesh/store_report.hpp"
#include "tools/teach/mesh/store_summary.hpp"
#include "tools/teach/mesh/teach_jobs.hpp"
#include "tools/teach/show/show_jobs.hpp"
#include "tools/teach/show/show_stream.hpp"

// hs-teach: objects are taught from their meshes, or by showing them, into an object store.

namespace {

using namespace houghstream;
using namespace houghstream::teach;

/// Lists are separated by commas: an option that takes several words would take the sources that follow it.
struct Lists {
  std::string names;
  std::string ids;
  std::string backgrounds;
};

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
  return parts;
}

void add_calibration_options(CommandLine& command, TeachOptions& options) {
  command
      .add_option("--practice-rooms", options.calibration.scenes,
                  fmt::format("rendered rooms in which scores and qualities are learnt, two pictures of each; 4.3 MB "
                              "of memory a room; default {}, with each further new object more, {} of seven",
                              scene_count_for(1), scene_count_for(7)))
      .range(3, CalibrationSettings::kMaxScenes);
  command.add_option("--seed", options.seed, "same seed, same meshes: same store").capture_default_str();
  command.add_option("--threads", options.threads, "any number gives the same store")
      .range(1, 256)
      .capture_default_str();
}

/// Adds the options that treat an existing store; without either one it is refused.
void add_store_flags(CommandLine& command, bool& add, bool& replace) {
  const CommandOption adding = command.add_flag("--add", add, "what is taught joins the objects of the store");
  command.add_flag("--replace", replace, "a new store takes the place of the one that is there, when all is done")
      .excludes(adding);
}

CommandLine add_mesh(CommandLine& app, TeachOptions& options, Lists& lists) {
  CommandLine mesh = app.add_subcommand("mesh", "teaches objects from their meshes");
  mesh.add_option("sources", options.meshes.sources,
                  "meshes (PLY, OBJ, STL, GLB, glTF), folders of them, or BOP models/ folders")
      .required();
  mesh.add_option("--out", options.out, "object store to write; one that is there wants --add or --replace").required();
  add_store_flags(mesh, options.add, options.replace);
  mesh.add_option("--unit", options.meshes.unit_m, "unit of the meshes' coordinates: mm, cm or m; default mm, glTF m")
      .transform({{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}});
  mesh.add_option("--names", lists.names, "2=cracker,5=mustard: by BOP id or file name");
  mesh.add_option("--ids", lists.ids, "2,5: only these of a BOP folder");
  mesh.add_option("--attitudes", options.attitudes,
                  "resting (as it comes to rest, and leaning), upright (the mesh's z axis up) or any")
      .capture_default_str();
  mesh.add_option("--rooms", lists.backgrounds,
                  "own pictures without the objects, beside the rendered rooms: bop:DIR or images:DIR");
  mesh.add_option("--camera", options.backgrounds.camera, "WIDTHxHEIGHT,fx,fy,cx,cy of images:DIR");
  mesh.add_option("--cache", options.backgrounds.cache, "where rendered rooms are kept; default ~/.cache/houghstream");
  add_calibration_options(mesh, options);
  mesh.add_option("--dump-views", options.dump_views, "writes the training views as a BOP training folder too");
  mesh.add_example("hs-teach mesh mug.ply drill.glb --out my.store");
  return mesh;
}

/// Arguments of hs-teach merge.
struct MergeArguments {
  std::vector<std::string> stores;
  std::string out;
  bool replace = false;
};

CommandLine add_merge(CommandLine& app, MergeArguments& merged) {
  CommandLine merge = app.add_subcommand("merge", "joins object stores that were taught apart");
  merge.add_option("stores", merged.stores, "object stores, taught with the same --seed").required();
  merge.add_option("--out", merged.out, "object store to write; one that is there wants --replace").required();
  merge.add_flag("--replace", merged.replace,
                 "the new store takes the place of the one that is there, when all is done");
  merge.add_example("hs-teach merge a.store b.store --out household.store");
  return merge;
}

/// Arguments of hs-teach list.
struct ListArguments {
  bool json = false;
  std::optional<double> precision;
};

CommandLine add_list(CommandLine& app, std::filesystem::path& folder, ListArguments& listed) {
  CommandLine list = app.add_subcommand("list", "the objects of a store");
  list.add_option("store", folder, "object store").required();
  list.add_flag("--json", listed.json, "print them as JSON, for scripts");
  list.add_option("--precision", listed.precision,
                  "also the score and the quality from which on detections and poses of each object were right in this "
                  "fraction of the cases in its practice, and the recall to expect")
      .range(0.0, store::kMaxPrecision);
  list.add_example("hs-teach list my.store");
  return list;
}

void print_list(const store::ObjectStore& store, const ListArguments& listed) {
  if (listed.json) print_json(store_json(store, listed.precision));
  if (!listed.json) fmt::print("{}", store_text(store, listed.precision));
}

CommandLine add_report(CommandLine& app, std::filesystem::path& folder, std::filesystem::path& page) {
  CommandLine report = app.add_subcommand("report", "writes a page of a store, for a browser");
  report.add_option("store", folder, "object store").required();
  page = "report.html";
  report.add_option("--out", page, "HTML file to write; an earlier page of this kind is replaced")
      .capture_default_str();
  report.add_example("hs-teach report my.store --out my_store.html");
  return report;
}

cv::Rect parse_box(const std::string& text) {
  cv::Rect box;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%d,%d,%d,%d%c", &box.x, &box.y, &box.width, &box.height, &rest);
  require(read == 4 && box.x >= 0 && box.y >= 0 && box.width > 0 && box.height > 0,
          "--box '{}', expected X,Y,W,H in pixels of the first frame", text);
  return box;
}

cv::Point parse_place(const std::string& text) {
  cv::Point place;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%d,%d%c", &place.x, &place.y, &rest);
  require(read == 2 && place.x >= 0 && place.y >= 0, "--at '{}', expected X,Y in pixels of the first frame", text);
  return place;
}

/// Options of the command line that are not in ShowOptions, or have another form there.
struct ShowWords {
  std::string box;
  std::string at;
  std::string lcm_url;
  bool from_stream = false;
};

CommandLine add_show(CommandLine& app, ShowOptions& options, ShowWords& words) {
  CommandLine show = app.add_subcommand("show", "teaches an object that a camera is moved around, or that turns");
  show.add_option("--source", options.source,
                  "openni2[:CAMERA], or a recording: log:FILE, FILE.klg, FILE.oni, bop:DIR, uw:DIR, tum:DIR, bag:FILE");
  show.add_flag("--from-stream", words.from_stream,
                "instead: frames of --channel on the bus, while the stream goes on");
  show.add_option("--second", options.second,
                  "a recording of a second take, the object laid on its side or turned over");
  show.add_option("--name", options.name, "of the object").required();
  show.add_option("--out", options.out, "object store to write; one that is there wants --add or --replace");
  add_store_flags(show, options.add, options.replace);
  show.add_option("--box", words.box,
                  "X,Y,W,H about the object in the first frame; default: what stands nearest the middle");
  show.add_option("--at", words.at, "X,Y on the object in the first frame, instead of the middle");
  show.add_option("--keep", options.keep, "folder for model, views, pictures and report");
  show.add_flag("--go-on", options.accept_poor_model, "teaches a poor model too");
  show.add_clearing_flag("--no-teach", options.teach, "makes the model only");
  show.add_option("--camera", options.camera, "WIDTHxHEIGHT,fx,fy,cx,cy of frames that come without");
  show.add_option("--channel", options.channel,
                  "of the frames in a log; default: the first that holds any; of a stream OPENNI_FRAME");
  show.add_option("--seconds", options.max_duration_s, "that a take of a camera lasts at most")
      .range(0.1, 86400.0)
      .capture_default_str();
  show.add_option("--cache", options.backgrounds_cache, "where rendered rooms are kept; default ~/.cache/houghstream");
  show.add_option("--seed", options.seed, "same seed, same take: same store").capture_default_str();
  show.add_option("--threads", options.threads, "any number gives the same store").range(1, 256).capture_default_str();
  add_lcm_url_option(show, words.lcm_url);
  show.add_example("hs-teach show --from-stream --name mug --out my.store --add");
  return show;
}

int run_show(ShowOptions options, const ShowWords& words) {
  if (!words.box.empty()) options.box = parse_box(words.box);
  if (!words.at.empty()) options.at = parse_place(words.at);
  require_usage(!options.box || !options.at, "expected either --box or --at");
  require_usage(options.source.empty() == words.from_stream, "expected either --source SOURCE or --from-stream");
  require_usage(!words.from_stream || options.second.empty(), "--second goes with --source, not with --from-stream");
  return words.from_stream ? show_from_stream(options, words.lcm_url) : show_sources(options, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  TeachOptions options;
  Lists lists;
  std::filesystem::path folder;
  std::string name;
  std::string new_name;
  ShowOptions shown;
  ShowWords words;
  int status = 0;
  cv::setNumThreads(1);  // views are rendered in parallel, each on one thread
  CommandLine app(
      "Teaches objects from their meshes, or by showing them, into an object store for hs-detect and hs-pose",
      "hs-teach");
  app.require_subcommand();
  app.add_example("hs-teach mesh mug.ply drill.glb --out my.store");
  const CommandLine mesh = add_mesh(app, options, lists);
  const CommandLine show = add_show(app, shown, words);
  MergeArguments merged;
  const CommandLine merge = add_merge(app, merged);
  ListArguments listed;
  const CommandLine list = add_list(app, folder, listed);
  std::filesystem::path page;
  const CommandLine report = add_report(app, folder, page);
  CommandLine remove = app.add_subcommand("remove", "takes an object out of a store");
  remove.add_option("store", folder, "object store").required();
  remove.add_option("name", name, "of the object").required();
  remove.add_example("hs-teach remove my.store mug");
  CommandLine rename = app.add_subcommand("rename", "gives an object of a store another name");
  rename.add_option("store", folder, "object store").required();
  rename.add_option("name", name, "of the object").required();
  rename.add_option("new-name", new_name, "that it gets").required();
  rename.add_example("hs-teach rename my.store object_1 cup");
  std::string frame_name;
  std::string place;
  bool remove_frame = false;
  CommandLine frame = app.add_subcommand("frame", "names a frame on an object, a grasp for instance, or moves it");
  frame.add_option("store", folder, "object store").required();
  frame.add_option("name", name, "of the object").required();
  frame.add_option("frame", frame_name, "its name").required();
  const CommandOption at = frame.add_option("--at", place, "x,y,z or x,y,z,qw,qx,qy,qz in the object's frame, metres");
  frame.add_flag("--remove", remove_frame, "takes it away").excludes(at);
  frame.add_example("hs-teach frame my.store mug handle --at 0.05,0,0.04");
  CommandLine practise = app.add_subcommand("practise", "recalibrates scores and pose quality of a store");
  practise.add_option("store", folder, "object store").required();
  practise.add_option("--names", lists.names, "MUG,DRILL: these only; default: all");
  add_calibration_options(practise, options);
  practise.add_example("hs-teach practise my.store --names mug");
  const int failed = run_tool(app, argc, argv, [&] {
    options.meshes.names = split(lists.names);
    options.meshes.ids = split(lists.ids);
    options.backgrounds.further = split(lists.backgrounds);
    options.backgrounds.threads = options.threads;
    if (show.given()) {
      status = run_show(shown, words);
    } else if (mesh.given()) {
      teach_meshes(options);
    } else if (practise.given()) {
      options.calibration.seed = options.seed;
      options.calibration.threads = options.threads;
      calibrate_store(folder, options.calibration, split(lists.names));
    } else if (merge.given()) {
      merge_stores({merged.stores.begin(), merged.stores.end()}, merged.out, merged.replace);
    } else if (list.given()) {
      print_list(store::read_store(folder), listed);
    } else if (report.given()) {
      write_store_report(folder, page);
      fmt::print("{}\n", page.string());
    } else if (frame.given()) {
      require_usage(remove_frame != !place.empty(), "expected either --at x,y,z[,qw,qx,qy,qz] or --remove");
      set_frame_in_store(folder, name, frame_name,
                         remove_frame ? std::nullopt : std::optional(parse_frame_place(place)));
    } else if (rename.given()) {
      rename_in_store(folder, name, new_name);
    } else {
      remove_from_store(folder, name);
    }
  });
  return failed != 0 ? failed : status;
}
