#include "pipeline/geometry/mesh_structure.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream {
namespace {

using Words = std::vector<std::string_view>;

std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  return printable(text.substr(0, kMost));
}

/// Lines without their ends; takes one off the front.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  std::optional<std::string_view> next() {
    if (text_.empty()) return std::nullopt;
    const std::size_t end = text_.find('\n');
    std::string_view line = text_.substr(0, end);
    is_ended_ = end != std::string_view::npos;
    text_.remove_prefix(is_ended_ ? end + 1 : text_.size());
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return line;
  }

  std::int64_t number() const { return number_; }  ///< of the last line, from 1
  bool is_ended() const { return is_ended_; }      ///< the last line had an end
  std::string_view rest() const { return text_; }

 private:
  std::string_view text_;
  std::int64_t number_ = 0;
  bool is_ended_ = true;
};

Words split(std::string_view line) {
  Words words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

template <typename Number>
std::optional<Number> number_of(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  Number value{};
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // A number too small for a double is a zero that was written down exactly.
  const bool is_number = error == std::errc() || error == std::errc::result_out_of_range;
  return is_number && stop == word.data() + word.size() && !word.empty() ? std::optional<Number>(value) : std::nullopt;
}

// ---- PLY

enum class PlyFormat { kText, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  std::size_t bytes = 0;
  bool is_whole = false;        // an integer
  bool is_signed = false;       // and may be negative
  std::size_t count_bytes = 0;  // of a list's count; 0 = no list
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kText;
  std::vector<PlyElement> elements;
  std::int64_t vertices = 0;
};

/// Bytes of a type and what it is, as a property without a name.
std::optional<PlyProperty> ply_type(std::string_view word) {
  struct Type {
    std::string_view name, other;
    std::size_t bytes;
    bool is_whole, is_signed;
  };
  static constexpr std::array<Type, 8> kTypes = {{{"char", "int8", 1, true, true},
                                                  {"uchar", "uint8", 1, true, false},
                                                  {"short", "int16", 2, true, true},
                                                  {"ushort", "uint16", 2, true, false},
                                                  {"int", "int32", 4, true, true},
                                                  {"uint", "uint32", 4, true, false},
                                                  {"float", "float32", 4, false, true},
                                                  {"double", "float64", 8, false, true}}};
  for (const Type& type : kTypes) {
    if (word == type.name || word == type.other) return PlyProperty{"", type.bytes, type.is_whole, type.is_signed, 0};
  }
  return std::nullopt;
}

PlyProperty ply_property(const Words& words, const std::string& where) {
  const bool is_list = words.size() == 5 && words[1] == "list";
  std::optional<PlyProperty> property;
  if (words.size() == 3 || is_list) property = ply_type(words[words.size() - 2]);
  const std::optional<PlyProperty> count = is_list ? ply_type(words[2]) : std::nullopt;
  require(property && (!is_list || (count && count->is_whole)),
          "{}: no property of a type that PLY knows; is the header damaged?", where);
  property->name = words.back();
  if (is_list) property->count_bytes = count->bytes;
  return *property;
}

void check_ply_names(const PlyElement& element, const std::string& source) {
  require(element.name != "tristrips", "{}: holds strips of triangles, expected faces", source);
  std::set<std::string> names;
  for (const PlyProperty& property : element.properties) {
    require(names.insert(property.name).second, "{}: element {} has '{}' twice; is the header damaged?", source,
            element.name, shown(property.name));
  }
  if (element.name != "vertex") return;
  for (const char* axis : {"x", "y", "z"}) require(names.count(axis) > 0, "{}: vertices without {}", source, axis);
  const std::array<std::vector<const char*>, 5> kTogether = {
      {{"nx", "ny", "nz"}, {"red", "green", "blue"}, {"texture_u", "texture_v"}, {"s", "t"}, {"u", "v"}}};
  for (const auto& group : kTogether) {
    const auto has = std::count_if(group.begin(), group.end(), [&](const char* name) { return names.count(name) > 0; });
    require(has == 0 || has == static_cast<std::ptrdiff_t>(group.size()),
            "{}: vertices with {} of the {} properties {} to {}; is the header damaged?", source, has, group.size(),
            group.front(), group.back());
  }
}

PlyElement ply_element(const Words& words, const std::string& where) {
  const std::optional<std::int64_t> count = words.size() == 3 ? number_of<std::int64_t>(words[2]) : std::nullopt;
  require(count && *count >= 0 && *count <= std::int64_t{0x7FFFFFFF}, "{}: expected an element's name and its count",
          where);
  return {std::string(words[1]), *count, {}};
}

PlyHeader read_ply_header(Lines& lines, const std::string& source) {
  PlyHeader header;
  bool has_format = false;
  require(lines.next().value_or("") == "ply", "{}: no PLY file, expected it to begin with 'ply'", source);
  while (true) {
    const std::optional<std::string_view> line = lines.next();
    require(line.has_value() && lines.is_ended(), "{}: cut in its header, expected a line 'end_header'", source);
    const std::string where = fmt::format("{}: line {} '{}'", source, lines.number(), shown(*line));
    const Words words = split(*line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() == 3 && words[2] == "1.0" && !has_format) {
      has_format = words[1] == "ascii" || words[1] == "binary_little_endian" || words[1] == "binary_big_endian";
      header.format = words[1] == "ascii"               ? PlyFormat::kText
                      : words[1] == "binary_big_endian" ? PlyFormat::kBigEndian
                                                        : PlyFormat::kLittleEndian;
    } else if (words[0] == "element") {
      header.elements.push_back(ply_element(words, where));
      if (words[1] == "vertex") header.vertices = header.elements.back().count;
    } else {
      require(words[0] == "property" && !header.elements.empty(), "{}: no line of a PLY header", where);
      header.elements.back().properties.push_back(ply_property(words, where));
    }
  }
  require(has_format, "{}: no format, expected ascii, binary_little_endian or binary_big_endian 1.0", source);
  for (const PlyElement& element : header.elements) check_ply_names(element, source);
  return header;
}

/// A list of corners, of which each is a vertex.
bool is_corners(const PlyElement& element, const PlyProperty& property) {
  return element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
}

void check_corner(std::optional<std::int64_t> corner, std::int64_t vertices, const std::string& where) {
  require(corner && *corner >= 0 && *corner < vertices, "{}: a face names vertex {}, expected one of {}", where,
          corner.value_or(-1), vertices);
}

void check_count(std::optional<std::int64_t> count, bool corners, const std::string& where) {
  require(count && *count >= (corners ? 3 : 0), "{}: a list of {} entries, expected {} or more", where,
          count.value_or(-1), corners ? 3 : 0);
}

void check_text_item(const PlyElement& element, const Words& words, const PlyHeader& header, const std::string& where) {
  std::size_t at = 0;
  const auto left = [&] { return words.size() - at; };
  for (const PlyProperty& property : element.properties) {
    std::int64_t count = 1;
    const bool corners = property.count_bytes > 0 && is_corners(element, property);
    if (property.count_bytes > 0) {
      const std::optional<std::int64_t> stated =
          left() > 0 ? number_of<std::int64_t>(words[at++]) : std::optional<std::int64_t>();
      check_count(stated, corners, where);
      count = *stated;
    }
    require(count <= static_cast<std::int64_t>(left()), "{}: {} numbers, expected more", where, words.size());
    for (; count > 0; --count, ++at) {
      const bool is_number =
          property.is_whole ? number_of<std::int64_t>(words[at]).has_value() : number_of<double>(words[at]).has_value();
      require(is_number, "{}: '{}', expected a number", where, shown(words[at]));
      if (corners) check_corner(number_of<std::int64_t>(words[at]), header.vertices, where);
    }
  }
  require(left() == 0, "{}: {} numbers, expected {}", where, words.size(), at);
}

void check_ply_text(const PlyHeader& header, Lines& lines, const std::string& source) {
  for (const PlyElement& element : header.elements) {
    for (std::int64_t item = 0; item < element.count; ++item) {
      const std::optional<std::string_view> line = lines.next();
      require(line.has_value() && lines.is_ended(), "{}: cut in entry {} of {} '{}'", source, item, element.count,
              shown(element.name));
      check_text_item(element, split(*line), header, fmt::format("{}: line {}", source, lines.number()));
    }
  }
  while (const std::optional<std::string_view> line = lines.next()) {
    require(split(*line).empty(), "{}: line {} lies behind what its header states", source, lines.number());
  }
}

std::int64_t binary_integer(std::string_view bytes, const PlyProperty& type, PlyFormat format) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const std::size_t at = format == PlyFormat::kBigEndian ? i : bytes.size() - 1 - i;
    value = value << 8U | static_cast<std::uint8_t>(bytes[at]);
  }
  const std::uint64_t sign = std::uint64_t{1} << (8 * bytes.size() - 1);
  if (type.is_signed && (value & sign) != 0)
    return static_cast<std::int64_t>(value) - static_cast<std::int64_t>(2 * sign);
  return static_cast<std::int64_t>(value);
}

