#include <fmt/format.h>
#include <libdeflate.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "detector/detection_settings.hpp"
#include "detector/features/feature_families.hpp"
#include "detector/forest/forest_file.hpp"
#include "detector/forest/forest_index.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/camera_info.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/messages/codecs.hpp"
#include "tests/detector/forest/earlier_forest_files.hpp"
#include "tests/detector/forest/random_forest.hpp"
#include "tests/drivers/store/small_store.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/pipeline/test_frame.hpp"

namespace houghstream::fuzz {
namespace {

namespace fs = std::filesystem;

fs::path scratch(const std::string& name) {
  const fs::path memory = fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
  return memory / fmt::format("houghstream_fuzz_{}_{}", getpid(), name);
}

/// The line with the version is followed by u64 length, u32 CRC-32 and payload.
void repair_forest(Bytes& input) {
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  std::string line = fmt::format("HOUGHSTREAM FOREST {}\n", kForestFileVersion);
  for (const char* earlier : {"HOUGHSTREAM FOREST 16\n", "HOUGHSTREAM FOREST 17\n"}) {  // are read too
    if (text.substr(0, line.size()) == earlier) line = earlier;
  }
  const std::size_t payload = line.size() + 12;
  if (input.size() < payload) return;
  std::copy(line.begin(), line.end(), input.begin());
  const std::uint64_t length = input.size() - payload;
  const auto crc = libdeflate_crc32(0, input.data() + payload, length);
  std::memcpy(input.data() + line.size(), &length, sizeof length);
  std::memcpy(input.data() + line.size() + 8, &crc, sizeof crc);
}

Taken read_forest(ByteView input) {
  const Forest forest = load_forest(as_file(input, "forest"));
  const ForestIndex index(forest);
  return {forest.classes.size() + forest.nodes.size() + index.leaf_summaries().size()};
}

std::vector<Bytes> forests() {
  Forest forest;
  forest.profile = profile_names().front();
  forest.features.families = 1;
  ObjectClass& mug = forest.classes.emplace_back();
  mug.class_id = 1;
  mug.name = "mug";
  mug.radius = 0.1F;
  forest.roots = {0};
  TreeNode node{};
  node.left = -1;
  node.right = -2;
  forest.nodes = {node};
  forest.leaves = {0, 1, 2};
  forest.leaf_weights = {1.0F, 1.0F};
  LeafClass entry{};
  entry.probability = 0.5F;
  forest.leaf_classes = {entry, entry};
  const std::string file = as_file({}, "seed_forest");
  save_forest(forest, file);
  std::vector<Bytes> files{content_of(file)};
  for (const std::string& earlier : {forest_file_of_version_16(forest), forest_file_of_version_17(forest)})
    files.emplace_back(earlier.begin(), earlier.end());
  return files;
}

/// Writes text files of a folder, which bytes 0 divide.
void write_parts(ByteView input, const fs::path& folder, const std::vector<std::string>& names) {
  std::string text(reinterpret_cast<const char*>(input.data), input.size);
  for (const std::string& name : names) {
    const std::size_t end = text.find('\0');
    std::ofstream(folder / name, std::ios::binary) << text.substr(0, end);
    text = end == std::string::npos ? "" : text.substr(end + 1);
  }
}

const std::vector<std::string> kScene = {"scene_camera.json", "scene_gt.json", "scene_gt_info.json"};

/// Reads images and their objects.
Taken read_scene(ByteView input) {
  const fs::path folder = scratch("scene");
  fs::create_directories(folder);
  write_parts(input, folder, kScene);
  const BopScene scene(folder);
  Taken taken;
  for (const BopImage& image : scene.images()) taken.items += 1 + image.objects.size();
  return taken;
}

std::vector<Bytes> scenes() {
  const std::string camera = R"({"cam_K":[525,0,8,0,525,6,0,0,1],"depth_scale":1.0,"width":16,"height":12})";
  const std::string truth = R"({"cam_R_m2c":[1,0,0,0,1,0,0,0,1],"cam_t_m2c":[0,0,700],"obj_id":1})";
  const std::string info = R"({"bbox_visib":[1,2,3,4],"visib_fract":0.9})";
  const auto twice = [](const std::string& first, const std::string& second) {
    return fmt::format(R"({{"0":{},"1":{}}})", first, second);
  };
  const auto list = [](const std::string& entry) { return fmt::format("[{},{}]", entry, entry); };
  return {bytes_of_text(twice(camera, camera) + '\0' + twice(list(truth), list(truth)) + '\0' +
                        twice(list(info), list(info)))};
}

const std::vector<std::string> kStore = {"store.json", "models/models_info.json", "models/names.json"};

fs::path store_folder() {
  fs::path folder = scratch("store");
  if (fs::exists(folder)) return folder;
  fs::create_directories(folder);
  store::fill_store(folder, "brick");
  return folder;
}

/// Reads objects, their data and triangles.
Taken read_stored(ByteView input) {
  const fs::path folder = store_folder();
  write_parts(input, folder, kStore);
  const store::ObjectStore stored = store::read_store(folder);
  Taken taken{stored.objects.size() + stored.quality().size()};
  for (const store::StoredObject& object : stored.objects) {
    const Symmetries& symmetries = stored.symmetries.at(object.id);
    taken.items += symmetries.discrete.size() + symmetries.continuous.size();
  }
  for (const auto& [name, mesh] : store::load_store_meshes(stored)) taken.items += mesh.triangles.size();
  return taken;
}

std::vector<Bytes> stores() {
  const fs::path folder = scratch("seed_store");
  fs::create_directories(folder);
  store::fill_store(folder, "brick");
  Bytes parts;
  for (const std::string& name : kStore) {
    if (!parts.empty()) parts.push_back(0);
    const Bytes part = content_of(folder / name);
    parts.insert(parts.end(), part.begin(), part.end());
  }
  return {parts};
}

/// Reads all of a camera's six numbers or none.
Taken read_calibration(ByteView input) {
  read_camera_info(as_file(input, "yaml"));
  return {6};
}

std::vector<Bytes> calibrations() {
  return {
      bytes_of_text("image_width: 640\nimage_height: 480\ncamera_name: rgb\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
                    "  data: [525, 0, 319.5, 0, 525, 239.5, 0, 0, 1]\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
                    "  data: [0, 0, 0, 0, 0]\n")};
}

Taken read_png(ByteView input) {
  return {read_colour_image(as_file(input, "colour.png")).total()};
}

std::vector<Bytes> pngs() {
  const std::string file = as_file({}, "seed.png");
  write_png(make_test_frame(5, 16, 12).colour, file);
  return {content_of(file)};
}

Taken read_depth(ByteView input) {
  return {read_depth_image(as_file(input, "depth.png")).total()};
}

std::vector<Bytes> depth_pngs() {
  const std::string file = as_file({}, "seed.png");
  write_png(depth_to_millimetres(make_test_frame(5, 16, 12).depth), file);
  return {content_of(file)};
}

Taken read_jpeg(ByteView input) {
  return {read_colour_image(as_file(input, "jpg")).total()};
}

std::vector<Bytes> jpegs() {
  return {encode_jpeg(make_test_frame(5, 16, 12).colour, 90)};
}

}  // namespace

std::string as_file(ByteView input, const std::string& ending) {
  const fs::path file = scratch(ending);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data), static_cast<std::streamsize>(input.size));
  return file.string();
}

