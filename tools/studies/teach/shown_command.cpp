#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "drivers/files/image_file.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/fuse/model_image.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/teach/shown_comparison.hpp"

namespace {

using namespace houghstream;

struct CompareOptions {
  std::string takes;
  std::filesystem::path kept;
  std::string object;
  std::filesystem::path out;
};

cv::Vec3b texel(const cv::Mat& texture, const Eigen::Vector2f& uv) {
  const int x = std::clamp(static_cast<int>(uv.x() * static_cast<float>(texture.cols)), 0, texture.cols - 1);
  const int y = std::clamp(static_cast<int>(uv.y() * static_cast<float>(texture.rows)), 0, texture.rows - 1);
  return texture.at<cv::Vec3b>(y, x);
}

/// Returns a mesh with a texture, cut so finely that colours of vertices show it, since images of models have only
/// those.
Mesh finely_coloured(const Mesh& mesh) {
  constexpr double kSide_m = 0.002;
  if (mesh.texture.empty()) return mesh;
  Mesh fine;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f ab = mesh.vertices[b] - mesh.vertices[a];
    const Eigen::Vector3f ac = mesh.vertices[c] - mesh.vertices[a];
    const double max_length = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(max_length / kSide_m)));
    const auto first = static_cast<std::uint32_t>(fine.vertices.size());
    const auto at = [&](int i, int j) { return first + static_cast<std::uint32_t>(i * (2 * parts + 3 - i) / 2 + j); };
    for (int i = 0; i <= parts; ++i) {
      for (int j = 0; j <= parts - i; ++j) {
        const float u = static_cast<float>(i) / static_cast<float>(parts);
        const float v = static_cast<float>(j) / static_cast<float>(parts);
        const float w = 1.0F - u - v;
        fine.vertices.push_back(w * mesh.vertices[a] + u * mesh.vertices[b] + v * mesh.vertices[c]);
        fine.normals.push_back(w * mesh.normals[a] + u * mesh.normals[b] + v * mesh.normals[c]);
        fine.colours.push_back(texel(mesh.texture, w * mesh.uvs[a] + u * mesh.uvs[b] + v * mesh.uvs[c]));
        if (j < parts - i) fine.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i > 0 && j < parts - i) fine.triangles.push_back({at(i, j), at(i, j + 1), at(i - 1, j + 1)});
      }
    }
  }
  return fine;
}

void run(const CompareOptions& options) {
  const studies::TrueTakes takes = studies::read_true_takes(options.takes, options.object);
  const Mesh taught = load_mesh(options.kept / "model.ply");
  const studies::ShownComparison comparison = studies::compare_shown(takes, options.kept, taught);
  std::filesystem::create_directories(options.out);
  write_json(to_json(comparison), options.out / "compared.json");
  Mesh placed = taught;  // in the frame of the ground-truth mesh
  for (Eigen::Vector3f& vertex : placed.vertices) vertex = comparison.T_true_taught.cast<float>() * vertex;
  for (Eigen::Vector3f& normal : placed.normals) normal = comparison.T_true_taught.linear().cast<float>() * normal;
  write_png(draw_model(placed), options.out / "taught.png");
  write_png(draw_model(finely_coloured(takes.mesh)), options.out / "true.png");
  fmt::print("{}: {:.2f} mm from the true surface (95 %: {:.2f}), masks {:.3f}, {} views\n", options.object,
             1e3 * comparison.taught_to_true.median, 1e3 * comparison.taught_to_true.maximum, comparison.mask_iou,
             comparison.views);
}

}  // namespace

int houghstream::studies::shown_command(CommandLine& app, int argc, char** argv) {
  CompareOptions options;
  app.add_option("--takes", options.takes, "folder of hs-render takes").required();
  app.add_option("--object", options.object, "its name there").required();
  app.add_option("--kept", options.kept, "folder of hs-teach show --keep").required();
  app.add_option("--out", options.out, "folder for compared.json, taught.png and true.png").required();
  app.add_example("hs-study shown --takes TAKES --object mug --kept KEPT --out OUT");
  return run_tool(app, argc, argv, [&] { run(options); });
}
