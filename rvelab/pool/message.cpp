#include "rvelab/pool/message.hpp"

namespace rvelab::pool {

void Packer::add(const void* from, std::size_t size) {
  if (size == 0) return;
  const auto* const first = static_cast<const std::byte*>(from);
  bytes_.insert(bytes_.end(), first, first + size);
}

}  // namespace rvelab::pool
