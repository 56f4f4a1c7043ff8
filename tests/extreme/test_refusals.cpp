// What must be refused, and that a refusal changes not one bit. Messages name what was found, what is allowed and, of
// an increment, what to do.
#include <functional>
#include <limits>

#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A loaded specimen with slip in its history, so that there is state to spoil.
Rve loaded(int dimension) {
  Rve rve(dimension == 2 ? triangular(4, 2, 1.95, material(stiffness, 0.5 * stiffness, 0.3))
                         : lone_grain(3, 1.95, material(stiffness, 0.5 * stiffness, 0.3)));
  rve.apply(entry(0, dimension - 1, 1e-3), 0);
  return rve;
}

Specimen lone_grain_of_default_limit(double spacing) {
  Specimen s = lone_grain(2, spacing);
  s.solver.min_height = 0;  // 2 r_max
  return s;
}

}  // namespace

TEST_CASE("NaN in a specimen is refused with the grain's name", "[extreme]") {
  const Specimen good = triangular(4, 2, 1.95);
  for (const double bad : {not_a_number, infinity, -infinity}) {
    const auto refused = [&](auto spoil) {
      Specimen s = good;
      spoil(s);
      return error_text<InputError>([&] { Rve rve(s); });
    };
    CHECK(contains(refused([&](Specimen& s) { s.grains.position[5][1] = bad; }), "grain 6"));
    CHECK(contains(refused([&](Specimen& s) { s.grains.velocity[5][0] = bad; }), "grain 6"));
    CHECK(contains(refused([&](Specimen& s) { s.grains.spin[5][2] = bad; }), "grain 6"));
    CHECK(contains(refused([&](Specimen& s) { s.grains.radius[5] = bad; }), "grains/radius_m[5] of grain 6 = "));
    CHECK(contains(refused([&](Specimen& s) { s.cell.lattice(0, 1) = bad; }), "lattice"));
    CHECK(contains(refused([&](Specimen& s) { s.cell.lattice(2, 2) = bad; }), "lattice"));
    CHECK(contains(refused([&](Specimen& s) { s.cell.rotation(1, 0) = bad; }), "rotation"));
    CHECK(contains(refused([&](Specimen& s) { s.materials[0].density = bad; }), "density"));
    CHECK(contains(refused([&](Specimen& s) { s.materials[0].normal_stiffness = bad; }), "normal_stiffness"));
    CHECK(contains(refused([&](Specimen& s) {
                     s.contacts = {{0, 1, {}, {bad, 0, 0}, {0, 0, 0}, 0}};
                   }),
                   "contacts/tangential_force_N[0, 0] = "));
  }
}

TEST_CASE("A specimen that is none is refused", "[extreme]") {
  const Specimen good = triangular(4, 2, 1.95);
  const auto refused = [&](auto spoil) {
    Specimen s = good;
    spoil(s);
    return error_text<InputError>([&] { Rve rve(s); });
  };
  CHECK(contains(refused([](Specimen& s) { s.grains = {}; }), "0 grains"));
  CHECK(contains(refused([](Specimen& s) { s.grains.radius[3] = 0; }),
                 "grains/radius_m[3] of grain 4 = 0 is out of range; allowed: > 0 m"));
  CHECK(contains(refused([](Specimen& s) { s.grains.radius[3] = -1; }),
                 "grains/radius_m[3] of grain 4 = -1 is out of range; allowed: > 0 m"));
  CHECK(contains(refused([](Specimen& s) { s.grains.radius.pop_back(); }), "grains/radius_m has 15 rows; allowed: 16"));
  CHECK(contains(refused([](Specimen& s) { s.grains.id[3] = 2; }), "ids must ascend"));
  CHECK(contains(refused([](Specimen& s) { s.grains.material[3] = 1; }), "grains/material[3] of grain 4 = 1"));
  CHECK(contains(refused([](Specimen& s) { s.cell.lattice(1, 0) = 0.1; }), "upper triangular"));
  CHECK(contains(refused([](Specimen& s) { s.cell.lattice(1, 1) = 0; }), "positive diagonal"));
  CHECK(contains(refused([](Specimen& s) { s.cell.dimension = 3; }), "dimension = 3"));
  CHECK(contains(refused([](Specimen& s) { s.cell.rotation *= 1.01; }), "rotation"));
  CHECK(contains(refused([](Specimen& s) { s.contacts = {{0, 16, {}, {}, {}, 0}}; }), "0 <= i <= j < 16"));
  CHECK(contains(refused([](Specimen& s) { s.materials.clear(); }), "materials: none given"));
  // Two grains at one place have no contact normal.
  CHECK_FALSE(refused([](Specimen& s) { s.grains.position[1] = s.grains.position[0]; }).empty());
}