/// Takes bytes off the front of a binary body.
struct PlyBody {
  std::string_view bytes;
  const std::string& source;

  std::string_view take(std::uint64_t size, const PlyElement& element, std::int64_t item) {
    require(size <= bytes.size(), "{}: cut in entry {} of {} '{}'", source, item, element.count, shown(element.name));
    const std::string_view taken = bytes.substr(0, size);
    bytes.remove_prefix(size);
    return taken;
  }
};

void check_binary_list(const PlyElement& element, const PlyProperty& property, const PlyHeader& header,
                       std::int64_t item, PlyBody& body) {
  const bool corners = is_corners(element, property);
  const PlyProperty counting{"", property.count_bytes, true, false, 0};
  const std::int64_t count = binary_integer(body.take(property.count_bytes, element, item), counting, header.format);
  const std::string where = fmt::format("{}: entry {} '{}'", body.source, item, shown(element.name));
  check_count(count, corners, where);
  require(!corners || property.is_whole, "{}: corners of faces are fractions, expected integers", body.source);
  std::string_view list = body.take(static_cast<std::uint64_t>(count) * property.bytes, element, item);
  for (; corners && !list.empty(); list.remove_prefix(property.bytes)) {
    check_corner(binary_integer(list.substr(0, property.bytes), property, header.format), header.vertices, where);
  }
}

