// What must be refused, and that a refusal changes not one bit. Messages name what was found, what is allowed and, of
// an increment, what to do.
#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

Specimen lone_grain_of_default_limit(double spacing) {
  Specimen s = lone_grain(2, spacing);
  s.solver.min_height = 0;  // 2 r_max
  return s;
}

}  // namespace

TEST_CASE("A specimen without grains, materials or a contact normal, or of another dimension is refused", "[extreme]") {
  const auto refused = [](auto spoil) {  // single fields: tests/io/test_specimen_check.cpp
    Specimen s = triangular(4, 2, 1.95);
    spoil(s);
    return error_text<InputError>([&] { Rve{s}; });
  };
  CHECK(contains(refused([](Specimen& s) { s.grains = {}; }), "0 grains"));
  CHECK(contains(refused([](Specimen& s) { s.cell.dimension = 3; }), "dimension = 3"));
  CHECK(contains(refused([](Specimen& s) { s.materials.clear(); }), "materials: none given"));
  CHECK_FALSE(refused([](Specimen& s) { s.grains.position[1] = s.grains.position[0]; }).empty());
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
