// A host of vumat_, as Abaqus/Explicit calls it in double and single precision, beside the same increments through
// rvelab.h.
//
//     vumat_host CASE FOLDER     in FOLDER: discs.h5, spheres.h5, rvelab_umat.toml, as tests/adapters/test_umat.cpp
//     makes them
#include "tools/umat/vumat.hpp"

#include <rvelab/rvelab.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "tools/umat/kinematics.hpp"

namespace {

using umat::Matrix3;

int failures = 0;
#define CHECK(condition)                                                                      \
  do {                                                                                        \
    if (!(condition)) ++failures, std::cerr << __LINE__ << ": not true: " #condition << "\n"; \
  } while (0)

void done(std::int32_t status) {
  if (status >= RVELAB_OK) return;
  std::cerr << rvelab_last_error() << "\n";
  std::exit(1);
}

/// One RVE through the C interface.
struct Reference {
  rvelab_pool* pool = nullptr;
  std::int64_t id = 0;
  /// most: of sub-steps; 0: the default
  explicit Reference(const char* specimen, std::int64_t most = 0) {
    std::int64_t number = 0;
    rvelab_pool_def def;
    done(rvelab_pool_def_init(&def, sizeof def));
    if (most > 0) def.max_substeps = most;
    done(rvelab_pool_create(&def, &pool));
    done(rvelab_template_load(pool, specimen, &number));
    done(rvelab_spawn(pool, number, 1, &id));
  }
  Matrix3 apply(const Matrix3& dH) const {
    const umat::RowMajor3 gradient = dH;
    umat::RowMajor3 sigma;
    done(rvelab_apply(pool, id, gradient.data(), 0, sigma.data()));
    return sigma;
  }
};

constexpr int axis[9][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}};

/// A block of points as the host keeps it, in its precision.
template <class Real>
struct Host {
  static constexpr int own = sizeof(Real) == sizeof(double) ? 2 : 6;  ///< state variables of the library
  int points, shear, states = own + 1, nprops = 1, anneal = 0;
  std::vector<Real> props{1}, F0, F1, strain, stress, state, energy, inelastic, density;
  Real step_time = 1, total_time = 1, dt = Real(1e-3);

  Host(int points, int shear) : points(points), shear(shear) {
    const std::size_t n = std::size_t(points);
    F0.assign(n * 9, 0);
    strain.assign(n * 6, 0);
    stress.assign(n * 6, 0);
    state.assign(n * std::size_t(states), 0);
    energy.assign(n, 0);
    inelastic.assign(n, 0);
    density.assign(n, 2000);
    for (int k = 0; k < points; ++k) set(F0, k, Matrix3::Identity());
    F1 = F0;
    for (int k = 0; k < points; ++k) state[std::size_t(k + own * points)] = 7;  // of the user, not ours
  }
  /// As the host sees it.
  static Matrix3 rounded(const Matrix3& F) { return F.cast<Real>().template cast<double>(); }
  void set(std::vector<Real>& F, int point, const Matrix3& value) const {
    const int plane[5][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 0}};
    for (int k = 0; k < (shear == 1 ? 5 : 9); ++k) {
      const int* at = shear == 1 ? plane[k] : axis[k];
      F[std::size_t(point + points * k)] = Real(value(at[0], at[1]));
    }
  }
  void set_symmetric(std::vector<Real>& tensor, int point, const Matrix3& value) const {
    for (int k = 0; k < 3 + shear; ++k) tensor[std::size_t(point + points * k)] = Real(value(axis[k][0], axis[k][1]));
  }
  Matrix3 stress_of(int point) const {
    Matrix3 sigma = Matrix3::Zero();
    for (int k = 0; k < 3 + shear; ++k)
      sigma(axis[k][0], axis[k][1]) = sigma(axis[k][1], axis[k][0]) = stress[std::size_t(point + points * k)];
    return sigma;
  }
  /// Id and token, without the variable of the user.
  std::vector<Real> state_of(int point) const {
    std::vector<Real> found;
    for (int k = 0; k < own; ++k) found.push_back(state[std::size_t(point + points * k)]);
    return found;
  }
  void call() {
    const int direct = 3, fields = 0;
    std::vector<Real> stress_new(stress.size()), state_new(state.size()), energy_new(energy), inelastic_new(energy);
    const auto in = [](const auto& values) { return reinterpret_cast<const double*>(values.data()); };
    const auto one = [](const Real& value) { return reinterpret_cast<const double*>(&value); };
    const auto out = [](auto& values) { return reinterpret_cast<double*>(values.data()); };
    umat::vumat_(&points, &direct, &shear, &states, &fields, &nprops, &anneal, one(step_time), one(total_time), one(dt),
                 "GRANULAR", nullptr, nullptr, in(props), in(density), in(strain), nullptr, nullptr, nullptr, in(F0),
                 nullptr, in(stress), in(state), in(energy), in(inelastic), nullptr, nullptr, in(F1), nullptr,
                 out(stress_new), out(state_new), out(energy_new), out(inelastic_new));
    stress = stress_new;
    state = state_new;
    energy = energy_new;
    F0 = F1;
  }
};

