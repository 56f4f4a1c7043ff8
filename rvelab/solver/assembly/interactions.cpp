#include "rvelab/solver/assembly/interactions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "rvelab/contact/laws.hpp"
#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/listing.hpp"

namespace rvelab {

namespace {

/// with(Law{}) for the law of this number.
template <class With, class First, class... Rest>
auto with_interaction_law(int kind, const With& with, TypeList<First, Rest...>) {
  if constexpr (sizeof...(Rest) > 0) {
    if (kind > 0) return with_interaction_law(kind - 1, with, TypeList<Rest...>{});
  }
  return with(First{});
}
template <class With>
auto with_interaction_law(int kind, const With& with) {
  return with_interaction_law(kind, with, InteractionLaws{});
}

InteractionArrays arrays_of(const Model& model, PairTable& pairs, InteractionTable& table) {
  InteractionArrays a;
  a.row_i = table.row_i.data();
  a.row_j = table.row_j.data();
  for (std::size_t k = 0; k < 3; ++k) a.image[k] = table.image_number[k].data();
  a.radius_i = table.radius[0].data();
  a.radius_j = table.radius[1].data();
  for (std::size_t k = 0; k < table.column.size(); ++k) a.column[k] = table.column[k].data();
  a.thickness = model.dimension() == 2 ? model.thickness : 0;
  a.force = pairs.force.data() + table.row_at * std::size_t(force_row_length(model.dimension()));
  a.resultants = pairs.resultants.data();
  return a;
}

template <class Law>
void sort(std::vector<Interaction<Law>>& items) {
  std::sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return pair_of(a) < pair_of(b); });
}

}  // namespace

void set_interactions(const Model& model, const Interactions& from, PairTable& pairs) {
  pairs.interactions.clear();
  each_interaction_law([&](auto kind, auto law) {
    using Law = decltype(law);
    const auto& items = static_cast<const ListOf<Law>&>(from).items;
    if (items.empty()) return;
    InteractionTable t;
    t.kind = kind;
    t.count = items.size();
    const std::size_t padded = padded_to_lanes(t.count);
    t.i.assign(padded, std::int32_t(model.size()));  // padding grains
    t.j = t.i;
    t.image.assign(padded, Image{1, 0, 0});
    constexpr int columns = interaction_columns<Law>();
    t.column.assign(columns, Buffer(padded, 0.0));
    double values[columns];
    for (std::size_t k = 0; k < items.size(); ++k) {
      t.i[k] = items[k].i;
      t.j[k] = items[k].j;
      t.image[k] = items[k].image;
      put_columns<Law>(items[k], values);
      for (std::size_t c = 0; c < columns; ++c) t.column[c][k] = values[c];
    }
    pairs.interactions.push_back(std::move(t));
  });
}

Interactions interactions_of(const PairTable& pairs, bool all) {
  Interactions found;
  each_interaction_law([&](auto kind, auto law) {
    using Law = decltype(law);
    for (const InteractionTable& t : pairs.interactions) {
      if (t.kind != kind) continue;
      auto& items = static_cast<ListOf<Law>&>(found).items;
      double values[interaction_columns<Law>()];
      for (std::size_t k = 0; k < t.count; ++k) {
        for (std::size_t c = 0; c < t.column.size(); ++c) values[c] = t.column[c][k];
        if (!all && !Law::kept([&](int c) { return values[c]; })) continue;
        Interaction<Law>& item = items.emplace_back();
        item.i = t.i[k];
        item.j = t.j[k];
        item.image = t.image[k];
        take_columns<Law>(values, item);
      }
    }
  });
  return found;
}

void follow_reduction(const Reduction& reduction, int dimension, Interactions& interactions) {
  const Matrix3 back = reduction.rotation.transpose();
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    for (Interaction<Law>& item : static_cast<ListOf<Law>&>(interactions).items) {
      const Eigen::Vector3i n = reduction.inverse_basis * Eigen::Vector3i(item.image[0], item.image[1], item.image[2]);
      item.image = {n[0], n[1], n[2]};
      if (dimension == 3) turn_vectors<Law>(item, back);
    }
  });
}

