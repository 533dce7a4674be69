#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/messages/wire_check.hpp"

namespace houghstream {

/// Returns the message as its receiver has it.
template <typename Message>
Message over_the_wire(const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  return decode_message<Message>({bytes.data(), bytes.size()});
}

}  // namespace houghstream
