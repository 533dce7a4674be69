#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pipeline/base/checks.hpp"

// Archives hold values in their memory layout, one after another, for files that are read again by the machine that
// wrote them. The owner of a struct lists its members once, in a template that serves writer and reader alike.

namespace houghstream {

/// Writes values, which must have no gaps, since nobody has set the bytes of these.
struct ArchiveWriter {
  std::string bytes;

  void put(const void* from, std::size_t size) { bytes.append(static_cast<const char*>(from), size); }
  template <typename T>
  void operator()(const T& value) {
    static_assert(std::is_standard_layout_v<T>);
    put(&value, sizeof value);
  }
  void operator()(const std::string& text) {
    (*this)(std::uint64_t{text.size()});
    bytes.append(text);
  }
  template <typename T>
  void operator()(const std::vector<T>& values) {
    (*this)(std::uint64_t{values.size()});
    put(values.data(), values.size() * sizeof(T));
  }
};

/// The rest of a stream, with the functions of a std::string_view that ArchiveReader calls: for an archive whose copy
/// in memory would double what it takes to read it.
struct StreamBytes {
  std::istream& in;
  std::size_t left = 0;

  std::size_t size() const { return left; }
  bool empty() const { return left == 0; }
  std::size_t copy(char* to, std::size_t count) {
    in.read(to, static_cast<std::streamsize>(count));
    return static_cast<std::size_t>(in.gcount());
  }
  void remove_prefix(std::size_t count) { left -= count; }
};

/// Reads values. Throws InputError, naming `source`, where the bytes end early, before it allocates memory for more
/// than they can hold.
template <typename Bytes = std::string_view>
struct ArchiveReader {
  Bytes bytes;  ///< bytes still to read
  std::string source;

  void take(void* to, std::size_t size) {
    require(size <= bytes.size(), "{} ends {} bytes early", source, size - bytes.size());
    if (size == 0) return;  // into an empty list, which has no place
    require(bytes.copy(static_cast<char*>(to), size) == size, "{} cannot be read to its end", source);
    bytes.remove_prefix(size);
  }
  /// Reads the length of a list whose items take at least so many bytes each.
  std::size_t count(std::size_t item_bytes) {
    std::uint64_t items = 0;
    take(&items, sizeof items);
    require(items <= bytes.size() / item_bytes, "{}: a list of {} items, expected at most what is left", source, items);
    return static_cast<std::size_t>(items);
  }
  template <typename T>
  void operator()(T& value) {
    take(static_cast<void*>(&value), sizeof value);
  }
  void operator()(std::string& text) {
    text.resize(count(1));
    take(text.data(), text.size());
  }
  template <typename T>
  void operator()(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    take(static_cast<void*>(values.data()), values.size() * sizeof(T));
  }
};

}  // namespace houghstream
