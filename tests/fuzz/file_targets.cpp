#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "detector/features/feature_families.hpp"
#include "detector/forest/forest_file.hpp"
#include "detector/profiles.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/camera_info.hpp"
#include "drivers/files/image_file.hpp"
#include "drivers/files/mat_file.hpp"
#include "drivers/openni/recording/oni_times.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/messages/codecs.hpp"
#include "tests/detector/forest/random_forest.hpp"
#include "tests/drivers/store/small_store.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/tools/log/recordings.hpp"
#include "tools/log/good_events.hpp"
#include "tools/log/klg_file.hpp"

namespace houghstream::fuzz {
namespace {

namespace fs = std::filesystem;

Bytes content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes_of_text(text.str());
}

fs::path scratch(const std::string& name) {
  const fs::path memory = fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
  return memory / fmt::format("houghstream_fuzz_{}_{}", getpid(), name);
}

void read_log(ByteView input) {
  log_tools::LossAccount losses;
  log_tools::GoodEvents events(as_file(input, "log"), losses);
  while (events.next()) {
  }
}

std::vector<Bytes> logs() {
  const std::string file = as_file({}, "seed_log");
  log_tools::TestLog log(file);
  for (const std::string channel : {"LEFT", "RIGHT"}) log.add_bytes(channel, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  log.close();
  return {content(file)};
}

/// Behind the line with the version: u64 length, u32 CRC-32, payload.
void repair_forest(Bytes& input) {
  const std::string line = std::string("HOUGHSTREAM FOREST ") + std::to_string(kForestFileVersion) + '\n';
  const std::size_t payload = line.size() + 12;
  if (input.size() < payload) return;
  std::copy(line.begin(), line.end(), input.begin());
  const std::uint64_t length = input.size() - payload;
  const auto crc = static_cast<std::uint32_t>(crc32_z(0, input.data() + payload, length));
  std::memcpy(input.data() + line.size(), &length, sizeof length);
  std::memcpy(input.data() + line.size() + 8, &crc, sizeof crc);
}

void read_forest(ByteView input) {
  load_forest(as_file(input, "forest"));
}

std::vector<Bytes> forests() {
  Forest forest;
  forest.profile = profile_names().front();
  forest.features.families = 1;
  forest.classes = {{1, "mug", 0.1F, 1.0F, {}}};
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
  return {content(file)};
}

void read_klg(ByteView input) {
  log_tools::KlgFile klg(as_file(input, "klg"), 16, 12);
  while (const std::optional<images_t> message = klg.next()) images_from_message(*message);
}

std::vector<Bytes> klgs() {
  log_tools::KlgWriter writer(2);
  writer.add(make_test_frame(5, 16, 12), true);
  writer.add(make_test_frame(6, 16, 12), false);
  const std::string file = as_file({}, "seed_klg");
  writer.save(file);
  return {content(file)};
}

void read_mat(ByteView input) {
  read_mat_variable(as_file(input, "mat"), "bboxes");
}

/// An array of two numbers, "MAT-File Format", The MathWorks: header, data element, its flags, sizes, name and values.
std::vector<Bytes> mats() {
  Bytes bytes(124, ' ');
  const auto put = [&](std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words) {
      for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
    }
  };
  put({0x4D490100});
  put({14, 72, 6, 8, 6, 0, 5, 8, 1, 2, 1, 6});
  const std::string name("bboxes\0\0", 8);
  bytes.insert(bytes.end(), name.begin(), name.end());
  put({9, 16, 0, 0x3FF00000, 0, 0x40000000});
  return {bytes};
}

/// Text files of a folder, divided by bytes 0.
void write_parts(ByteView input, const fs::path& folder, const std::vector<std::string>& names) {
  std::string text(reinterpret_cast<const char*>(input.data), input.size);
  for (const std::string& name : names) {
    const std::size_t end = text.find('\0');
    std::ofstream(folder / name, std::ios::binary) << text.substr(0, end);
    text = end == std::string::npos ? "" : text.substr(end + 1);
  }
}

const std::vector<std::string> kScene = {"scene_camera.json", "scene_gt.json", "scene_gt_info.json"};

void read_scene(ByteView input) {
  const fs::path folder = scratch("scene");
  fs::create_directories(folder);
  write_parts(input, folder, kScene);
  BopScene scene(folder);
}

std::vector<Bytes> scenes() {
  return {
      bytes_of_text(std::string(R"({"0":{"cam_K":[525,0,8,0,525,6,0,0,1],"depth_scale":1.0,"width":16,"height":12}})") +
                    '\0' + R"({"0":[{"cam_R_m2c":[1,0,0,0,1,0,0,0,1],"cam_t_m2c":[0,0,700],"obj_id":1}]})" + '\0' +
                    R"({"0":[{"bbox_visib":[1,2,3,4],"visib_fract":0.9}]})")};
}

const std::vector<std::string> kStore = {"store.json", "models/models_info.json"};

fs::path store_folder() {
  fs::path folder = scratch("store");
  if (fs::exists(folder)) return folder;
  fs::create_directories(folder);
  store::fill_store(folder, "brick");
  return folder;
}

void read_stored(ByteView input) {
  const fs::path folder = store_folder();
  write_parts(input, folder, kStore);
  store::load_store_meshes(store::read_store(folder));
}

std::vector<Bytes> stores() {
  const fs::path folder = scratch("seed_store");
  fs::create_directories(folder);
  store::fill_store(folder, "brick");
  Bytes both = content(folder / kStore[0]);
  both.push_back(0);
  const Bytes info = content(folder / kStore[1]);
  both.insert(both.end(), info.begin(), info.end());
  return {both};
}

void read_calibration(ByteView input) {
  read_camera_info(as_file(input, "yaml"));
}

std::vector<Bytes> calibrations() {
  return {
      bytes_of_text("image_width: 640\nimage_height: 480\ncamera_name: rgb\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
                    "  data: [525, 0, 319.5, 0, 525, 239.5, 0, 0, 1]\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n"
                    "  data: [0, 0, 0, 0, 0]\n")};
}

void read_picture(ByteView input) {
  read_colour_image(as_file(input, "png"));
}

std::vector<Bytes> pictures() {
  const std::string file = as_file({}, "seed.png");
  write_png(make_test_frame(5, 16, 12).colour, file);
  return {content(file), encode_jpeg(make_test_frame(5, 16, 12).colour, 90)};
}

void read_oni(ByteView input) {
  openni::check_oni(as_file(input, "oni"));
}

/// A file's head, a stream of one image, that image, its end.
std::vector<Bytes> recordings() {
  Bytes bytes = {'N', 'I', '1', '0', 1, 0, 1, 0, 0, 0, 0, 0};
  bytes.resize(24);
  const auto record = [&](std::uint32_t type, const Bytes& fields, std::uint32_t payload) {
    for (const std::uint32_t word :
         {0x0052494EU, type, 1U, 28 + static_cast<std::uint32_t>(fields.size()), payload, 0U, 0U}) {
      for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
    }
    bytes.insert(bytes.end(), fields.begin(), fields.end());
    bytes.resize(bytes.size() + payload);
  };
  Bytes node(8 + 28);
  node[8] = 1;
  record(13, node, 0);
  record(10, Bytes(20), 16);
  record(11, {}, 0);
  return {bytes};
}

}  // namespace

