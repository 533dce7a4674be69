#include "tools/teach/mesh/background_images.hpp"

#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "pipeline/base/cache_folder.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/folder_exchange.hpp"
#include "pipeline/base/log_line.hpp"
#include "tools/render/render_jobs.hpp"
#include "tools/train/training_sources.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;

/// Of the rendered rooms; to be raised when they come to look otherwise.
constexpr int kRoomsVersion = 1;
constexpr std::uint64_t kRoomsSeed = 1;

/// What renderings that were interrupted have left; the name ends in the number of their process.
void remove_leftovers(const fs::path& cache, const std::string& prefix) {
  for (const auto& entry : fs::directory_iterator(cache)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(prefix, 0) != 0) continue;
    const int process = std::atoi(name.substr(prefix.size()).c_str());
    if (process > 0 && (kill(process, 0) == 0 || errno == EPERM)) continue;
    std::error_code error;
    fs::remove_all(entry.path(), error);
  }
}

/// The folder of the rendered rooms; renders them beside it first where it is missing, so that it is always whole.
fs::path render_backgrounds(const BackgroundSettings& settings) {
  const fs::path cache = settings.cache.empty() ? cache_folder("--cache FOLDER") : settings.cache;
  fs::path rooms = cache / fmt::format("rooms-{}-{}", kRoomsVersion, settings.count);
  if (fs::exists(rooms / "scene_gt_info.json")) return rooms;
  std::error_code error;
  fs::create_directories(cache, error);
  require(!error, "{}: cannot make this folder: {}; --cache names another", cache.string(), error.message());
  const std::string prefix = rooms.filename().string() + ".partial-";
  remove_leftovers(cache, prefix);
  const fs::path partial = cache / (prefix + std::to_string(getpid()));
  log_info("rooms are rendered once into {}", rooms.string());
  render::RenderOptions options;
  options.out = partial;
  options.seed = kRoomsSeed;
  options.threads = settings.threads;
  options.replace = true;  // what an interrupted process of this number has left
  render::render_background(options, settings.count);
  sync_folder_to_disk(partial);  // a power cut must not leave half of it for every later teaching
  fs::rename(partial, rooms, error);
  if (error) {  // another teaching was faster
    require(fs::exists(rooms / "scene_gt_info.json"), "{}: cannot be written: {}", rooms.string(), error.message());
    fs::remove_all(partial);
  }
  return rooms;
}

}  // namespace

std::vector<TrainingView> read_backgrounds(const BackgroundSettings& settings) {
  TrainingSources sources;
  sources.backgrounds = {"bop:" + render_backgrounds(settings).string()};
  sources.backgrounds.insert(sources.backgrounds.end(), settings.further.begin(), settings.further.end());
  sources.camera = settings.camera;
  return read_training_sources(sources, settings.threads);
}

}  // namespace houghstream::teach
