#include "pipeline/bus/log_seal.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/bus/event_log.hpp"

namespace houghstream {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {'H', 'S', 'S', 'E', 'A', 'L', '1', 0};

template <typename Number>
void append(Number number, std::vector<std::uint8_t>& bytes) {
  for (std::size_t shift = 8 * sizeof number; shift > 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> (shift - 8)));
}

constexpr std::size_t kBlockBytes = std::size_t{64} << 20U;

void write_block(const std::vector<LogEvent>& block, LogWriter& out) {
  std::vector<std::uint32_t> checksums;
  checksums.reserve(block.size());
  for (const LogEvent& event : block) checksums.push_back(checksum_of(event));
  const std::vector<std::uint8_t> seal = encode_seal(checksums);
  out.write(block.front().timestamp, kSealChannel, {seal.data(), seal.size()});
  for (const LogEvent& event : block) out.write(event.timestamp, event.channel, {event.data.data(), event.data.size()});
}

}  // namespace

std::uint32_t checksum_of(const LogEvent& event) {
  std::vector<std::uint8_t> head;
  append(event.timestamp, head);
  head.insert(head.end(), event.channel.begin(), event.channel.end());
  return libdeflate_crc32(libdeflate_crc32(0, head.data(), head.size()), event.data.data(), event.data.size());
}

std::vector<std::uint8_t> encode_seal(const std::vector<std::uint32_t>& checksums) {
  std::vector<std::uint8_t> bytes(kMagic.begin(), kMagic.end());
  append(static_cast<std::uint32_t>(checksums.size()), bytes);
  for (const std::uint32_t checksum : checksums) append(checksum, bytes);
  return bytes;
}

std::vector<std::uint32_t> decode_seal(ByteView bytes, const std::string& source) {
  WireReader reader(bytes, source);
  const ByteView magic = reader.read_bytes(kMagic.size());
  require(std::equal(kMagic.begin(), kMagic.end(), magic.data), "{}: a damaged seal", source);
  std::vector<std::uint32_t> checksums(reader.read_count(4));
  require(checksums.size() <= kSealedBlock && reader.left() == 4 * checksums.size(), "{}: a damaged seal", source);
  for (std::uint32_t& checksum : checksums) checksum = static_cast<std::uint32_t>(reader.read_int32());
  return checksums;
}

std::int64_t seal_log(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                      const std::function<void(double share)>& tell) {
  require_other_file(out_file, log_file);
  LogReader log(log_file);
  LogWriter out(out_file);
  std::vector<LogEvent> block;
  std::size_t bytes = 0;
  std::int64_t events = 0;
  while (std::optional<LogEvent> event = log.next()) {
    bytes += event->data.size();
    block.push_back(std::move(*event));
    ++events;
    if (tell) tell(static_cast<double>(log.position()) / static_cast<double>(log.size()));
    if (block.size() < kSealedBlock && bytes < kBlockBytes) continue;
    write_block(block, out);
    block.clear();
    bytes = 0;
  }
  if (!block.empty()) write_block(block, out);
  out.close();
  return events;
}

}  // namespace houghstream