TEST_CASE("A parameter out of range stops the opening with its key, value and range", "[extreme]") {
  struct Case {
    std::string key, value, range;
    std::function<void(Specimen&)> spoil;
  };
  const std::vector<Case> cases = {
      {"materials/density_kg_m3[0] of material \"grain\"", "-1", "1e-50 to 1e+50 kg/m^3",
       [](Specimen& s) { s.materials[0].density = -1; }},
      {"materials/normal_stiffness[0] of material \"grain\"", "0", "> 0 N/m",
       [](Specimen& s) { s.materials[0].normal_stiffness = 0; }},
      {"materials/friction[0] of material \"grain\"", "-0.5", "0 to 1e+06",
       [](Specimen& s) { s.materials[0].friction = -0.5; }},
      {"damping/local", "1", "0 to below 1", [](Specimen& s) { s.damping.local = 1; }},
      {"damping/local_quasi_static", "0", "above 0 to below 1", [](Specimen& s) { s.damping.local_quasi_static = 0; }},
      {"solver/skin", "0", "above 0 to 10", [](Specimen& s) { s.solver.skin = 0; }},
      {"solver/time_step_factor", "1", "above 0 to below 1", [](Specimen& s) { s.solver.time_step_factor = 1; }},
      {"solver/time_step_factor", "0", "above 0 to below 1", [](Specimen& s) { s.solver.time_step_factor = 0; }},
      {"solver/fixed_time_step_s", "-1e-06", ">= 0 s", [](Specimen& s) { s.solver.fixed_time_step = -1e-6; }},
      {"solver/relative_tolerance", "0", "above 0 to 1", [](Specimen& s) { s.solver.relative_tolerance = 0; }},
      {"solver/absolute_tolerance", "2", "above 0 to 1", [](Specimen& s) { s.solver.absolute_tolerance = 2; }},
      {"solver/target_unbalanced", "-1", ">= 0", [](Specimen& s) { s.solver.target_unbalanced = -1; }},
      {"solver/fixed_substeps", "-1", ">= 0", [](Specimen& s) { s.solver.fixed_substeps = -1; }},
      {"solver/max_substeps", "0", "> 0", [](Specimen& s) { s.solver.max_substeps = 0; }},
      {"solver/min_height_m", "-1", ">= 0 m", [](Specimen& s) { s.solver.min_height = -1; }},
      {"solver/max_overlap_ratio", "0", "> 0", [](Specimen& s) { s.solver.max_overlap_ratio = 0; }},
      {"solver/skin", "nan", "above 0 to 10", [](Specimen& s) { s.solver.skin = not_a_number; }},
      {"solver/max_overlap_ratio", "nan", "> 0", [](Specimen& s) { s.solver.max_overlap_ratio = not_a_number; }}};
  for (const Case& one : cases) {
    Specimen s = triangular(4, 2, 1.95);
    one.spoil(s);
    const std::string text = error_text<InputError>([&] { Rve rve(s); });
    CAPTURE(one.key, text);
    CHECK(contains(text, one.key + " = " + one.value));
    CHECK(contains(text, "allowed: " + one.range));
  }
}

TEST_CASE("Compression until grains overlap by a quarter is refused and changes nothing", "[extreme]") {
  for (const double dt : {0.0, 0.05}) {
    Rve rve(triangular(4, 2, 1.95));
    const auto before = rve.save();
    // Spacing l: overlap over radius is 2 - l; l = 1.75 is reached at a strain of -0.1026.
    const std::string text = error_text<IncrementFailed>([&] { rve.apply(isotropic(2, -0.11), dt); });
    CAPTURE(dt, text);
    CHECK(contains(text, "max_overlap_ratio allows 0.25"));
    CHECK(contains(text, "compress less"));
    CHECK((rve.save() == before));
    const Matrix3 stress = rve.apply(isotropic(2, -0.10), dt).stress;
    const double spacing = 1.95 * 0.9;
    const double pressure = std::sqrt(3.0) * stiffness * (2 / spacing - 1) /
                            0.5;  // a triangular lattice (tests/oracle/test_crystals.cpp), per thickness 0.5 m
    CHECK(mean_pressure(stress, 2) == Approx(pressure).epsilon(1e-9));
  }
}

TEST_CASE("A cell that becomes too slender is refused with vector, limit and remedy", "[extreme]") {
  // Pure shear of an axis-aligned cell of one grain: b, 4 m long, falls below 2 r_max = 2 m as a grows.
  for (const double dt : {0.0, 0.5}) {
    Rve rve(lone_grain_of_default_limit(4.0));
    const auto before = rve.save();
    const double squeeze = 0.495;
    const Matrix3 gradient = Vector3(1 / squeeze - 1, squeeze - 1, 0).asDiagonal();
    const std::string text = error_text<IncrementFailed>([&] { rve.apply(gradient, dt); });
    CAPTURE(dt, text);
    CHECK((rve.save() == before));
    CHECK(contains(text, "shortest lattice vector is 1.9"));
    CHECK(contains(text, "solver.min_height_m is 2 m"));
    CHECK(contains(text, "oriented cell"));
  }
  // The same limit holds for what is opened.
  CHECK(contains(error_text<InputError>([] { Rve rve(lone_grain_of_default_limit(1.95)); }),
                 "shortest lattice vector is 1.95 m"));
}

TEST_CASE("An increment beyond the allowed number of sub-steps is refused and changes nothing", "[extreme]") {
  Specimen s = triangular(4, 2, 1.95);
  s.solver.max_substeps = 1000;
  Rve rve(s);
  rve.apply(entry(0, 1, 1e-6), 0);
  const auto before = rve.save();
  CHECK(contains(error_text<IncrementFailed>([&] { rve.apply(entry(0, 1, 1e-6), 1e6); }), "max_substeps"));
  CHECK((rve.save() == before));
}

TEST_CASE("A damaged snapshot is refused and changes nothing", "[extreme]") {
  Rve rve = loaded(2);
  const auto before = rve.save();
  for (const std::size_t at : {std::size_t(0), std::size_t(9), before.size() / 2, before.size() - 1}) {
    auto damaged = before;
    damaged[at] ^= std::byte{1};
    CHECK_FALSE(error_text<InputError>([&] { rve.restore(damaged); }).empty());
  }
  for (const std::size_t length : {std::size_t(0), std::size_t(7), std::size_t(15), before.size() - 1})
    CHECK_FALSE(error_text<InputError>([&] { rve.restore(std::span(before).first(length)); }).empty());
  CHECK((rve.save() == before));
}
