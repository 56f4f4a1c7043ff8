// Numbers at the edge: units, denormals, what is no number, and the same bits from every instruction set.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/solver/kernels/configuration.hpp"
#include "tests/extreme/matrix.hpp"
#include "tests/extreme/specimens.hpp"

namespace rvelab::test {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The same specimen at rest in other units: lengths times `length`, forces times `force`.
Specimen in_units(Specimen s, double length, double force) {
  s.cell.lattice *= length;
  s.solver.min_height *= length;
  for (auto* sizes : {&s.grains.radius, &s.grains.semi_major, &s.grains.semi_minor})
    for (double& size : *sizes) size *= length;
  for (Vector3& x : s.grains.position) x *= length;
  for (Material& m : s.materials) {
    m.young_modulus *= force / length / length;
    m.normal_stiffness *= force / length;
    m.tangential_stiffness *= force / length;
  }
  for (Contact& c : s.contacts) {
    c.tangential_force *= force;
    c.rolling_moment *= force * length;
    c.last_root_overlap *= std::sqrt(length);
  }
  s.state = {};
  return s;
}

/// Without the grains that touch fewer than two others. These fly freely from wall to wall of their cage, which
/// multiplies round-off: two of 64 discs brought 3e-13 of p to 1e-10 in one increment.
Specimen without_rattlers(const Specimen& s) {
  std::vector<int> touching(s.grains.size(), 0), kept(s.grains.size(), -1);
  for (const ContactState& contact : Rve(s).network().contacts)
    ++touching[std::size_t(contact.i)], ++touching[std::size_t(contact.j)];
  Specimen rest = s;
  rest.grains = {};
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    if (touching[g] < 2) continue;
    kept[g] = int(rest.grains.size());
    rest.grains.id.push_back(s.grains.id[g]);
    rest.grains.radius.push_back(s.grains.radius[g]);
    rest.grains.material.push_back(s.grains.material[g]);
    rest.grains.position.push_back(s.grains.position[g]);
    rest.grains.velocity.push_back(s.grains.velocity[g]);
    rest.grains.spin.push_back(s.grains.spin[g]);
  }
  for (Contact& contact : rest.contacts)
    contact.i = kept[std::size_t(contact.i)], contact.j = kept[std::size_t(contact.j)];
  std::erase_if(rest.contacts, [](const Contact& contact) { return contact.i < 0 || contact.j < 0; });
  return rest;
}

const Matrix3& some_increment(int dimension) {
  static const Matrix3 two = entry(0, 0, 3e-4) + entry(0, 1, 1e-4) + entry(1, 1, -5e-4);
  static const Matrix3 three = two + entry(2, 2, 1e-4) + entry(0, 2, 2e-4);
  return dimension == 2 ? two : three;
}

/// Places, velocities, spins, histories, lattice and stress. Only what has the same bits in every build layout.
std::uint64_t hash_of(const Rve& rve) {
  const Specimen s = rve.specimen();
  std::uint64_t hash = empty_hash;
  const auto take = [&](const auto& values) {
    for (int k = 0; k < values.size(); ++k) hash = hashed(hash, std::bit_cast<std::uint64_t>(values.data()[k]));
  };
  for (std::size_t g = 0; g < s.grains.size(); ++g)
    for (const Vector3* v : {&s.grains.position[g], &s.grains.velocity[g], &s.grains.spin[g]}) take(*v);
  for (const Vector3& axis : s.grains.orientation) take(axis);
  for (const Contact& c : s.contacts) {
    take(c.tangential_force);
    take(c.rolling_moment);
  }
  take(s.cell.lattice);
  take(rve.stress());
  return hash;
}

void powers_of_two(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  const double length = std::ldexp(1.0, int(asked("length_power"))), force = std::ldexp(1.0, int(asked("force_power")));
  const Specimen s = in_units(usual(d, asked("hertz") != 0, 0.5, asked("aspect_ratio")), 1, 1);
  Tested plain(s, verdict), scaled(in_units(s, length, force), verdict);
  for (int k = 0; k < 20; ++k) {
    const Matrix3 one = plain.apply(some_increment(d), 0).stress;
    const Matrix3 other = scaled.apply(some_increment(d), 0).stress * (length / force * length);
    verdict.law("bitwise the stress in other units, of it", largest(one - other) / largest(one), 1e-300);
  }
  scaled.check_laws();
}

