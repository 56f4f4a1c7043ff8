// Small studies for tests: an anchored crystal of discs under constant-volume shear, a few tens of grains.
#pragma once

#include <string>

#include "rvelab/study/run_study.hpp"
#include "tests/specimens.hpp"

namespace rvelab::test {

inline const std::string shear_text = R"([test]
name = "shear"
[[stage]]
kind = "simple_shear"
to_strain = 0.004
record_every = 0.0005
)";

inline Specimen few_discs(std::uint64_t seed = 1) {
  Specimen specimen = disordered(Shape::disc, 6, linear_material(1e6, 5e5, 0.4), Law::linear_stiffness, 0.52, seed);
  Rve rve(specimen);
  rve.relax(1e-6, 100'000);
  rve.take_as_reference();
  return rve.specimen();
}

inline study::Study small_study() {
  study::Study study;
  study.protocol_text = shear_text;
  study.specimens = {"S.h5"};
  study.grid = {{"solver.target_unbalanced", {"1e-3", "1e-6"}}};
  study.reference = {"solver.fixed_substeps=1000"};
  study.repeats = 2;
  study.increments = 6;
  return study;
}

inline study::Pieces run_all_of(const study::Study& study, const Specimen& specimen, study::Keeper keeper = {}) {
  return study::run_study(study, study::prepared(study, "test.toml", {specimen}), keeper);
}

}  // namespace rvelab::test