Bytes content_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes_of_text(text.str());
}

std::vector<FuzzTarget> file_targets() {
  const std::vector<std::string> png_words = {"IHDR", "IDAT", "PLTE", "tRNS", "IEND"};
  return {{"forest", read_forest, forests, repair_forest, {"realtime", "paper", "gall"}, 4096, kAnyDamage},
          {"scene",
           read_scene,
           scenes,
           nullptr,
           {"cam_K", "cam_R_m2c", "cam_t_m2c", "bbox_visib", "obj_id", "null", "1e400"},
           4096,
           kAnyDamage},
          {"store",
           read_stored,
           stores,
           nullptr,
           {"symmetries_discrete", "symmetries_continuous", "version", "objects"},
           4096,
           kAnyDamage},
          {"calibration",
           read_calibration,
           calibrations,
           nullptr,
           {"!!opencv-matrix", "data:", "&a", "*a", "- [", "{"},
           4096,
           kAnyDamage},
          {"png", read_png, pngs, nullptr, png_words, 4096, kAnyDamage},
          {"depth", read_depth, depth_pngs, nullptr, png_words, 4096, kAnyDamage},
          // A file states its size once, without a checksum: a reader who knows the camera detects a changed size.
          {"jpeg", read_jpeg, jpegs, nullptr, {"\xFF\xDA", "\xFF\xC2", "\xFF\x01"}, 4096, {true, {}}}};
}

std::vector<FuzzTarget> fuzz_targets() {
  std::vector<FuzzTarget> all;
  for (const auto& some : {message_targets(), file_targets(), recording_targets(), mesh_targets(), text_targets()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace houghstream::fuzz