Matrix3 symmetric_part(const Matrix3& sigma) { return 0.5 * (sigma + sigma.transpose()); }

/// As far as the host's precision goes.
template <class Real>
bool same_bits(const Matrix3& a, const Matrix3& b) {
  const Matrix3 seen = Host<Real>::rounded(b);
  return std::memcmp(a.data(), seen.data(), sizeof(double) * 9) == 0;
}

std::string log_text() {
  std::ostringstream text;
  text << std::ifstream("rvelab_umat.log").rdbuf();
  return text.str();
}

/// Biaxial compression of three points, one of them left at rest: the stress bits are those of the C interface.
template <class Real>
void biaxial(const char* specimen, int material, int shear) {
  Host<Real> host(3, shear);
  host.props[0] = Real(material);
  const Reference moved(specimen), resting(specimen);
  Matrix3 first = resting.apply(Matrix3::Zero());
  if (material != 6)  // its file says that it begins at zero
    for (int k = 0; k < 3; ++k) host.set_symmetric(host.stress, k, symmetric_part(first));
  Matrix3 F = Matrix3::Identity();
  double work = 0;
  for (int step = 1; step <= 8; ++step) {
    Matrix3 next = F, strain = Matrix3::Zero();
    next(1, 1) -= 2e-4;
    next(0, 0) += 1e-4;
    next = Host<Real>::rounded(next);
    strain(0, 0) = 1e-4, strain(1, 1) = -2e-4;
    const Matrix3 old = host.stress_of(0);
    for (int k = 0; k < 2; ++k) {
      host.set(host.F1, k, next);
      host.set_symmetric(host.strain, k, strain);
    }
    host.call();
    const Matrix3 sigma = symmetric_part(moved.apply(umat::increment(F, next)));
    CHECK(same_bits<Real>(host.stress_of(0), sigma));
    CHECK(same_bits<Real>(host.stress_of(1), sigma));
    CHECK(same_bits<Real>(host.stress_of(2), symmetric_part(resting.apply(Matrix3::Zero()))));
    work += 0.5 * (old + sigma).cwiseProduct(strain).sum() / 2000;
    F = next;
  }
  CHECK(host.stress_of(0)(1, 1) < 1.1 * first(1, 1));
  if (material != 6) CHECK(std::abs(host.energy[0] - work) <= (sizeof(Real) == 8 ? 1e-12 : 1e-5) * std::abs(work));
  CHECK(host.state_of(0) != host.state_of(1) && host.state_of(1) != host.state_of(2));  // each point its own RVE
  CHECK(host.state[std::size_t(3 * host.own)] == 7);

  // A copy of a point goes on from where it is; once both have gone on, one RVE cannot be two.
  for (int k = 0; k < host.own; ++k) host.state[std::size_t(1 + 3 * k)] = host.state[std::size_t(3 * k)];
  host.call();
  CHECK(std::isfinite(host.stress_of(0)(1, 1)));
  host.call();
  CHECK(std::isfinite(host.stress_of(0)(1, 1)) && std::isnan(host.stress_of(1)(1, 1)));
  CHECK(log_text().find("another point has the same state variables") != std::string::npos);
}

/// Shear turns the axes: the host gets R^T sigma R.
void shear() {
  Host<double> host(1, 1);
  const Reference of("discs.h5");
  host.set_symmetric(host.stress, 0, symmetric_part(Reference("discs.h5").apply(Matrix3::Zero())));
  Matrix3 F = Matrix3::Identity();
  for (int step = 1; step <= 6; ++step) {
    Matrix3 next = F;
    next(0, 1) += 1.0 / 8192;
    host.set(host.F1, 0, next);
    host.call();
    const Matrix3 sigma = symmetric_part(of.apply(umat::increment(F, next))), R = umat::rotation_of(next);
    CHECK((host.stress_of(0) - R.transpose() * sigma * R).norm() <= 1e-12 * sigma.norm());
    F = next;
  }
  CHECK(std::abs(host.stress_of(0)(0, 1)) > 1000);
}

/// Increments below the round-off of single precision: the gradient moves now and then, and holds them all.
void round_off() {
  Host<float> host(1, 1);
  const Reference of("discs.h5");
  host.set_symmetric(host.stress, 0, symmetric_part(Reference("discs.h5").apply(Matrix3::Zero())));
  Matrix3 F = Matrix3::Identity(), seen = F, strain = Matrix3::Zero();
  int still = 0;
  for (int step = 0; step < 12; ++step) {
    const double shear = step == 0 ? 1e-3 : 2e-11;
    F(0, 1) += shear;
    strain(0, 1) = strain(1, 0) = 0.5 * shear;
    host.set(host.F1, 0, F);
    host.set_symmetric(host.strain, 0, strain);
    host.call();
    const Matrix3 next = Host<float>::rounded(F), R = umat::rotation_of(next);
    const Matrix3 sigma = symmetric_part(of.apply(umat::increment(seen, next)));
    CHECK(same_bits<float>(host.stress_of(0), R.transpose() * sigma * R));
    still += next == seen;
    seen = next;
  }
  CHECK(still > 5 && still < 11);
}

