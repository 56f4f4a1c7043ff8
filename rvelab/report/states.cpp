#include "rvelab/report/states.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/io/export/export.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/report/local_strain.hpp"
#include "rvelab/report/packed.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/specimen/clumps.hpp"

namespace rvelab::report {
namespace {

using ensemble::nan;
using std::numbers::pi;

/// A field that colours the grains, one value per grain.
struct Field {
  const char *key, *label, *unit;
  bool about_zero;  ///< zero is in the middle of the colour scale
  std::vector<std::vector<double>> of_states = {};
};

std::vector<Field> fields_of(const Test& test) {
  std::vector<Field> fields{
      {"pressure", "mean stress of the grain", "kPa", false},
      {"ratio", "stress ratio q/p of the grain", "", false},
      {"contacts", "contacts", "", false},
      {"fluctuation", "displacement beside the mean one, over the mean diameter", "", false},
      {"shear", "local shear strain since the state before", "%", false},
      {"volume", "local volumetric strain since the state before, compression positive", "%", true},
      {"radius", "radius", "mm", false}};
  if (test.recorded.checkpoint.specimen.materials.size() > 1) fields.push_back({"material", "material", "", false});
  return fields;
}

/// Values of the fields at one state.
void measure(const Specimen& specimen, const Network& network, const Motion& motion, std::vector<Field>& fields) {
  const std::size_t n = network.grains.size();
  const int d = network.dimension();
  const auto stresses = io::grain_stresses(network);
  const auto counts = contact_counts(network);
  const double diameter = mean_diameter(network);
  for (Field& field : fields) {
    const std::string key = field.key;
    std::vector<double>& values = field.of_states.emplace_back(n);
    for (std::size_t g = 0; g < n; ++g) {
      const double p = mean_pressure(stresses[g], d);
      values[g] = key == "pressure"      ? p / 1e3
                  : key == "ratio"       ? (counts[g] > 1 && p > 0 ? deviatoric_stress(stresses[g], d) / p : nan)
                  : key == "contacts"    ? counts[g]
                  : key == "fluctuation" ? motion.fluctuation[g].norm() / diameter
                  : key == "shear"       ? 100 * motion.shear[g]
                  : key == "volume"      ? 100 * motion.volume[g]
                  : key == "radius"      ? 1e3 * network.grains[g].radius
                                         : specimen.grains.material[g];
    }
  }
}

struct State {
  long record = 0;
  Specimen specimen;
  Network network;
};

double angle_of(const Vector3& direction) { return std::atan2(direction[1], direction[0]); }

void pack_grains(const State& state, Packed& packed) {
  const Network& network = state.network;
  const Matrix3 lattice = network.cell.rotation * network.cell.lattice;
  for (int k = 0; k < 9; ++k) packed.add(float(lattice(k % 3, k / 3)));
  const Matrix3 inverse = network.cell.lattice.inverse();
  for (int k = 0; k < network.dimension(); ++k)
    for (const GrainState& grain : network.grains) packed.add_part(inverse.row(k).dot(grain.position) + 0.5);
  if (keeps_axis(network.shape))
    for (const GrainState& grain : network.grains)
      packed.add_part(angle_of(network.cell.rotation * grain.orientation) / pi);
}

void pack_contacts(const State& state, double largest_force, Packed& packed) {
  const Network& network = state.network;
  const auto each = [&](const auto& call) {
    for (const ContactState& contact : network.contacts) call(contact);
  };
  const auto pack_row = [&](std::int32_t row) {
    network.grains.size() > 65536 ? packed.add(std::uint32_t(row)) : packed.add(std::uint16_t(row));
  };
  each([&](const ContactState& contact) { pack_row(contact.i); });
  each([&](const ContactState& contact) { pack_row(contact.j); });
  // The image of j as drawn in a page: there both grains are in the cell, rounded as by pack_grains.
  const Matrix3 inverse = network.cell.lattice.inverse();
  const auto drawn = [&](std::int32_t g, int k) {
    const double part = inverse.row(k).dot(network.grains[std::size_t(g)].position) + 0.5;
    return double(std::lround((part - std::floor(part)) * 65536) & 0xffff) / 65536;
  };
  for (int k = 0; k < network.dimension(); ++k)
    each([&](const ContactState& contact) {
      const double image = inverse.row(k).dot(contact.branch) + drawn(contact.i, k) - drawn(contact.j, k);
      packed.add(std::uint8_t(std::clamp(std::lround(image), -128l, 127l) + 128));
    });
  each([&](const ContactState& contact) { packed.add_within(contact.normal_force, 0, largest_force); });
  each([&](const ContactState& contact) {
    const double limit = contact.friction * std::abs(contact.pressing_force);
    const double part = limit > 0 ? std::min(1.0, contact.tangential_force.norm() / limit) : 0;
    packed.add(std::uint8_t(std::lround(255 * part)));
  });
  if (keeps_axis(network.shape))
    each([&](const ContactState& contact) {
      packed.add_part(angle_of(network.cell.rotation * contact.normal) / (2 * pi));
    });
}

/// Half lengths of the grains, m: of ellipses major then minor, otherwise the radius.
Packed sizes_of(const State& state) {
  Packed packed;
  const auto add = [&](const std::vector<double>& column) {
    for (const double value : column) packed.add(float(value));
  };
  with_shape(state.network.shape, [&](auto is) {
    using By = typename decltype(is)::By;
    if constexpr (By::round || By::rigid)
      add(state.specimen.grains.radius);
    else
      each_column_of<By>([&](const auto&, const std::vector<double>& column) { add(column); }, state.specimen.grains);
  });
  return packed;
}

State state_of(long record, const Specimen& specimen) {
  Rve rve(specimen);
  State state{record, rve.specimen(), rve.network()};
  if (state.network.has_bodies()) {  // the page shows them as round grains of the same volume
    std::vector<double> radii;
    for (const GrainState& grain : state.network.grains) radii.push_back(grain.radius);
    state.specimen.grains = bodies_as_grains(state.specimen, radii);
  }
  return state;
}

}  // namespace

ChosenStates chosen_states(const Test& test, std::size_t every) {
  ChosenStates chosen;
  const auto& snapshots = test.recorded.snapshots;
  for (std::size_t k = 0; k < snapshots.size(); k += every) chosen.snapshots.push_back(k);
  chosen.end = snapshots.empty() || snapshots.back().record + 1 < test.records().size();
  if (!chosen.end && chosen.snapshots.back() + 1 < snapshots.size()) chosen.snapshots.push_back(snapshots.size() - 1);
  return chosen;
}

double bytes_of_states(const Test& test) {
  const Specimen& end = test.recorded.checkpoint.specimen;
  const double a_grain = 2.0 * double(test.dimension + 8), a_contact = 9.0 + test.dimension;
  return double(test.recorded.snapshots.size() + 1) *
         (a_grain * double(end.grains.size()) + a_contact * double(end.contacts.size()));
}

Json states_of(const Test& test, const ChosenStates& chosen) {
  std::vector<State> states;
  for (const std::size_t k : chosen.snapshots) {
    const io::Snapshot& snapshot = test.recorded.snapshots[k];
    states.push_back(state_of(long(snapshot.record), io::read_snapshot(snapshot)));
  }
  if (chosen.end) states.push_back(state_of(long(test.records().size()) - 1, test.recorded.checkpoint.specimen));
  std::vector<Field> fields = fields_of(test);
  Motion motion(states.front().network);
  double largest_force = 0;
  for (std::size_t s = 0; s < states.size(); ++s) {
    if (s > 0) {
      const auto F = [&](const State& state) { return test.deformation.at(std::size_t(state.record)); };
      motion.go_on(states[s - 1].network, states[s].network, F(states[s]) * F(states[s - 1]).inverse());
    }
    measure(states[s].specimen, states[s].network, motion, fields);
    for (const ContactState& contact : states[s].network.contacts)
      largest_force = std::max(largest_force, contact.normal_force);
  }
  Json json;
  json["grains"] = states.front().network.grains.size();
  const Shape shape = states.front().network.shape;
  json["shape"] = name(moves_as_body(shape) ? round_shape(3) : shape);  // as the page shows bodies
  json["sizes"] = sizes_of(states.front()).text();
  json["largest_force_N"] = number(largest_force);
  std::vector<std::pair<double, double>> ranges;
  json["fields"] = Json::array();
  for (const Field& field : fields) {
    std::vector<double> all;
    for (const auto& values : field.of_states)
      std::copy_if(values.begin(), values.end(), std::back_inserter(all), [](double v) { return std::isfinite(v); });
    std::sort(all.begin(), all.end());
    const bool varies = !all.empty() && all.back() > all.front();
    ranges.emplace_back(varies ? all.front() : 0, varies ? all.back() : 0);
    if (varies) json["fields"].push_back(described_field(field, all));
  }
  json["states"] = Json::array();
  for (std::size_t s = 0; s < states.size(); ++s) {
    Packed packed;
    pack_grains(states[s], packed);
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (ranges[f].second > ranges[f].first)
        for (const double value : fields[f].of_states[s]) packed.add_within(value, ranges[f].first, ranges[f].second);
    pack_contacts(states[s], largest_force, packed);
    json["states"].push_back(
        {{"record", states[s].record}, {"contacts", states[s].network.contacts.size()}, {"packed", packed.text()}});
  }
  return json;
}

}  // namespace rvelab::report
