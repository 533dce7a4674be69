#include "drivers/ros_bag/chunk_data.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include <algorithm>
#include <memory>

namespace houghstream::ros_bag {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18U;

/// Makes room for another block behind the `used` bytes. One byte more than stated shows that there are too many.
void grow(std::vector<std::uint8_t>& out, std::size_t used, std::size_t size) {
  out.resize(std::min(std::max(2 * used, used + kBlock), size + 1));
}

std::vector<std::uint8_t> decompress_bz2(ByteRange bytes, std::size_t size, const std::string& source) {
  bz_stream stream{};
  require(BZ2_bzDecompressInit(&stream, 0, 0) == BZ_OK, "{}: no memory to decompress it", source);
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> end(&stream, BZ2_bzDecompressEnd);
  // bzip2's interface takes the input as mutable, and does not change it.
  stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(bytes.data));
  stream.avail_in = static_cast<unsigned>(bytes.size);
  std::vector<std::uint8_t> out;
  std::size_t used = 0;
  for (int status = BZ_OK; status != BZ_STREAM_END;) {
    require(used <= size, "{}: more than the {} bytes that it states, expected as many", source, size);
    grow(out, used, size);
    stream.next_out = reinterpret_cast<char*>(out.data() + used);
    stream.avail_out = static_cast<unsigned>(out.size() - used);
    status = BZ2_bzDecompress(&stream);
    const bool is_stuck = status == BZ_OK && stream.avail_in == 0 && stream.avail_out > 0;
    require((status == BZ_OK && !is_stuck) || status == BZ_STREAM_END, "{}: not bzip2 data, expected a whole stream",
            source);
    used = out.size() - stream.avail_out;
  }
  require(stream.avail_in == 0, "{}: {} bytes behind its bzip2 data, expected none", source, stream.avail_in);
  out.resize(used);
  return out;
}

std::vector<std::uint8_t> decompress_lz4(ByteRange bytes, std::size_t size, const std::string& source) {
  LZ4F_dctx* context = nullptr;
  require(LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) == 0, "{}: no memory to decompress it",
          source);
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> end(context, LZ4F_freeDecompressionContext);
  std::vector<std::uint8_t> out;
  std::size_t used = 0;
  std::size_t taken = 0;
  for (std::size_t expected = 1; expected != 0;) {
    require(used <= size, "{}: more than the {} bytes that it states, expected as many", source, size);
    grow(out, used, size);
    std::size_t written = out.size() - used;
    std::size_t read = bytes.size - taken;
    expected = LZ4F_decompress(context, out.data() + used, &written, bytes.data + taken, &read, nullptr);
    const bool is_stuck = expected != 0 && written == 0 && read == 0;
    require(LZ4F_isError(expected) == 0 && !is_stuck, "{}: not LZ4 data, expected a whole frame", source);
    used += written;
    taken += read;
  }
  require(taken == bytes.size, "{}: {} bytes behind its LZ4 data, expected none", source, bytes.size - taken);
  out.resize(used);
  return out;
}

std::vector<std::uint8_t> decompress(ByteRange bytes, const std::string& compression, std::size_t size,
                                     const std::string& source) {
  if (compression == "none") return {bytes.data, bytes.data + bytes.size};
  if (compression == "bz2") return decompress_bz2(bytes, size, source);
  if (compression == "lz4") return decompress_lz4(bytes, size, source);
  fail("{}: compression '{}', expected none, bz2 or lz4", source, compression);
}

}  // namespace

std::vector<std::uint8_t> decompress_chunk(ByteRange bytes, const std::string& compression, std::size_t size,
                                           const std::string& source) {
  std::vector<std::uint8_t> records = decompress(bytes, compression, size, source);
  require(records.size() == size, "{}: {} bytes, expected the {} that it states", source, records.size(), size);
  return records;
}

}  // namespace houghstream::ros_bag
