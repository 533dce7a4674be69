#include <array>
#include <set>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/mesh_text.hpp"
#include "pipeline/geometry/mesh_check.hpp"

namespace houghstream {
namespace {

using namespace mesh_text;

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
  // Entries of no bytes: a file of a few lines may state thousands of millions, for which the library makes room.
  require(element.count == 0 || !element.properties.empty(), "{}: {} entries '{}' without properties", source,
          element.count, shown(element.name));
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

}  // namespace

void check_ply(std::string_view bytes, const std::string& source) {
  Lines lines(bytes);
  const PlyHeader header = read_ply_header(lines, source);
  header.format == PlyFormat::kText ? check_ply_text(header, lines, source)
                                    : check_ply_binary(header, lines.rest(), source);
}

}  // namespace houghstream
