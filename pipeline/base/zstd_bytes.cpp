#include "pipeline/base/zstd_bytes.hpp"

#include <zstd.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {

std::string compress_zstd(std::string_view bytes, int level) {
  std::string frame(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(frame.data(), frame.size(), bytes.data(), bytes.size(), level);
  require(ZSTD_isError(size) == 0, "zstd: {}", ZSTD_getErrorName(size));
  frame.resize(size);
  return frame;
}

void decompress_zstd(std::string_view frame, void* to, std::size_t size, std::string_view source) {
  const std::size_t got = ZSTD_decompress(to, size, frame.data(), frame.size());
  require(ZSTD_isError(got) == 0, "{} cannot be decompressed: {}", source, ZSTD_getErrorName(got));
  require(got == size, "{} decompresses to {} bytes, expected {}", source, got, size);
}

}  // namespace houghstream
