#include "tools/pose/model_cache.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <link.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "drivers/store/store_stamp.hpp"
#include "pipeline/base/archive.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/fnv.hpp"
#include "pipeline/base/log_line.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStart = "HOUGHSTREAM MODELS\n";
constexpr const char* kEnding = ".models";

/// A single list of members serves writing and reading, so that the two cannot drift apart.
template <typename Archive, typename ModelType>
void archive_model(Archive& archive, ModelType& model) {
  archive(model.mesh.vertices);
  archive(model.mesh.normals);
  archive(model.mesh.colours);
  archive(model.mesh.uvs);
  archive(model.mesh.triangles);
  archive(model.mesh.texture);
  archive(model.centre);
  archive(model.vote_centre);
  archive(model.surface_median);
  archive(model.axes);
  archive(model.thin_axis);
  archive(model.thickness);
  archive(model.radius);
  archive(model.shape_symmetries.discrete);
  archive(model.shape_symmetries.continuous);
  archive(model.nearly_round);
  archive(model.views);
  archive(model.texture.detail_m);
  archive(model.texture.cubes);
  archive(model.texture.normals);
  archive(model.texture.colours);
  archive(model.alternatives);
  archive(model.near_alternatives);
  archive(model.partial_alternatives);
  archive(model.unround_points);
  archive(model.unround_normals);
  archive(model.is_unround_alike);
}

template <typename Archive, typename ViewType>
void archive_view(Archive& archive, ViewType& view) {
  archive(view.direction);
  archive(view.points);
  archive(view.normals);
  archive(view.colours);
  archive(view.area);
}

struct ModelWriter : ArchiveWriter {
  using ArchiveWriter::operator();
  void operator()(const std::vector<ModelView>& views) {
    (*this)(std::uint64_t{views.size()});
    for (const ModelView& view : views) archive_view(*this, view);
  }
  void operator()(const std::optional<ContinuousSymmetry>& axis) {
    (*this)(axis ? std::vector<ContinuousSymmetry>{*axis} : std::vector<ContinuousSymmetry>{});
  }
  void operator()(const cv::Mat& texture) {
    (*this)(static_cast<std::uint64_t>(texture.rows));
    (*this)(static_cast<std::uint64_t>(texture.cols));
    for (int y = 0; y < texture.rows; ++y) put(texture.ptr(y), static_cast<std::size_t>(texture.cols) * 3);
  }
};

struct ModelReader : ArchiveReader<> {
  using ArchiveReader<>::operator();
  void operator()(std::vector<ModelView>& views) {
    views.resize(count(sizeof(float)));
    for (ModelView& view : views) archive_view(*this, view);
  }
  void operator()(std::optional<ContinuousSymmetry>& axis) {
    std::vector<ContinuousSymmetry> axes;
    (*this)(axes);
    if (!axes.empty()) axis = axes.front();
  }
  void operator()(cv::Mat& texture) {
    constexpr std::size_t kMax = 1U << 15U;
    const std::size_t rows = count(1);
    const std::size_t columns = count(1);
    require(rows <= kMax && columns <= kMax && 3 * rows * columns <= bytes.size(), "a texture");
    if (rows * columns == 0) return;
    texture.create(static_cast<int>(rows), static_cast<int>(columns), CV_8UC3);
    take(texture.data, 3 * rows * columns);
  }
};

std::string text_of(const ShapeSymmetry& shape) {
  std::string text;
  const auto add = [&](const ContinuousSymmetry& axis) {
    for (const double value : axis.axis) text += fmt::format("{} ", value);
    for (const double value : axis.offset) text += fmt::format("{} ", value);
  };
  for (const Eigen::Isometry3d& motion : shape.symmetries.discrete) {
    for (const double value : motion.matrix().reshaped()) text += fmt::format("{} ", value);
  }
  for (const ContinuousSymmetry& axis : shape.symmetries.continuous) add(axis);
  text += '|';
  if (shape.nearly_round) add(*shape.nearly_round);
  return text;
}

void check_model(const ObjectModel& model) {
  const Mesh& mesh = model.mesh;
  const std::size_t vertices = mesh.vertices.size();
  const auto fits = [&](std::size_t size) { return size == 0 || size == vertices; };
  require(fits(mesh.normals.size()) && fits(mesh.colours.size()) && fits(mesh.uvs.size()), "lists of a mesh");
  for (const auto& triangle : mesh.triangles)
    require(*std::max_element(triangle.begin(), triangle.end()) < vertices, "a triangle");
  require(!mesh.triangles.empty() && !model.views.empty(), "nothing to see");
  for (const ModelView& view : model.views) {
    const std::size_t points = view.points.size();
    require(points > 0 && view.normals.size() == points && (view.colours.empty() || view.colours.size() == points),
            "lists of a view");
  }
  const std::size_t sides = model.texture.cubes.size();
  require(model.texture.normals.size() == sides && model.texture.colours.size() == sides, "lists of a print");
  require(model.nearly_round || model.unround_points.empty(), "a handle of a shape that is not nearly round");
  require(model.unround_points.size() == model.unround_normals.size(), "lists of a handle");
}