std::string as_file(ByteView input, const std::string& ending) {
  const fs::path file = scratch(ending);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.data), static_cast<std::streamsize>(input.size));
  return file.string();
}

std::vector<FuzzTarget> file_targets() {
  return {
      {"log", read_log, logs, nullptr, {"\xED\xA1\xDA\x01"}},
      {"forest", read_forest, forests, repair_forest, {"realtime", "paper", "gall"}},
      {"klg", read_klg, klgs, nullptr, {}},
      {"mat", read_mat, mats, nullptr, {"bboxes"}},
      {"scene",
       read_scene,
       scenes,
       nullptr,
       {"cam_K", "cam_R_m2c", "cam_t_m2c", "bbox_visib", "obj_id", "null", "1e400"}},
      {"store", read_stored, stores, nullptr, {"symmetries_discrete", "symmetries_continuous", "version", "objects"}},
      {"calibration", read_calibration, calibrations, nullptr, {"!!opencv-matrix", "data:", "&a", "*a", "- [", "{"}},
      {"picture",
       read_picture,
       pictures,
       nullptr,
       {"IHDR", "IDAT", "PLTE", "tRNS", "IEND", "\xFF\xDA", "\xFF\xC2", "\xFF\x01"}},
      {"oni", read_oni, recordings, nullptr, {"NIR"}}};
}

std::vector<FuzzTarget> fuzz_targets() {
  std::vector<FuzzTarget> all;
  for (const auto& some : {message_targets(), file_targets(), mesh_targets(), text_targets()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace houghstream::fuzz
