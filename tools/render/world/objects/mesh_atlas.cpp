#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

constexpr int kGutterPx = 8;  // edge pixels repeated around each texture, so that smaller mip levels do not bleed
constexpr int kMinAtlasWidthPx = 1024;

// Textures set side by side in shelves, in the order given.
struct Atlas {
  std::vector<cv::Mat> textures;
  std::vector<cv::Rect> places;
  cv::Size size;
};

std::size_t index_in(const std::vector<cv::Mat>& textures, const cv::Mat& texture) {
  const auto same = [&texture](const cv::Mat& other) {
    return other.data == texture.data && other.size() == texture.size();
  };
  return static_cast<std::size_t>(std::find_if(textures.begin(), textures.end(), same) - textures.begin());
}

Atlas layout(const std::vector<Part>& parts) {
  Atlas atlas;
  for (const Part& part : parts) {
    if (index_in(atlas.textures, part.mesh.texture) == atlas.textures.size())
      atlas.textures.push_back(part.mesh.texture);
  }
  int widest = kMinAtlasWidthPx;
  for (const cv::Mat& texture : atlas.textures) widest = std::max(widest, texture.cols + 2 * kGutterPx);
  int x = 0;
  int y = 0;
  int shelf = 0;
  for (const cv::Mat& texture : atlas.textures) {
    if (x + texture.cols + 2 * kGutterPx > widest) {
      x = 0;
      y += shelf;
      shelf = 0;
    }
    atlas.places.emplace_back(x + kGutterPx, y + kGutterPx, texture.cols, texture.rows);
    x += texture.cols + 2 * kGutterPx;
    shelf = std::max(shelf, texture.rows + 2 * kGutterPx);
    atlas.size.width = std::max(atlas.size.width, x);
  }
  atlas.size.height = y + shelf;
  return atlas;
}

cv::Mat draw(const Atlas& atlas) {
  cv::Mat image(atlas.size, CV_8UC3, cv::Scalar::all(128));
  for (std::size_t i = 0; i < atlas.textures.size(); ++i) {
    const cv::Rect place = atlas.places[i];
    const cv::Rect framed(place.x - kGutterPx, place.y - kGutterPx, place.width + 2 * kGutterPx,
                          place.height + 2 * kGutterPx);
    cv::Mat target = image(framed);
    cv::copyMakeBorder(atlas.textures[i], target, kGutterPx, kGutterPx, kGutterPx, kGutterPx, cv::BORDER_REPLICATE);
  }
  return image;
}

// Maps the part's own texture to the atlas, pixel centre to pixel centre at the borders.
Eigen::Vector2f to_atlas(const Eigen::Vector2f& uv, const cv::Rect& place, const cv::Size& size) {
  const double x = place.x + 0.5 + static_cast<double>(uv.x()) * (place.width - 1);
  const double y = place.y + 0.5 + static_cast<double>(uv.y()) * (place.height - 1);
  return Eigen::Vector2d(x / size.width, y / size.height).cast<float>();
}

}  // namespace

Mesh compose(const std::vector<Part>& parts) {
  const Atlas atlas = layout(parts);
  Mesh joined;
  joined.texture = draw(atlas);
  for (const Part& part : parts) {
    const cv::Rect place = atlas.places[index_in(atlas.textures, part.mesh.texture)];
    const auto first = static_cast<std::uint32_t>(joined.vertices.size());
    const Eigen::Isometry3f T = part.T_object_part.cast<float>();
    for (std::size_t i = 0; i < part.mesh.vertices.size(); ++i) {
      joined.vertices.push_back(T * part.mesh.vertices[i]);
      joined.normals.push_back(T.linear() * part.mesh.normals[i]);
      joined.uvs.push_back(to_atlas(part.mesh.uvs[i], place, atlas.size));
    }
    for (const auto& triangle : part.mesh.triangles) {
      joined.triangles.push_back({first + triangle[0], first + triangle[1], first + triangle[2]});
    }
  }
  return joined;
}

Mesh finish_object(Mesh mesh) {
  const Eigen::Vector3f centre = mesh_bounds(mesh).center();
  mesh.colours.clear();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] -= centre;
    const int x = std::clamp(static_cast<int>(static_cast<double>(mesh.uvs[i].x()) * mesh.texture.cols), 0,
                             mesh.texture.cols - 1);
    const int y = std::clamp(static_cast<int>(static_cast<double>(mesh.uvs[i].y()) * mesh.texture.rows), 0,
                             mesh.texture.rows - 1);
    mesh.colours.push_back(mesh.texture.at<cv::Vec3b>(y, x));
  }
  return mesh;
}

}  // namespace houghstream::world
