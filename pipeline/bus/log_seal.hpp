#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/messages/wire_reader.hpp"

namespace houghstream {

struct LogEvent;

/// A sealed log holds, before every block of events, one more on this channel: eight bytes "HSSEAL1\0", u32 number of
/// events, and for each of them the CRC-32 of its timestamp (i64), channel and data; numbers big-endian. It tells of
/// flipped bits, and of events that are missing; it is no signature, anybody can make one. Stock players play it as a
/// message that nobody listens to.
inline const std::string kSealChannel = "HOUGHSTREAM_SEAL";
constexpr std::size_t kSealedBlock = 256;  ///< events, at most

/// Copies a whole log and seals it: from then on every reader of ours refuses an event of which a bit has changed, and
/// a log of which events are missing. Returns the number of events. Throws InputError where the log is damaged: what
/// cannot be trusted is not sealed.
/// `tell`, if any, hears after each event which share of the log is sealed.
std::int64_t seal_log(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                      const std::function<void(double share)>& tell = {});

std::uint32_t checksum_of(const LogEvent& event);

std::vector<std::uint8_t> encode_seal(const std::vector<std::uint32_t>& checksums);

/// Checksums of the events that follow, in their order. Throws InputError, naming `source`, where it is no whole seal.
std::vector<std::uint32_t> decode_seal(ByteView bytes, const std::string& source);

}  // namespace houghstream
