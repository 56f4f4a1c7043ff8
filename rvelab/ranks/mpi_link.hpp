// Messages by MPI. The one place that knows of it, with mpi_link.cpp.
#pragma once

#include <cstdint>
#include <memory>

#include "rvelab/ranks/link.hpp"

namespace rvelab::ranks {

/// A link over the communicator of a Fortran handle; collective. Throws Refused (bad_input) if MPI was not initialised,
/// or the handle is none.
struct World {
  std::unique_ptr<Link> link;
  int rank = 0;
  int ranks_here = 1;  ///< that share the memory, and the cores, of this one
};
World join(std::int32_t fortran_communicator);

/// Bytes of the first rank, at all of them; collective. They are as many everywhere.
void broadcast(const Link& link, std::span<std::byte> bytes);
/// Throws Refused unless `status` is ok at all ranks; collective. `text` explains that of this one.
void expect_all(const Link& link, pool::Status status, const std::string& text);

}  // namespace rvelab::ranks