void check_ply_binary(const PlyHeader& header, std::string_view rest, const std::string& source) {
  PlyBody body{rest, source};
  for (const PlyElement& element : header.elements) {
    const bool has_lists = std::any_of(element.properties.begin(), element.properties.end(),
                                       [](const PlyProperty& property) { return property.count_bytes > 0; });
    std::uint64_t item_bytes = 0;
    for (const PlyProperty& property : element.properties) item_bytes += property.bytes;
    if (!has_lists) {
      body.take(item_bytes * static_cast<std::uint64_t>(element.count), element, element.count);
      continue;
    }
    for (std::int64_t item = 0; item < element.count; ++item) {
      for (const PlyProperty& property : element.properties) {
        if (property.count_bytes == 0) body.take(property.bytes, element, item);
        if (property.count_bytes > 0) check_binary_list(element, property, header, item, body);
      }
    }
  }
  require(body.bytes.empty(), "{}: {} bytes lie behind what its header states", source, body.bytes.size());
}

// ---- OBJ

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

void check_ply(std::string_view bytes, const std::string& source) {
  Lines lines(bytes);
  const PlyHeader header = read_ply_header(lines, source);
  header.format == PlyFormat::kText ? check_ply_text(header, lines, source)
                                    : check_ply_binary(header, lines.rest(), source);
}

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