void follow_wrapping(const std::vector<Image>& moved, int dimension, Interactions& interactions) {
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    auto& items = static_cast<ListOf<Law>&>(interactions).items;
    for (Interaction<Law>& item : items) {
      for (std::size_t k = 0; k < 3; ++k)
        item.image[k] += moved[std::size_t(item.i)][k] - moved[std::size_t(item.j)][k];
      if (item.i != item.j || points_forward(item.image)) continue;
      for (int& n : item.image) n = -n;
      turn_round<Law>(item, dimension);
    }
    sort<Law>(items);
  });
}

namespace {

/// Pairs of grains as laws see them.
struct PairMaker {
  const ContactModel& contact;
  const std::vector<Material>& materials;
  double thickness;

  GrainPair of(double ri, std::int32_t material_i, double rj, std::int32_t material_j, double length) const {
    const double kn = with_law(contact.law, [&](auto law) {
      return decltype(law)::mix(materials[std::size_t(material_i)], ri, materials[std::size_t(material_j)], rj,
                                thickness)
          .kn;
    });
    return {ri, rj, thickness, length - (ri + rj), kn};
  }
};

template <FormsByItself Law>
bool is_kept(const Interaction<Law>& item) {
  double columns[interaction_columns<Law>()];
  put_columns<Law>(item, columns);
  return Law::kept([&](int c) { return columns[c]; });
}

double thickness_of(const Model& model) { return model.dimension() == 2 ? model.thickness : 0; }

/// What it releases that acts from now on and is kept, J. (What is not kept follows from where grains lie, and jumps
/// nowhere.)
template <FormsByItself Law>
double released_by_new(const Interaction<Law>& item, double gap, double thickness) {
  double sum = 0;
  if constexpr (Law::has_energy) {
    double columns[interaction_columns<Law>()];
    put_columns<Law>(item, columns);
    const auto column = [&](int c) { return columns[c]; };
    if (Law::kept(column) && Law::acts(column, gap)) sum -= Law::energy(column, gap, thickness);
  }
  return sum;
}

template <FormsByItself Law>
void prepare(const typename Law::Settings& settings, const GrainPair& pair, Interaction<Law>& item) {
  double columns[interaction_columns<Law>()];
  put_columns<Law>(item, columns);
  Law::prepare(settings, pair, columns);
  take_columns<Law>(columns, item);
}

/// One for each listed pair, in order. Adds what new ones release.
template <FormsByItself Law>
std::vector<Interaction<Law>> of_listed(const Model& model, const Assembly& assembly,
                                        const std::vector<ListedPair>& listed,
                                        const std::vector<Interaction<Law>>& before, double& released) {
  const PairMaker pairs{model.contact, model.materials, thickness_of(model)};
  const typename Law::Settings& settings =
      static_cast<const SettingsOf<Law>&>(model.interaction_settings).settings.front();
  std::vector<Interaction<Law>> items;
  auto old = before.begin();
  for (const ListedPair& pair : listed) {
    Interaction<Law> item;
    item.i = pair.i;
    item.j = pair.j;
    item.image = pair.image;
    for (; old != before.end() && pair_of(*old) < pair_of(item); ++old)
      if (is_kept<Law>(*old)) items.push_back(*old);
    if (old != before.end() && pair_of(*old) == pair_of(item)) {
      items.push_back(*old++);
      continue;
    }
    const auto i = std::size_t(pair.i), j = std::size_t(pair.j);
    const Vector3 branch =
        assembly.position(model, j) + translation(assembly.cell, pair.image) - assembly.position(model, i);
    const GrainPair grains =
        pairs.of(model.radius[i], model.material[i], model.radius[j], model.material[j], branch.norm());
    prepare<Law>(settings, grains, item);
    if (model.options.energy_balance) released += released_by_new<Law>(item, grains.gap, grains.thickness);
    items.push_back(item);
  }
  for (; old != before.end(); ++old)
    if (is_kept<Law>(*old)) items.push_back(*old);
  return items;
}

}  // namespace

