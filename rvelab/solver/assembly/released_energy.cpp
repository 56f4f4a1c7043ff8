#include "rvelab/solver/assembly/released_energy.hpp"

namespace rvelab {

namespace {

/// Of these laws the column says it, of others with an energy of their own the jump of that energy.
template <class Law>
concept NotesRelease = requires {
  Law::released;
};

/// Gaps at the end and the start of the last sub-step, m.
struct Gaps {
  double now, before;
};
Gaps gaps_of(const Model& model, const Assembly& assembly, const InteractionTable& t, std::size_t k) {
  const auto i = std::size_t(t.i[k]), j = std::size_t(t.j[k]);
  const LastStep& step = assembly.state.last_step;
  const Vector3 branch =
      assembly.position(model, j) + translation(assembly.cell, t.image[k]) - assembly.position(model, i);
  const Vector3 velocity = assembly.velocity(model, j) - assembly.velocity(model, i) + step.rate * branch;
  const double length = branch.norm(), gap = length - (model.radius[i] + model.radius[j]);
  return {gap, gap - step.length * branch.dot(velocity) / length};
}

/// A force that sets in or ends within a sub-step does its work in half of it (the balance takes the mean of the forces
/// at both ends), so that the energy that is gone is the mean of the jumps there. By the last jump alone the error
/// would fall with the step, not with its square.
template <class Law>
double released_since(const Model& model, const Assembly& assembly, const InteractionTable& t,
                      const std::vector<Buffer>& before) {
  double sum = 0;
  for (std::size_t k = 0; k < t.count; ++k) {
    if constexpr (NotesRelease<Law>) {
      sum += t.column[Law::released][k] - before.front()[k];
    } else if constexpr (Law::has_energy) {
      const auto was = [&](int c) { return before[std::size_t(c)][k]; };
      const auto is = [&](int c) { return t.column[std::size_t(c)][k]; };
      const Gaps gaps = gaps_of(model, assembly, t, k);
      if (Law::acts(was, gaps.now) == Law::acts(is, gaps.now)) continue;
      const double thickness = model.dimension() == 2 ? model.thickness : 0;
      for (const double gap : {gaps.now, gaps.before})
        sum += 0.5 * (Law::energy(was, gap, thickness) - Law::energy(is, gap, thickness));
    }
  }
  return sum;
}

/// visit(law, table, number) for each table.
template <class Visit>
void each_table(const Assembly& assembly, const Visit& visit) {
  each_interaction_law([&](auto kind, auto law) {
    for (std::size_t n = 0; n < assembly.pairs.interactions.size(); ++n)
      if (assembly.pairs.interactions[n].kind == kind) visit(law, assembly.pairs.interactions[n], n);
  });
}

}  // namespace

void ReleasedEnergy::keep(const Assembly& assembly) {
  before_.resize(assembly.pairs.interactions.size());
  each_table(assembly, [&](auto law, const InteractionTable& t, std::size_t n) {
    using Law = decltype(law);
    if constexpr (NotesRelease<Law>) {
      before_[n].resize(1);
      before_[n].front() = t.column[Law::released];
    } else if constexpr (Law::has_energy) {
      before_[n] = t.column;
    }
  });
}

void ReleasedEnergy::book(const Model& model, Assembly& assembly) const {
  each_table(assembly, [&](auto law, const InteractionTable& t, std::size_t n) {
    using Law = decltype(law);
    assembly.state.energy_balance.book(NotesRelease<Law> ? &InteractionTerms::breaking : &InteractionTerms::forming,
                                       released_since<Law>(model, assembly, t, before_[n]));
  });
}

}  // namespace rvelab
