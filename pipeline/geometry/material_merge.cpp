#include "pipeline/geometry/material_merge.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/image_decoding.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

bool is_textured(const MeshPart& part) {
  return part.has_uvs && !part.texture.empty();
}

cv::Mat read_texture(const MeshPart& part, const fs::path& file) {
  if (!part.image.empty()) return part.image;
  cv::Mat texture;
  if (fs::is_regular_file(part.texture)) texture = decode_image_file(part.texture, cv::IMREAD_COLOR);
  require(!texture.empty(), "{}: missing or unreadable, expected the texture of {}", part.texture.string(),
          file.string());
  return texture;
}

/// Returns one tile for each part: its texture, or its colour.
std::vector<cv::Mat> read_tiles(const std::vector<MeshPart>& parts, const fs::path& file) {
  constexpr int kColourTile_px = 64;  // wide enough for its middle to stay clean when textures are blurred
  const cv::Vec3b kGrey(128, 128, 128);
  std::vector<cv::Mat> tiles;
  for (const MeshPart& part : parts) {
    const cv::Vec3b colour = part.has_colour ? part.colour : kGrey;
    tiles.push_back(is_textured(part) ? read_texture(part, file)
                                      : cv::Mat(kColourTile_px, kColourTile_px, CV_8UC3, cv::Scalar(colour)));
  }
  return tiles;
}

/// Moves the texture coordinates of a part into its tile.
void move_into(const cv::Rect& tile, const cv::Size& whole, const MeshPart& part, const fs::path& file, Mesh& mesh) {
  constexpr float kRounding = 1e-3F;
  for (std::size_t i = part.first_vertex; i < part.first_vertex + part.vertices; ++i) {
    Eigen::Vector2f& uv = mesh.uvs[i];
    if (!is_textured(part)) uv = {0.5F, 0.5F};
    require(uv.minCoeff() > -kRounding && uv.maxCoeff() < 1.0F + kRounding,
            "{}: texture coordinates {}, {}, expected 0 to 1 in a mesh with several textures", file.string(), uv.x(),
            uv.y());
    uv.x() = (static_cast<float>(tile.x) + uv.x() * static_cast<float>(tile.width)) / static_cast<float>(whole.width);
    uv.y() = uv.y() * static_cast<float>(tile.height) / static_cast<float>(whole.height);
  }
}

void pack_texture_atlas(const std::vector<MeshPart>& parts, const fs::path& file, Mesh& mesh) {
  const std::vector<cv::Mat> tiles = read_tiles(parts, file);
  cv::Size size(0, 0);
  for (const cv::Mat& tile : tiles) size = {size.width + tile.cols, std::max(size.height, tile.rows)};
  mesh.texture = cv::Mat::zeros(size, CV_8UC3);
  int x = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const cv::Rect place({x, 0}, tiles[p].size());
    tiles[p].copyTo(mesh.texture(place));
    move_into(place, size, parts[p], file, mesh);
    x += tiles[p].cols;
  }
}

void paint_vertices(const std::vector<MeshPart>& parts, Mesh& mesh) {
  const bool all_coloured = std::all_of(parts.begin(), parts.end(), [](const MeshPart& p) { return p.has_colour; });
  if (!all_coloured) return;
  for (const MeshPart& part : parts) mesh.colours.insert(mesh.colours.end(), part.vertices, part.colour);
}

}  // namespace

void paint(const std::vector<MeshPart>& parts, const fs::path& file, Mesh& mesh) {
  // Parts that disagree about an attribute would leave it without a meaning per vertex.
  if (mesh.colours.size() != mesh.vertices.size()) mesh.colours.clear();
  const bool any_textured = std::any_of(parts.begin(), parts.end(), is_textured);
  const bool one_texture = std::all_of(parts.begin(), parts.end(), [&](const MeshPart& part) {
    return is_textured(part) && part.texture == parts.front().texture;
  });
  if (one_texture) {
    mesh.texture = read_texture(parts.front(), file);
  } else if (any_textured) {
    pack_texture_atlas(parts, file, mesh);
  } else {
    mesh.uvs.clear();
    if (mesh.colours.empty()) paint_vertices(parts, mesh);
  }
}

}  // namespace houghstream
