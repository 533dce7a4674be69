#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

// MATLAB files of version 5 (what MATLAB 5 to 7.2 save, and later ones unless asked for 7.3), after "MAT-File Format",
// The MathWorks. Read here and not by a library, since those at hand crash on damaged files.

namespace houghstream {

/// An array of a MATLAB file.
struct MatArray {
  enum class Kind { kNumbers, kText, kCells, kStructs, kOther };
  Kind kind = Kind::kOther;
  std::string name;
  std::size_t count = 0;            ///< elements
  std::vector<double> values;       ///< of numbers, and the character codes of text
  std::vector<std::string> fields;  ///< of structs
  std::vector<MatArray> children;   ///< cells; or the structs' fields, struct by struct
};

/// A variable of a file with all that it holds. Throws InputError where the file is missing, no MATLAB file of this
/// version or damaged, or lacks the variable.
MatArray read_mat_variable(const std::filesystem::path& file, const std::string& name);

/// The field of element `index` of a struct array as one finite number. Throws InputError.
double mat_number(const MatArray& structs, std::size_t index, const std::string& field, const std::string& where);

/// The same as text of printable ASCII characters.
std::string mat_text(const MatArray& structs, std::size_t index, const std::string& field, const std::string& where);

/// "numbers", "text", "cells", "structs" or "something else".
const char* mat_kind_name(MatArray::Kind kind);

}  // namespace houghstream

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
