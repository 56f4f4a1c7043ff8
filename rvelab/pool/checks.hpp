// What every kind of pool refuses.
#pragma once

#include "rvelab/pool/id_table.hpp"
#include "rvelab/pool/pool.hpp"

namespace rvelab::pool {

/// Throws Refused (bad_input) unless dt is 0 or a positive time.
void expect_time(double dt);
/// Throws Refused (bad_input, no_slot) unless n RVEs can be asked for.
void expect_spawn(std::int64_t n);
/// Throws Refused (bad_file) unless ids, generations and tag belong together, for that many states.
void expect_whole(const Population& population, std::size_t states);
/// Throws Refused (bad_input) if the pool that is to take a file has RVEs.
void expect_empty(const IdTable& ids);

}  // namespace rvelab::pool
