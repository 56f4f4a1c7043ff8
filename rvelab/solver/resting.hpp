// Buffers that an assembly can make again: released while an RVE rests, rebuilt when it is at work.
#pragma once

#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/assembly.hpp"
#include "rvelab/solver/rve.hpp"

namespace rvelab {

/// The grain rows keep the masses for as long as the working arrays are released.
void put_masses_into_rows(const Fixture& fixture, Assembly& assembly);
/// Frees the working arrays; only rebuild_buffers, close_assembly and memory_of may be called then.
void release_buffers(Assembly& assembly);

/// Makes them again: the bits are those before. Throws std::bad_alloc; the assembly has none of them then.
void rebuild_buffers(const Fixture& fixture, Assembly& assembly);

Memory memory_of(const Assembly& assembly);

/// What `look` finds in an RVE (Rve::Impl) that has its working arrays. A resting one is copied and stays at rest, so
/// that a const call changes nothing.
template <class Impl, class Look>
auto at_work(const Impl& rve, Look look) {
  if (!rve.resting) return look(rve);
  Impl copy = rve;
  return look(std::as_const(copy.at_work()));
}

/// The same for one in which nothing is deferred; where the sub-step of it fails, the grains are shown as they are.
template <class Impl, class Look>
auto brought_up_to_date(const Impl& rve, Look look) {
  if (!rve.has_deferred()) return at_work(rve, look);
  Impl copy = rve;
  try {
    copy.up_to_date();
  } catch (const Error&) {
  }
  return look(std::as_const(copy.at_work()));
}

}  // namespace rvelab