void other_lengths(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  const double length = asked("radius");
  const Specimen s = without_rattlers(in_units(usual(d, asked("hertz") != 0), 1, 1));
  Tested plain(s, verdict), scaled(in_units(s, length, length * length), verdict);
  const double p = plain.pressure();
  for (int k = 0; k < 10; ++k) {  // 0.02 % strain, over which round-off has not grown (solver/README.md)
    const Matrix3 increment = some_increment(d) / 25;
    const Matrix3 one = plain.apply(increment, 0).stress, other = scaled.apply(increment, 0).stress;
    verdict.law("stress of grains of radius 1, of p", largest(one - other) / p, asked.tolerance);
  }
  scaled.check_laws();
}

void denormal_increment(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  Tested tested(usual(d, d == 3), verdict);
  const Matrix3 first = tested.rve().stress();
  const double p = tested.pressure();
  for (int k = 0; k < 3; ++k) tested.apply(asked("strain") * shear_direction(d), asked("dt"));
  tested.check_laws();
  verdict.law("no strain, no change of stress, of p", largest(tested.rve().stress() - first) / p, asked.tolerance);
}

/// A call that must be refused by an error of type E, the state unchanged.
template <class E>
void require_refusal(const std::string& what, Rve& rve, const std::function<void(Rve&)>& call, Verdict& verdict) {
  verdict.refusal(what, refused(rve, [&](Rve& r) {
                    try {
                      call(r);
                    } catch (const E&) {
                      throw;
                    } catch (const Error&) {
                      verdict.law(what + " is told from other errors by its type", false);
                      throw;
                    }
                  }));
}

void no_target(Rve& rve, double dt, Verdict& verdict) {
  MixedTarget good;
  good.rows = {stress_row(0, 0, -100, 1000)};
  for (int i = 0; i < rve.cell().dimension; ++i)
    for (int k = std::max(i, 1); k < rve.cell().dimension; ++k) good.rows.push_back(strain_row(i, k, 0));
  for (const double bad : {not_a_number, infinity}) {
    std::vector<MixedTarget> targets(6, good);
    targets[0].rows[0].value = bad;
    targets[1].rows[0].scale = bad;
    targets[2].rows[0].stress(0, 0) = bad;
    targets[3].rows[0].strain(1, 1) = bad;
    targets[4].spin = entry(0, 1, bad) - entry(1, 0, bad);
    targets[5].tolerance = bad;
    for (const double time : {dt, 1e-6})
      for (const MixedTarget& target : targets)
        require_refusal<InputError>(
            "a target that is no number", rve, [&](Rve& r) { r.apply(target, time); }, verdict);
  }
  for (const double time : {not_a_number, infinity, -1.0})
    require_refusal<InputError>(
        "no time of a target", rve, [&](Rve& r) { r.apply(good, time); }, verdict);
}

void no_velocity(Rve& rve, Verdict& verdict) {
  const std::vector<Vector3> still(rve.size(), Vector3::Zero());
  for (const bool spins : {false, true}) {
    std::vector<Vector3> velocity = still, spin = still;
    (spins ? spin : velocity).back()[spins ? 2 : 1] = spins ? infinity : not_a_number;
    std::string text;
    const auto set = [&](Rve& r) { text = error_text<InputError>([&] { r.set_velocities(velocity, spin); }); };
    const auto before = rve.save();
    set(rve);
    verdict.refusal("a velocity that is no number", Refused{text, rve.save() == before});
    verdict.law("the grain is named (" + text + ")", contains(text, "grain " + std::to_string(rve.size())));
  }
}

