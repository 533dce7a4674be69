#include "tools/log/seal_log.hpp"

#include <vector>

#include "pipeline/base/files.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/bus/log_seal.hpp"

namespace houghstream::log_tools {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{64} << 20U;

void write_block(const std::vector<LogEvent>& block, LogWriter& out) {
  std::vector<std::uint32_t> checksums;
  for (const LogEvent& event : block) checksums.push_back(checksum_of(event));
  const std::vector<std::uint8_t> seal = encode_seal(checksums);
  out.write(block.front().timestamp, kSealChannel, {seal.data(), seal.size()});
  for (const LogEvent& event : block) out.write(event.timestamp, event.channel, {event.data.data(), event.data.size()});
}

}  // namespace

std::int64_t seal_log(const std::filesystem::path& log_file, const std::filesystem::path& out_file) {
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
    if (block.size() < kSealedBlock && bytes < kBlockBytes) continue;
    write_block(block, out);
    block.clear();
    bytes = 0;
  }
  if (!block.empty()) write_block(block, out);
  out.close();
  return events;
}

}  // namespace houghstream::log_tools