double prepare_interactions(const Model& model, const Assembly& assembly, const std::vector<ListedPair>& listed,
                            double skin, Interactions& interactions) {
  double released = 0;
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    if constexpr (FormsByItself<Law>) {
      const auto& settings = static_cast<const SettingsOf<Law>&>(model.interaction_settings).settings;
      if (settings.empty()) return;
      auto& items = static_cast<ListOf<Law>&>(interactions).items;
      const double reach = Law::reach(settings.front());
      items = reach > 0 ? of_listed<Law>(model, assembly, near_pairs(model, assembly, skin + reach), items, released)
                        : of_listed<Law>(model, assembly, listed, items, released);
    }
  });
  return released;
}

void prepare_interactions(Specimen& s) {
  const PairMaker pairs{s.contact, s.materials, s.cell.dimension == 2 ? s.cell.lattice(2, 2) : 0};
  each_interaction_law([&](auto, auto law) {
    using Law = decltype(law);
    if constexpr (FormsByItself<Law>) {
      auto& list = static_cast<ListOf<Law>&>(s);
      for (Interaction<Law>& item : list.items) {
        const auto i = std::size_t(item.i), j = std::size_t(item.j);
        const Vector3 branch = s.grains.position[j] + translation(s.cell, item.image) - s.grains.position[i];
        prepare<Law>(
            list.settings.front(),
            pairs.of(s.grains.radius[i], s.grains.material[i], s.grains.radius[j], s.grains.material[j], branch.norm()),
            item);
      }
    }
  });
}

void derive_interactions(const Model& model, PairTable& pairs) {
  std::size_t row = pairs.padded();
  std::size_t rows = row;
  for (const InteractionTable& t : pairs.interactions) rows += t.padded();
  pairs.force.assign(rows * std::size_t(force_row_length(model.dimension())), 0.0);
  pairs.resultants.assign(
      pairs.interactions.empty() ? 0 : padded_to_lanes(model.size()) * std::size_t(model.row_length()), 0.0);
  for (InteractionTable& t : pairs.interactions) {
    if (model.kernels_at(Loading::quasi_static).interactions[t.kind] == nullptr)
      throw InputError("this build has no kernels of interactions; use the program");
    t.row_at = row;
    row += t.padded();
    t.row_i.resize(t.padded());
    t.row_j.resize(t.padded());
    t.image_number.assign(3, Buffer(t.padded(), 0.0));
    t.radius.assign(2, Buffer(t.padded(), 0.0));
    for (std::size_t k = 0; k < t.padded(); ++k) {
      t.row_i[k] = t.i[k] * model.row_length();
      t.row_j[k] = t.j[k] * model.row_length();
      for (std::size_t c = 0; c < 3; ++c) t.image_number[c][k] = t.image[k][c];
      if (k >= t.count) continue;
      t.radius[0][k] = model.radius[std::size_t(t.i[k])];
      t.radius[1][k] = model.radius[std::size_t(t.j[k])];
    }
  }
}

namespace {

/// The kernels add to the resultants kind by kind, in the order of the tables, on one thread: the same sums anywhere.
void run(const Model& model, const InteractionKernel* kernels, const StepConstants& constants, Assembly& assembly) {
  for (InteractionTable& t : assembly.pairs.interactions)
    kernels[t.kind](constants, arrays_of(model, assembly.pairs, t), assembly.rows.data(), 0, long(t.padded()));
}

}  // namespace

void update_interactions(const Model& model, const Kernels& kernels, const StepConstants& constants,
                         Assembly& assembly) {
  run(model, kernels.interactions, constants, assembly);
}

void evaluate_interactions(const Model& model, const StepConstants& constants, Assembly& assembly) {
  std::fill(assembly.pairs.resultants.begin(), assembly.pairs.resultants.end(), 0.0);
  run(model, model.kernels_at(assembly.state.last_step.loading).evaluate_interactions, constants, assembly);
}