void no_increment(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension")), kind = int(asked("kind"));
  Rve rve(usual(d, d == 3));
  rve.apply(1e-4 * shear_direction(d), 0);  // slip in the history, so that there is state to spoil
  const auto require = [&](const char* what, const Matrix3& increment) {
    for (const double time : {asked("dt"), 1e-6})
      require_refusal<InvalidIncrement>(
          what, rve, [&](Rve& r) { r.apply(increment, time); }, verdict);
  };
  if (kind <= 2)
    for (int i = 0; i < 9; ++i)
      require("an entry that is no number", entry(i / 3, i % 3, std::vector{not_a_number, infinity, -infinity}[kind]));
  if (kind == 3) require("det(I + dH) = 0", entry(0, 0, -1));
  if (kind == 4)
    for (const double negative : {-1.5, -1e300}) require("det(I + dH) < 0", entry(0, 0, negative));
  if (kind == 5) require("det(I + dH) beyond all numbers", isotropic(d, 1e300));
  if (kind == 6)
    for (const double time : {not_a_number, infinity, -infinity, -1.0, -5e-324})
      require_refusal<InvalidIncrement>(
          "no time", rve, [&](Rve& r) { r.apply(shear_direction(d) * 1e-6, time); }, verdict);
  if (kind == 7 && d == 2)
    for (const Matrix3& out : {entry(0, 2, 1e-3), entry(0, 2, 1e-9), entry(2, 2, -1e-3)})
      require("an increment out of the plane", out);
  if (kind == 7 && d == 3) require("det(I + dH) < 0", entry(0, 0, -2));
  if (kind == 8) no_target(rve, asked("dt"), verdict);
  if (kind == 9) no_velocity(rve, verdict);
}

void huge_increment(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  Tested tested(usual(d, d == 3), verdict);
  tested.apply(asked("shear") * shear_direction(d) + isotropic(d, asked("expansion")), asked("dt"));
  tested.check_laws();
}

/// The state after 500 steps of every grain.
std::uint64_t hash_of_run(const Case& asked) {
  const int d = int(asked("dimension"));
  Specimen s = usual(d, asked("hertz") != 0, 0.5, asked("aspect_ratio"));
  s.contact.rolling = asked("rolling") != 0;
  for (Material& m : s.materials) {
    m.rolling_stiffness = asked("rolling");
    m.rolling_friction = 0.1 * asked("rolling");
  }
  s.damping.dashpot = Dashpot::restitution;
  s.damping.restitution = 0.5;
  Rve rve(s);
  const double dt = asked("dt_over_critical") * rve.critical_time_step();
  while (rve.grain_steps() < 500 * rve.size()) rve.apply(0.1 * some_increment(d), dt);
  return hash_of(rve);
}

void kernels_agree(const Case& asked, Verdict& verdict) {
  std::optional<std::uint64_t> first;
  int ran = 0;
  for (const std::string instruction_set : {"scalar", "baseline", "v3", "v4"}) {
    setenv("RVELAB_ISA", instruction_set.c_str(), 1);
    try {
      verdict.law("kernels are those of RVELAB_ISA",
                  kernels_for(KernelConfiguration{}).instruction_set == instruction_set);
    } catch (const InputError&) {
      continue;  // this processor cannot run them
    }
    const std::uint64_t hash = hash_of_run(asked);
    ++ran;
    if (!first) first = hash;
    verdict.law("bits of RVELAB_ISA=" + instruction_set + " are those of scalar", hash == *first);
  }
  verdict.law("at least two instruction sets ran", ran >= 2);
  verdict.bits(first.value());
}

}  // namespace

std::vector<Experiment> number_experiments() {
  return {{"numbers/units", powers_of_two, "dimension 2, hertz 0, length_power 0, force_power 0, aspect_ratio 1"},
          {"numbers/length", other_lengths, "dimension 2, hertz 0, radius 1e-6"},
          {"numbers/denormal", denormal_increment, "dimension 2, strain 0, dt 0"},
          {"numbers/no_increment", no_increment, "dimension 2, kind 0, dt 0"},
          {"numbers/huge", huge_increment, "dimension 2, shear 0, expansion 0, dt 0"},
          {"numbers/kernels", kernels_agree, "dimension 2, hertz 0, rolling 0, dt_over_critical 0, aspect_ratio 1"}};
}

}  // namespace rvelab::test