int add_library(dl_phdr_info* info, std::size_t /*size*/, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(info->dlpi_name);
  return 0;
}

std::string state_of_program() {
  std::vector<std::string> libraries;
  dl_iterate_phdr(add_library, &libraries);
  std::string state = store::file_stamp("/proc/self/exe") + '\n';
  for (const std::string& library : libraries) {
    if (!library.empty() && library.front() == '/') state += store::file_stamp(library) + '\n';
  }
  return state;
}

/// Returns whether nobody else can have written it.
bool is_own(const fs::path& file) {
  struct stat is {};
  constexpr mode_t kOthersWrite = S_IWGRP | S_IWOTH;
  return lstat(file.c_str(), &is) == 0 && S_ISREG(is.st_mode) && is.st_uid == geteuid() &&
         (is.st_mode & kOthersWrite) == 0;
}

std::uint32_t checksum(std::string_view bytes) {
  return libdeflate_crc32(0, bytes.data(), bytes.size());
}

/// Removes the least recently written ones of more than a few.
void forget_oldest(const fs::path& folder) {
  constexpr std::size_t kKept = 8;
  std::vector<std::pair<fs::file_time_type, fs::path>> kept;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == kEnding) kept.emplace_back(entry.last_write_time(), entry.path());
  }
  std::sort(kept.begin(), kept.end());
  for (std::size_t i = 0; i + kKept < kept.size(); ++i) fs::remove(kept[i].second);
}

}  // namespace

ModelCache::ModelCache(fs::path folder) : folder_(std::move(folder)), program_(state_of_program()) {}

std::string ModelCache::state_of(const std::string& stamp, const ModelSettings& settings) const {
  std::string state = fmt::format("{}{}\n", program_, stamp);
  for_each_number(settings, [&](const auto& field, auto value) { state += fmt::format("{} {}\n", field.name, value); });
  for (const auto& [name, centre] : settings.vote_centres)
    state += fmt::format("{} {} {} {}\n", name, centre.x(), centre.y(), centre.z());
  for (const auto& [name, same] : settings.symmetries) state += fmt::format("{} {}\n", name, text_of({same, {}}));
  for (const auto& [name, shape] : settings.shape_symmetries) state += fmt::format("{} {}\n", name, text_of(shape));
  return state;
}

fs::path ModelCache::file_of(const fs::path& folder) const {
  const std::string place = fs::weakly_canonical(fs::absolute(folder)).string();
  return folder_ / fmt::format("{:016x}{}", fnv1a(place.data(), place.size()), kEnding);
}

std::optional<std::map<std::string, ObjectModel>> ModelCache::find(const fs::path& folder,
                                                                   const std::string& state) const {
  if (folder_.empty()) return std::nullopt;
  try {
    const fs::path file = file_of(folder);
    if (!is_own(file)) return std::nullopt;
    const std::string content = read_file(file, "kept models");
    ModelReader reader{{content, "kept models"}};
    std::string start(kStart.size(), ' ');
    std::uint32_t crc = 0;
    std::string its_state;
    reader.take(start.data(), start.size());
    reader(crc);
    require(start == kStart && checksum(reader.bytes) == crc, "damaged");
    reader(its_state);
    if (its_state != state) return std::nullopt;
    std::map<std::string, ObjectModel> models;
    for (std::size_t left = reader.count(1); left > 0; --left) {
      std::string name;
      reader(name);
      ObjectModel& model = models[name];
      archive_model(reader, model);
      check_model(model);
    }
    require(reader.bytes.empty(), "longer than expected");
    return models;
  } catch (const std::exception& error) {
    log_debug("kept models cannot be used: {}", error.what());
    return std::nullopt;
  }
}

void ModelCache::keep(const fs::path& folder, const std::string& state,
                      const std::map<std::string, ObjectModel>& models) const {
  if (folder_.empty() || models.empty()) return;
  try {
    ModelWriter writer;
    writer(state);
    writer(std::uint64_t{models.size()});
    for (const auto& [name, model] : models) {
      writer(name);
      archive_model(writer, model);
    }
    const std::uint32_t crc = checksum(writer.bytes);
    fs::create_directories(folder_);
    const fs::path file = file_of(folder);
    write_file_atomically(
        file, std::string(kStart) + std::string(reinterpret_cast<const char*>(&crc), sizeof crc) + writer.bytes);
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
    forget_oldest(folder_);
  } catch (const std::exception& error) {
    log_debug("models cannot be kept: {}", error.what());
  }
}

}  // namespace houghstream