std::vector<ActingInteraction> acting_interactions(const Model& model, const Assembly& assembly, bool energies) {
  std::vector<ActingInteraction> all;
  const bool plane = model.dimension() == 2;
  for (const InteractionTable& t : assembly.pairs.interactions) {
    with_interaction_law(t.kind, [&](auto law) {
      using Law = decltype(law);
      for (std::size_t k = 0; k < t.count; ++k) {
        const auto column = [&](int c) { return t.column[std::size_t(c)][k]; };
        ActingInteraction a;
        a.kind = t.kind;
        a.i = std::size_t(t.i[k]);
        a.j = std::size_t(t.j[k]);
        a.row = k;
        a.branch =
            assembly.position(model, a.j) + translation(assembly.cell, t.image[k]) - assembly.position(model, a.i);
        a.length = a.branch.norm();
        const double half_gap = 0.5 * (a.length - (model.radius[a.i] + model.radius[a.j]));
        if (!Law::acts(column, 2 * half_gap)) continue;
        a.normal = a.branch / a.length;
        a.arm_i = model.radius[a.i] + half_gap;
        a.arm_j = model.radius[a.j] + half_gap;
        const double* row = assembly.pairs.force_row(model.dimension(), t.row_at + k);
        if (plane) {
          a.force = {row[0], row[1], 0};
          a.moment_j = {0, 0, row[2]};
          a.moment_i = {0, 0, row[3]};
        } else {
          a.force = {row[0], row[1], row[2]};
          a.moment_j = {row[4], row[5], row[6]};
          a.moment_i = -a.moment_j - a.branch.cross(a.force);  // moments balance
        }
        a.normal_force = a.force.dot(a.normal);
        const double thickness = plane ? model.thickness : 0;
        a.stiffness = Law::stiffness(column, 2 * half_gap, thickness);
        a.has_energy = Law::has_energy;
        if constexpr (Law::has_energy)
          if (energies) a.energy = Law::energy(column, 2 * half_gap, thickness);
        all.push_back(a);
      }
    });
  }
  return all;
}

namespace {

/// InteractionSums::broken of a law that notes what it released.
template <class Law>
double squares_of_broken(const InteractionTable& t, double thickness) {
  double sum = 0;
  if constexpr (requires { Law::broken, Law::released; })
    for (std::size_t k = 0; k < t.count; ++k) {
      if (t.column[Law::broken][k] == 0) continue;
      const double length = t.radius[0][k] + t.radius[1][k];
      const auto unbroken = [&](int c) { return c == Law::broken ? 0 : t.column[std::size_t(c)][k]; };
      sum += 2 * Law::stiffness(unbroken, 0.0, thickness).normal * t.column[Law::released][k] * (length * length);
    }
  return sum;
}

}  // namespace

InteractionSums interaction_sums(const Model& model, const Assembly& assembly) {
  InteractionSums sums;
  for (const ActingInteraction& a : acting_interactions(model, assembly)) {
    (a.normal_force > 0 ? sums.push : sums.pull) += std::abs(a.normal_force) * a.length;
    sums.stiffness += std::max(0.0, a.stiffness.normal) * a.length * a.length;
    // A sum, so that the order of the table, which each new list changes, does not count.
    const auto [low, high] = std::minmax(model.id[a.i], model.id[a.j]);
    std::uint64_t pair = (std::uint64_t(low) * 0x9e3779b97f4a7c15ULL) ^ std::uint64_t(high);
    pair = (pair ^ (pair >> 29)) * 0xbf58476d1ce4e5b9ULL + std::uint64_t(a.kind);
    sums.acting += pair ^ (pair >> 32);
  }
  const double thickness = thickness_of(model);
  for (const InteractionTable& t : assembly.pairs.interactions)
    with_interaction_law(t.kind, [&](auto law) { sums.broken += squares_of_broken<decltype(law)>(t, thickness); });
  return sums;
}

Matrix3 interaction_virial(const Model& model, const Assembly& assembly) {
  Matrix3 sum = Matrix3::Zero();
  for (const ActingInteraction& a : acting_interactions(model, assembly)) sum += a.force * a.branch.transpose();
  return sum;
}

}  // namespace rvelab
