#include "drivers/files/mat_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

namespace houghstream {
namespace {

constexpr int kDeepest = 16;
constexpr std::size_t kMaxElements = 1U << 24U;

template <typename T>
T value_at(const unsigned char* data, bool swapped) {
  std::array<unsigned char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), data, sizeof(T));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  T value{};
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

template <typename T>
std::vector<double> values_of(const unsigned char* data, std::size_t size, bool swapped) {
  std::vector<double> values(size / sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<double>(value_at<T>(data + i * sizeof(T), swapped));
  return values;
}

MatArray::Kind kind_of(std::uint32_t array_class) {
  if (array_class == 1) return MatArray::Kind::kCells;
  if (array_class == 2) return MatArray::Kind::kStructs;
  if (array_class == 4) return MatArray::Kind::kText;
  return array_class >= 6 && array_class <= 15 ? MatArray::Kind::kNumbers : MatArray::Kind::kOther;
}

std::size_t parse_count(const MatElement& dimensions) {
  const std::vector<double> sizes = dimensions.bytes.numbers(MatType::kInt32);
  const std::string& file = dimensions.bytes.file();
  require(dimensions.type == MatType::kInt32 && sizes.size() >= 2,
          "{}: damaged: {} dimensions of type {}, expected at least 2 of type 5", file, sizes.size(),
          static_cast<std::uint32_t>(dimensions.type));
  std::size_t count = 1;
  for (const double size : sizes) {
    require(size >= 0 && size <= static_cast<double>(kMaxElements), "{}: damaged: an array is {} elements wide", file,
            size);
    count *= static_cast<std::size_t>(size);
    require(count <= kMaxElements, "{}: damaged: an array of {} elements, expected at most {}", file, count,
            kMaxElements);
  }
  return count;
}

std::string text_of(const unsigned char* data, std::size_t size) {
  return {data, std::find(data, data + size, '\0')};
}

std::vector<std::string> parse_fields(MatBytes& bytes) {
  const MatElement width = bytes.take_element(true);
  const std::vector<double> length = width.bytes.numbers(MatType::kInt32);
  require(width.type == MatType::kInt32 && length.size() == 1 && length[0] >= 1 && length[0] <= 1024,
          "{}: damaged: length of field names, expected 1 to 1024", bytes.file());
  const auto step = static_cast<std::size_t>(length[0]);
  const MatElement names = bytes.take_element(true);
  require(names.bytes.size() % step == 0, "{}: damaged: field names of {} bytes, expected a multiple of {}",
          bytes.file(), names.bytes.size(), step);
  constexpr std::size_t kMaxFields = 1024;
  require(names.bytes.size() / step <= kMaxFields, "{}: damaged: {} field names, expected at most {}", bytes.file(),
          names.bytes.size() / step, kMaxFields);
  std::vector<std::string> fields;
  for (std::size_t at = 0; at < names.bytes.size(); at += step)
    fields.push_back(text_of(names.bytes.data() + at, step));
  return fields;
}

// Cells, or the fields of structs.
void parse_children(MatBytes& bytes, std::size_t count, int depth, MatArray& array) {
  for (std::size_t i = 0; i < count; ++i) {
    const MatElement child = bytes.take_element(true);
    require(child.type == MatType::kMatrix, "{}: damaged: element of type {} in an array, expected 14", bytes.file(),
            static_cast<std::uint32_t>(child.type));
    array.children.push_back(parse_mat_array(child.bytes, depth + 1));
  }
}

}  // namespace

MatBytes MatBytes::take(std::size_t size) {
  require(size <= size_, "{}: cut off or damaged: {} bytes left, expected {}", *file_, size_, size);
  const MatBytes taken(data_, size, swapped_, *file_);
  data_ += size;
  size_ -= size;
  return taken;
}

std::uint32_t MatBytes::take_u32() {
  return value_at<std::uint32_t>(take(4).data(), swapped_);
}

MatElement MatBytes::take_element(bool padded) {
  const std::uint32_t tag = take_u32();
  if (tag >> 16U != 0) {  // up to four bytes, packed into the tag
    const std::uint32_t size = tag >> 16U;
    require(size <= 4, "{}: damaged: short element of {} bytes, expected at most 4", *file_, size);
    return {static_cast<MatType>(tag & 0xffffU), take(4).take(size)};
  }
  const std::uint32_t size = take_u32();
  const MatElement element{static_cast<MatType>(tag), take(size)};
  if (padded) take(std::min<std::size_t>((8U - size % 8U) % 8U, size_));
  return element;
}

std::vector<double> MatBytes::numbers(MatType type) const {
  switch (type) {
    case MatType::kInt8: return values_of<std::int8_t>(data_, size_, swapped_);
    case MatType::kUint8:
    case MatType::kUtf8: return values_of<std::uint8_t>(data_, size_, swapped_);
    case MatType::kInt16: return values_of<std::int16_t>(data_, size_, swapped_);
    case MatType::kUint16:
    case MatType::kUtf16: return values_of<std::uint16_t>(data_, size_, swapped_);
    case MatType::kInt32: return values_of<std::int32_t>(data_, size_, swapped_);
    case MatType::kUint32:
    case MatType::kUtf32: return values_of<std::uint32_t>(data_, size_, swapped_);
    case MatType::kSingle: return values_of<float>(data_, size_, swapped_);
    case MatType::kDouble: return values_of<double>(data_, size_, swapped_);
    case MatType::kInt64: return values_of<std::int64_t>(data_, size_, swapped_);
    case MatType::kUint64: return values_of<std::uint64_t>(data_, size_, swapped_);
    default: fail("{}: damaged: numbers of type {}", *file_, static_cast<std::uint32_t>(type));
  }
}

MatArray parse_mat_array(MatBytes bytes, int depth) {
  MatArray array;
  if (bytes.size() == 0) return array;  // how an empty array may be written
  require(depth < kDeepest, "{}: arrays {} deep, expected less than {}", bytes.file(), depth, kDeepest);
  MatBytes flags = bytes.take_element(true).bytes;
  array.kind = kind_of(flags.take_u32() & 0xffU);
  if (array.kind == MatArray::Kind::kOther) return array;
  array.count = parse_count(bytes.take_element(true));
  const MatElement name = bytes.take_element(true);
  array.name = text_of(name.bytes.data(), name.bytes.size());
  if (array.kind == MatArray::Kind::kStructs) array.fields = parse_fields(bytes);
  if (array.kind == MatArray::Kind::kCells || array.kind == MatArray::Kind::kStructs) {
    const std::size_t per_element = array.kind == MatArray::Kind::kCells ? 1 : array.fields.size();
    parse_children(bytes, array.count * per_element, depth, array);
    return array;
  }
  const MatElement data = bytes.take_element(true);
  array.values = data.bytes.numbers(data.type);
  require(array.values.size() == array.count, "{}: damaged: {} values for {} elements", bytes.file(),
          array.values.size(), array.count);
  return array;
}

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaderBytes = 128;

std::vector<unsigned char> read_bytes(const fs::path& path) {
  require_regular_file(path, "a MATLAB file");
  constexpr std::uintmax_t kMaxBytes = 16U << 20U;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  require(!error && size <= kMaxBytes, "{}: {} bytes, expected at most {}", path.string(), size, kMaxBytes);
  std::ifstream in(path, std::ios::binary);
  require(in.good() && fs::is_regular_file(path), "{}: missing or unreadable, expected a MATLAB file", path.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<unsigned char> inflate_all(const MatBytes& packed, const std::string& where) {
  constexpr std::size_t kMaxBytes = 16U << 20U;  // each 8 of them may be an array of a hundred
  z_stream stream{};
  require(inflateInit(&stream) == Z_OK, "{}: no memory to decompress", where);
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  stream.next_in = const_cast<unsigned char*>(packed.data());  // zlib only reads it
  stream.avail_in = static_cast<unsigned>(packed.size());
  std::vector<unsigned char> out;
  std::array<unsigned char, 65536> piece{};
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = piece.data();
    stream.avail_out = piece.size();
    state = inflate(&stream, Z_NO_FLUSH);
    out.insert(out.end(), piece.data(), stream.next_out);
    require(out.size() <= kMaxBytes, "{}: more than {} bytes decompressed", where, kMaxBytes);
  }
  require(state == Z_STREAM_END, "{}: compressed data are damaged (zlib says {})", where, state);
  return out;
}

bool check_header(const std::vector<unsigned char>& bytes, const std::string& file) {
  const bool long_enough = bytes.size() >= kHeaderBytes;
  const std::string order = long_enough ? std::string(bytes.begin() + 126, bytes.begin() + 128) : "";
  require(order == "IM" || order == "MI", "{}: no MATLAB file, expected the header of version 5", file);
  const bool swapped = order == "MI";  // written by a machine of the other byte order
  const int version = swapped ? bytes[124] : bytes[125];
  require(version == 1, "{}: MATLAB file version {}, expected 1 (-v5, -v6 or -v7, not -v7.3)", file, version);
  return swapped;
}

const MatArray& struct_field(const MatArray& structs, std::size_t index, const std::string& field,
                             const std::string& where) {
  require(structs.kind == MatArray::Kind::kStructs, "{}: {}, expected structs", where, mat_kind_name(structs.kind));
  const auto found = std::find(structs.fields.begin(), structs.fields.end(), field);
  require(found != structs.fields.end(), "{}: no field '{}'", where, field);
  const auto column = static_cast<std::size_t>(found - structs.fields.begin());
  return structs.children.at(index * structs.fields.size() + column);
}

}  // namespace

const char* mat_kind_name(MatArray::Kind kind) {
  constexpr std::array<const char*, 5> kNames = {"numbers", "text", "cells", "structs", "something else"};
  return kNames[static_cast<std::size_t>(kind)];
}

MatArray read_mat_variable(const fs::path& path, const std::string& name) {
  const std::string file = path.string();
  const std::vector<unsigned char> bytes = read_bytes(path);
  const bool swapped = check_header(bytes, file);
  MatBytes rest(bytes.data() + kHeaderBytes, bytes.size() - kHeaderBytes, swapped, file);
  while (rest.size() > 0) {
    MatElement element = rest.take_element(false);
    std::vector<unsigned char> unpacked;
    if (element.type == MatType::kCompressed) {
      unpacked = inflate_all(element.bytes, file);
      element = MatBytes(unpacked.data(), unpacked.size(), swapped, file).take_element(true);
    }
    if (element.type != MatType::kMatrix) continue;
    MatArray array = parse_mat_array(element.bytes);
    if (array.name == name) return array;
  }
  fail("{}: no variable '{}'", file, name);
}

double mat_number(const MatArray& structs, std::size_t index, const std::string& field, const std::string& where) {
  const MatArray& array = struct_field(structs, index, field, where);
  require(array.kind == MatArray::Kind::kNumbers, "{} field '{}': {}, expected a number", where, field,
          mat_kind_name(array.kind));
  require(array.count == 1, "{} field '{}': {} numbers, expected one", where, field, array.count);
  require(std::isfinite(array.values[0]), "{} field '{}': {}, expected a finite number", where, field, array.values[0]);
  return array.values[0];
}

std::string mat_text(const MatArray& structs, std::size_t index, const std::string& field, const std::string& where) {
  const MatArray& array = struct_field(structs, index, field, where);
  require(array.kind == MatArray::Kind::kText && array.count > 0, "{} field '{}': {} of length {}, expected text",
          where, field, mat_kind_name(array.kind), array.count);
  std::string text;
  for (const double code : array.values) {
    require(code >= 0x20 && code < 0x7f, "{} field '{}': character {}, expected printable ASCII", where, field, code);
    text += static_cast<char>(code);
  }
  return text;
}

}  // namespace houghstream
