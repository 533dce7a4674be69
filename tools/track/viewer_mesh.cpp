#include "tools/track/viewer_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/fnv.hpp"
#include "pose/model/surface_colour.hpp"

namespace houghstream::track {
namespace {

namespace fs = std::filesystem;
using Triangle = std::array<std::uint32_t, 3>;

/// Triangles of nearly one colour.
struct Patch {
  std::vector<Triangle> triangles;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< of their colours: red, green, blue, 0 to 1

  Eigen::Vector3d colour() const { return sum / static_cast<double>(triangles.size()); }
};

/// Red, green, blue, 0 to 1; grey where the mesh has no colours.
Eigen::Vector3d colour_of(const Mesh& mesh, const Triangle& triangle) {
  const auto rgb = [](const cv::Vec3b& bgr) -> Eigen::Vector3d {
    return Eigen::Vector3d(bgr[2], bgr[1], bgr[0]) / 255.0;
  };
  if (!mesh.texture.empty() && !mesh.uvs.empty()) {
    const Eigen::Vector2f middle = (mesh.uvs[triangle[0]] + mesh.uvs[triangle[1]] + mesh.uvs[triangle[2]]) / 3.0F;
    return rgb(texel_at(mesh.texture, middle));
  }
  if (mesh.colours.empty()) return Eigen::Vector3d::Constant(0.7);
  return (rgb(mesh.colours[triangle[0]]) + rgb(mesh.colours[triangle[1]]) + rgb(mesh.colours[triangle[2]])) / 3.0;
}

/// By colour in steps of an eighth: few materials, which viewers draw one after another.
std::map<int, Patch> patches_of(const Mesh& mesh) {
  constexpr double kSteps = 8.0;
  const auto step = [](double value) {
    return std::min(static_cast<int>(value * kSteps), static_cast<int>(kSteps) - 1);
  };
  std::map<int, Patch> patches;
  for (const Triangle& triangle : mesh.triangles) {
    const Eigen::Vector3d colour = colour_of(mesh, triangle);
    Patch& patch = patches[(step(colour.x()) * 8 + step(colour.y())) * 8 + step(colour.z())];
    patch.triangles.push_back(triangle);
    patch.sum += colour;
  }
  return patches;
}

std::string vertex_lines(const Mesh& mesh) {
  std::string text;
  for (const Eigen::Vector3f& v : mesh.vertices) text += fmt::format("v {:.6f} {:.6f} {:.6f}\n", v.x(), v.y(), v.z());
  for (const Eigen::Vector3f& n : mesh.normals) text += fmt::format("vn {:.4f} {:.4f} {:.4f}\n", n.x(), n.y(), n.z());
  return text;
}

/// Indices of an OBJ count from 1.
std::string face_lines(const Patch& patch, bool normals) {
  std::string text;
  for (const Triangle& t : patch.triangles) {
    text += normals ? fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", t[0] + 1, t[1] + 1, t[2] + 1)
                    : fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return text;
}

/// meldis takes the name of the .mtl up to the first blank.
std::string file_name(const std::string& name, std::uint64_t number) {
  std::string safe = name.substr(0, 64);
  for (char& c : safe) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return fmt::format("{}-{:016x}", safe, number);
}

void write_new_file(const fs::path& file, const std::string& text) {
  std::error_code error;
  if (!fs::exists(file, error)) write_file_atomically(file, text);
}

}  // namespace

ViewerMesh write_viewer_mesh(const Mesh& mesh, const std::string& name, const fs::path& folder) {
  Patch whole;
  std::string body = vertex_lines(mesh);
  std::string materials;
  for (const auto& [number, patch] : patches_of(mesh)) {
    const Eigen::Vector3d rgb = patch.colour();
    body += fmt::format("usemtl colour_{}\n", number) + face_lines(patch, !mesh.normals.empty());
    materials += fmt::format("newmtl colour_{}\nKd {:.3f} {:.3f} {:.3f}\n", number, rgb.x(), rgb.y(), rgb.z());
    whole.triangles.insert(whole.triangles.end(), patch.triangles.begin(), patch.triangles.end());
    whole.sum += patch.sum;
  }
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, "{}: cannot make this folder: {}", folder.string(), error.message());
  const std::string stem = file_name(name, fnv1a(materials.data(), materials.size(), fnv1a(body.data(), body.size())));
  write_new_file(folder / (stem + ".mtl"), materials);  // before the mesh that names it
  const fs::path file = fs::absolute(folder / (stem + ".obj")).lexically_normal();
  write_new_file(file, "mtllib " + stem + ".mtl\n" + body);
  const Eigen::Vector3f mean = whole.colour().cast<float>();
  return {file.string(), {mean.x(), mean.y(), mean.z()}};
}

}  // namespace houghstream::track
