#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/files/mat_file.hpp"

// The elements that a MATLAB file of version 5 is made of. Everything throws InputError where the bytes do not reach.

namespace houghstream {

/// How an element's bytes are stored.
enum class MatType : std::uint32_t {
  kInt8 = 1,
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kInt32 = 5,
  kUint32 = 6,
  kSingle = 7,
  kDouble = 9,
  kInt64 = 12,
  kUint64 = 13,
  kMatrix = 14,
  kCompressed = 15,
  kUtf8 = 16,
  kUtf16 = 17,
  kUtf32 = 18
};

struct MatElement;

/// Bytes of a file that are taken from the front.
class MatBytes {
 public:
  /// `swapped` where the file has the other byte order; `file` is named in errors.
  MatBytes(const unsigned char* data, std::size_t size, bool swapped, const std::string& file)
      : data_(data), size_(size), swapped_(swapped), file_(&file) {}

  const unsigned char* data() const { return data_; }
  std::size_t size() const { return size_; }
  const std::string& file() const { return *file_; }

  MatBytes take(std::size_t size);
  std::uint32_t take_u32();
  /// The next element; `padded` to a multiple of 8 bytes, as within arrays.
  MatElement take_element(bool padded);
  /// All as numbers of a type.
  std::vector<double> numbers(MatType type) const;

 private:
  const unsigned char* data_;
  std::size_t size_;
  bool swapped_;
  const std::string* file_;
};

struct MatElement {
  MatType type;
  MatBytes bytes;
};

/// The array in the bytes of an element of type kMatrix.
MatArray parse_mat_array(MatBytes bytes, int depth = 0);

}  // namespace houghstream