/// The call before the first increment: elastic, and no RVE is made.
void elastic() {
  Host<double> host(2, 1);
  const Matrix3 first = symmetric_part(Reference("discs.h5").apply(Matrix3::Zero()));
  host.set_symmetric(host.stress, 1, first);  // the other has none yet
  host.step_time = host.total_time = 0;
  Matrix3 strain = Matrix3::Zero();
  strain(1, 1) = 1e-6;
  host.set_symmetric(host.strain, 0, strain);
  host.call();
  const Matrix3 stiff = host.stress_of(0) / 1e-6;
  CHECK(stiff(1, 1) > 1e6 && stiff(0, 0) > 0 && stiff(0, 0) < stiff(1, 1));
  CHECK(host.stress_of(1) == first);
  CHECK(host.state[0] == 0 && host.state[1] == 0);
}

/// An increment beyond what one step can hold is made in parts.
void parts() {
  Host<double> host(1, 1);
  host.set_symmetric(host.stress, 0, symmetric_part(Reference("discs.h5").apply(Matrix3::Zero())));
  Matrix3 next = Matrix3::Identity();
  next(0, 1) = 0.5;
  const umat::RowMajor3 whole = umat::increment(Matrix3::Identity(), next);
  const Reference of("discs.h5", 3000);  // as rvelab_umat.toml has it
  double sigma[9];
  CHECK(rvelab_apply(of.pool, of.id, whole.data(), 0, sigma) == RVELAB_DISCARD);
  host.set(host.F1, 0, next);
  host.call();
  CHECK(std::isfinite(host.stress_of(0)(0, 1)) && std::abs(host.stress_of(0)(0, 1)) > 1000);
  CHECK(log_text().empty());
}

/// What it cannot do is NaN, and one text in the log.
void refused() {
  const Matrix3 first = symmetric_part(Reference("discs.h5").apply(Matrix3::Zero()));
  const auto told = [&]<class Real>(Real, const std::string& words, auto spoil) {
    Host<Real> host(2, 1);
    for (int k = 0; k < 2; ++k) host.set_symmetric(host.stress, k, first);
    spoil(host);
    host.call();
    CHECK(std::isnan(host.stress_of(0)(1, 1)));
    if (log_text().find(words) == std::string::npos) std::cerr << words << " is not told\n", ++failures;
    return host;
  };
  told(0.0, "vumat, point 1 of a block: PROPS(1) is 9", [](auto& host) { host.props[0] = 9; });
  told(0.0f, "vumat, point 2 of a block: PROPS(1) is 8", [](auto& host) { host.props[0] = 8; });
  told(0.0f, "vumat, PROPS(1) is 1.5", [](auto& host) { host.props[0] = 1.5f; });
  told(0.0, "nstatev is 1; give 2", [](auto& host) { host.states = 1; });
  told(0.0f, "nstatev is 2; the job is in single precision: give 6 state variables (*DEPVAR)",
       [](auto& host) { host.states = 2; });
  told(0.0, "lanneal is 1; allowed: 0", [](auto& host) { host.anneal = 1; });
  const Host<double> other = told(0.0, "point 1 of a block: stressOld (11 22 33 12 13 23) of the first call is",
                                  [](auto& host) { host.stress[0] *= 2; });
  CHECK(other.stress_of(1)(1, 1) == first(1, 1));  // the other point goes on
  told(0.0, "write initial_stress = \"specimen\"", [](auto& host) { host.stress.assign(host.stress.size(), 0); });
  told(0.0, "stateOld(k,1) is 0.5", [](auto& host) { host.state[0] = 0.5; });
  told(0.0f, "stateOld(k,2) is 300000", [](auto& host) { host.state[2] = 300000; });
  told(0.0, "det of defgrad is -1", [](auto& host) { host.F1[0] = -1; });
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 || chdir(argv[2]) != 0) {
    std::cerr << "vumat_host discs|discs_single|spheres|spheres_single|shear|round_off|elastic|parts|refused FOLDER\n";
    return 2;
  }
  const std::string name = argv[1];
  if (name == "discs")
    biaxial<double>("discs.h5", 1, 1);
  else if (name == "discs_single")
    biaxial<float>("discs.h5", 1, 1);
  else if (name == "spheres")
    biaxial<double>("spheres.h5", 3, 3);
  else if (name == "spheres_single")
    biaxial<float>("spheres.h5", 6, 3);
  else if (name == "shear")
    shear();
  else if (name == "round_off")
    round_off();
  else if (name == "elastic")
    elastic();
  else if (name == "parts")
    parts();
  else if (name == "refused")
    refused();
  else
    return 2;
  if (failures > 0) std::cerr << log_text();
  return failures > 0;
}
