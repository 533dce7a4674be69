#include <array>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/mesh_text.hpp"
#include "pipeline/geometry/mesh_check.hpp"

namespace houghstream {
namespace {

using namespace mesh_text;

/// What an OBJ has given so far.
struct ObjCounts {
  std::int64_t vertices = 0;
  std::int64_t uvs = 0;
  std::int64_t normals = 0;
  std::int64_t last_used = 0;                                // the highest vertex that belongs to a face
  std::vector<std::pair<std::int64_t, std::int64_t>> edges;  // of faces, the smaller vertex first
};

/// Which of the three numbers of a corner are there: 1 vertex, 2 texture coordinates, 4 normal.
int check_obj_corner(std::string_view word, const ObjCounts& counts, std::int64_t& vertex, const std::string& where) {
  const std::array<std::int64_t, 3> there = {counts.vertices, counts.uvs, counts.normals};
  int parts = 0;
  std::size_t part = 0;
  for (; part < 3; ++part) {
    const std::size_t end = std::min(word.find('/'), word.size());
    const std::string_view text = word.substr(0, end);
    if (!text.empty()) {
      const std::optional<std::int64_t> index = number_of<std::int64_t>(text);
      const std::int64_t at = index ? (*index < 0 ? there[part] + 1 + *index : *index) : 0;
      require(at >= 1 && at <= there[part], "{}: corner '{}', expected one of the {} given before", where, shown(text),
              there[part]);
      parts |= 1 << part;
      if (part == 0) vertex = at;
    }
    if (end == word.size()) break;
    word.remove_prefix(end + 1);
  }
  require(part < 3 && (parts & 1) != 0, "{}: a corner without a vertex", where);
  return parts;
}

void check_obj_numbers(const Words& words, std::size_t least, std::size_t most, const std::string& where) {
  require(words.size() - 1 >= least && words.size() - 1 <= most, "{}: {} numbers, expected {} to {}", where,
          words.size() - 1, least, most);
  for (std::size_t i = 1; i < words.size(); ++i) {
    require(number_of<double>(words[i]).has_value(), "{}: '{}', expected a number", where, shown(words[i]));
  }
}

void check_obj_elements(const Words& words, std::size_t least, ObjCounts& counts, const std::string& where) {
  require(words.size() > least, "{}: {} corners, expected {} or more", where, words.size() - 1, least);
  int parts = 0;
  std::vector<std::int64_t> corners(words.size() - 1);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const int found = check_obj_corner(words[i + 1], counts, corners[i], where);
    require(i == 0 || found == parts, "{}: corners of different kinds", where);
    parts = found;
  }
  for (std::size_t i = 0; least == 3 && i < corners.size(); ++i) {
    counts.last_used = std::max(counts.last_used, corners[i]);
    counts.edges.push_back(std::minmax(corners[i], corners[(i + 1) % corners.size()]));
  }
}

/// Every edge has a face on both of its sides.
bool is_closed(ObjCounts& counts) {
  std::sort(counts.edges.begin(), counts.edges.end());
  for (auto edge = counts.edges.begin(); edge != counts.edges.end();) {
    const auto other = std::upper_bound(edge, counts.edges.end(), *edge);
    if (other - edge < 2) return false;
    edge = other;
  }
  return true;
}

bool is_passed_over(std::string_view word) {
  static constexpr std::array<std::string_view, 12> kWords = {
      "o", "g", "s", "mg", "usemtl", "mtllib", "lod", "bevel", "usemap", "maplib", "shadow_obj", "trace_obj"};
  return word.front() == '#' || std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

void check_obj_line(const Words& words, ObjCounts& counts, const std::string& where) {
  if (words[0] == "v") {
    check_obj_numbers(words, 3, 8, where);  // with a weight or a colour
    ++counts.vertices;
  } else if (words[0] == "vt") {
    check_obj_numbers(words, 1, 3, where);
    ++counts.uvs;
  } else if (words[0] == "vn") {
    check_obj_numbers(words, 3, 3, where);
    ++counts.normals;
  } else if (words[0] == "f") {
    check_obj_elements(words, 3, counts, where);
  } else if (words[0] == "l" || words[0] == "p") {
    check_obj_elements(words, 1, counts, where);
  } else {
    require(is_passed_over(words[0]), "{}: no word of an OBJ file of polygons", where);
  }
}

}  // namespace

void check_obj(std::string_view bytes, const std::string& source) {
  require(bytes.find('\0') == std::string_view::npos, "{}: holds a byte 0, expected text", source);
  ObjCounts counts;
  Lines lines(bytes);
  std::string joined;  // of lines that end with a backslash
  while (const std::optional<std::string_view> line = lines.next()) {
    joined += *line;
    if (!joined.empty() && joined.back() == '\\') {
      joined.back() = ' ';
      continue;
    }
    const Words words = split(joined);
    if (!words.empty())
      check_obj_line(words, counts, fmt::format("{}: line {} '{}'", source, lines.number(), shown(joined)));
    joined.clear();
  }
  require(counts.last_used == counts.vertices,
          "{}: vertices {} to {} belong to no face, expected faces up to the last one: is the file cut?", source,
          counts.last_used + 1, counts.vertices);
  require(lines.is_ended() || is_closed(counts),
          "{}: its last line has no end, and its surface has holes: is the file cut? If it is whole, end that line",
          source);
}

}  // namespace houghstream
