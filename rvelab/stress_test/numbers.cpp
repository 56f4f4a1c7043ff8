// Numbers at the edge: units, denormals, what is no number, and the same bits from every instruction set.
// Declared in experiments.hpp.
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/stress_test/experiments.hpp"
#include "rvelab/stress_test/prepared.hpp"
#include "rvelab/stress_test/tested.hpp"

namespace rvelab::stress_test {

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

/// FNV-1a over the bits of numbers.
class Hash {
 public:
  void take(const double* values, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      std::uint64_t bits;
      std::memcpy(&bits, values + k, sizeof bits);
      for (int byte = 0; byte < 8; ++byte) value_ = (value_ ^ ((bits >> 8 * byte) & 255)) * 0x100000001b3ULL;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Places, velocities, spins, histories, lattice and stress. Only what has the same bits in every build layout.
std::uint64_t hash_of(const Rve& rve) {
  const Specimen s = rve.specimen();
  Hash hash;
  for (std::size_t g = 0; g < s.grains.size(); ++g)
    for (const Vector3* v : {&s.grains.position[g], &s.grains.velocity[g], &s.grains.spin[g]}) hash.take(v->data(), 3);
  for (const Vector3& axis : s.grains.orientation) hash.take(axis.data(), 3);
  for (const Contact& c : s.contacts) {
    hash.take(c.tangential_force.data(), 3);
    hash.take(c.rolling_moment.data(), 3);
  }
  hash.take(s.cell.lattice.data(), 9);
  hash.take(rve.stress().data(), 9);
  return hash.value();
}

/// State of a specimen after 500 steps with the kernels of one instruction set, computed in a process of its own, since
/// kernels may be chosen once in a process. None: this processor cannot run them.
std::optional<std::uint64_t> hash_with(const char* instruction_set, const std::function<std::uint64_t()>& compute) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("no pipe could be made");
  const pid_t child = fork();
  if (child < 0) throw Error("no child process could be started");
  if (child == 0) {
    setenv("RVELAB_ISA", instruction_set, 1);
    try {
      const std::uint64_t value = compute();
      _exit(write(ends[1], &value, sizeof value) == ssize_t(sizeof value) ? 0 : 1);
    } catch (const InputError&) {
      _exit(2);  // cannot run here
    } catch (...) {
      _exit(1);
    }
  }
  close(ends[1]);
  std::uint64_t value = 0;
  const bool got = read(ends[0], &value, sizeof value) == ssize_t(sizeof value);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2) return std::nullopt;
  if (!got || status != 0) throw Error(std::string("the run with RVELAB_ISA=") + instruction_set + " failed");
  return value;
}

}  // namespace

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

void no_increment(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  const double dt = asked("dt");
  Rve rve(usual(d, d == 3));
  rve.apply(1e-4 * shear_direction(d), 0);  // slip in the history, so that there is state to spoil
  const auto require = [&](const char* what, const Matrix3& increment, double time) {
    verdict.refusal(what, refused(rve, [&](Rve& r) { r.apply(increment, time); }));
  };
  switch (int(asked("kind"))) {
    case 0:
    case 1:
    case 2: {
      const double bad[] = {not_a_number, infinity, -infinity};
      for (int i = 0; i < d; ++i)
        for (int k = 0; k < d; ++k) require("an entry that is no number", entry(i, k, bad[int(asked("kind"))]), dt);
      break;
    }
    case 3:
      return require("det(I + dH) = 0", entry(0, 0, -1), dt);
    case 4:
      return require("det(I + dH) < 0", entry(0, 0, -1.5), dt);
    case 5:
      return require("det(I + dH) beyond all numbers", isotropic(d, 1e300), dt);
    case 6:
      for (const double time : {not_a_number, infinity, -1.0, -5e-324})
        require("no time", shear_direction(d) * 1e-6, time);
      break;
    case 7:
      return require("an increment out of the plane", d == 2 ? entry(0, 2, 1e-3) : entry(0, 0, -2), dt);
    case 8: {
      MixedTarget target;
      for (int i = 0; i < d; ++i)
        for (int k = i; k < d; ++k) target.rows.push_back({entry(i, k, 0.5) + entry(k, i, 0.5), Matrix3::Zero(), 0, 0});
      target.rows[0] = {Matrix3::Zero(), entry(0, 0, 1), not_a_number, 1};
      verdict.refusal("a target that is no number", refused(rve, [&](Rve& r) { r.apply(target, dt); }));
      break;
    }
    default: {
      std::vector<Vector3> velocity(rve.size(), Vector3::Zero()), spin = velocity;
      velocity.back()[0] = not_a_number;
      verdict.refusal("a velocity that is no number", refused(rve, [&](Rve& r) { r.set_velocities(velocity, spin); }));
    }
  }
}

void huge_increment(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  Tested tested(usual(d, d == 3), verdict);
  tested.apply(asked("shear") * shear_direction(d) + isotropic(d, asked("expansion")), asked("dt"));
  tested.check_laws();
}

void kernels_agree(const Case& asked, Verdict& verdict) {
  const int d = int(asked("dimension"));
  const auto compute = [&] {
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
  };
  int ran = 0;
  std::optional<std::uint64_t> first;
  for (const char* instruction_set : {"scalar", "baseline", "v3", "v4"}) {
    const auto hash = hash_with(instruction_set, compute);
    if (!hash) continue;
    ++ran;
    if (!first) first = hash;
    verdict.law(std::string("bits of RVELAB_ISA=") + instruction_set + " are those of scalar", *hash == *first);
  }
  verdict.law("at least two instruction sets ran", ran >= 2);
  if (first) verdict.bits(*first);
}

}  // namespace rvelab::stress_test
