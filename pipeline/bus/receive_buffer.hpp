#pragma once

#include <cstdint>
#include <string>

namespace houghstream {

/// Receive buffer that is requested from the kernel, bytes. The kernel grants at most net.core.rmem_max.
constexpr std::int64_t kAskedReceiveBuffer = std::int64_t{16} << 20U;

/// Receive buffer that a stream of RGB-D frames needs, bytes: two raw VGA frames of 1.54 MB and some reserve. With
/// less, the kernel drops datagrams and LCM silently loses most large messages.
constexpr std::int64_t kNeededReceiveBuffer = std::int64_t{4} << 20U;

/// Adds recv_buf_size to a udpm URL that does not state it; other URLs come back as they are.
std::string with_receive_buffer(const std::string& url, std::int64_t bytes);

/// Returns the buffer that the kernel grants when `asked` bytes are requested, bytes; the socket is closed again.
std::int64_t granted_receive_buffer(std::int64_t asked);

/// Returns the receive buffer that a stream of frames of this size needs, bytes: with raw VGA frames
/// kNeededReceiveBuffer.
std::int64_t needed_receive_buffer(std::int64_t frame_bytes);

/// Gives an open socket a receive buffer beyond the kernel's limit (SO_RCVBUFFORCE), which root may. Returns false
/// where the kernel refuses; the socket then keeps its buffer.
bool force_receive_buffer(int socket, std::int64_t bytes);

/// Returns how many datagrams the kernel has dropped on this socket since it was opened, because its receive buffer was
/// full or a filter refused them. Throws InputError where the kernel does not say (before Linux 4.12).
std::int64_t count_dropped_datagrams(int socket);

/// Returns whether a datagram waits in the socket's receive buffer, so that whoever reads it has not taken it yet.
bool has_waiting_datagram(int socket);

/// The command that makes the kernel grant what is asked for, until the next start of the machine.
std::string receive_buffer_remedy();

/// Returns one line that names the shortage and its remedy, or "" where `granted` is enough.
std::string receive_buffer_advice(std::int64_t granted);

}  // namespace houghstream
