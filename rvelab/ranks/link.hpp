// The way of messages from rank to rank.
#pragma once

#include "rvelab/pool/message.hpp"

namespace rvelab::ranks {

using pool::Bytes;

/// Of the first rank, to all others. Each message to a rank is answered before the next is sent to it.
class Link {
 public:
  virtual ~Link() = default;
  virtual int ranks() const = 0;
  virtual void send(int rank, std::span<const std::byte> message) = 0;
  /// The next message from that rank, in the room that `message` has if that is enough. What cannot be kept for want
  /// of memory is taken all the same and let go of (std::bad_alloc).
  virtual void receive(int rank, Bytes& message) = 0;
  /// Throws Refused (bad_input) if this thread may not send.
  virtual void expect_thread() const = 0;
};

}  // namespace rvelab::ranks
