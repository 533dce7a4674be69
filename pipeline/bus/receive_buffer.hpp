#pragma once

#include <cstdint>
#include <string>

namespace houghstream {

/// What is asked of the kernel for incoming datagrams, bytes. The kernel gives at most net.core.rmem_max.
constexpr std::int64_t kAskedReceiveBuffer = std::int64_t{16} << 20U;

/// What a stream of RGB-D frames needs, bytes: two raw VGA frames of 1.54 MB and something over. With less, the
/// kernel drops datagrams and LCM loses most large messages without a word.
constexpr std::int64_t kNeededReceiveBuffer = std::int64_t{4} << 20U;

/// Adds recv_buf_size to a udpm URL that does not state it; other URLs come back as they are.
std::string with_receive_buffer(const std::string& url, std::int64_t bytes);

/// What the kernel grants when `asked` bytes are asked for, in the same measure; nothing is left open.
std::int64_t granted_receive_buffer(std::int64_t asked);

/// What a stream of frames of this size needs, bytes: with raw VGA frames kNeededReceiveBuffer.
std::int64_t needed_receive_buffer(std::int64_t frame_bytes);

/// The command that makes the kernel grant what is asked for, until the next start of the machine.
std::string receive_buffer_remedy();

/// One line that says what is missing and mends it, or "" where `granted` is enough.
std::string receive_buffer_advice(std::int64_t granted);

}  // namespace houghstream
