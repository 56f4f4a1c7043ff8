#include "rvelab/study/increments.hpp"

#include <Eigen/LU>
#include <cmath>

#include "rvelab/measure/measures.hpp"
#include "rvelab/study/processor_time.hpp"

namespace rvelab::study {
namespace {

/// The state with the parameters of the specimen as it was given, and the settings over them.
Specimen opened(const Specimen& state, const Opening& opening) {
  Specimen specimen = state;
  specimen.materials = opening.specimen.materials;
  specimen.contact = opening.specimen.contact;
  specimen.damping = opening.specimen.damping;
  specimen.solver = opening.specimen.solver;
  return protocol::with_overrides(opening.protocol, std::move(specimen));
}

/// Straight in F, in equal parts.
Made applied(Rve& rve, const PathState& from, long parts) {
  const Matrix3 identity = Matrix3::Identity();
  const auto at = [&](long part) -> Matrix3 {
    return identity + static_cast<double>(part) / static_cast<double>(parts) * from.displacement_gradient;
  };
  const double time = from.time / static_cast<double>(parts);
  const std::uint64_t grain_steps = rve.grain_steps();
  Made made;
  for (long part = 1; part <= parts; ++part) {
    const Matrix3 gradient =
        parts == 1 ? from.displacement_gradient : Matrix3(at(part) * at(part - 1).inverse() - identity);
    const double begin = processor_seconds();
    const Response response = rve.apply(gradient, time);
    made.seconds += processor_seconds() - begin;
    made.stress = response.stress;
    made.estimate = time == 0 ? response.report.error_estimate : no_value;
    made.allowed = time == 0 ? response.report.allowed_error : no_value;
  }
  made.grain_steps = static_cast<double>(rve.grain_steps() - grain_steps);
  return made;
}

}  // namespace

Made made_increment(const PathState& from, const Opening& opening) {
  Rve rve(opened(from.state, opening));
  rve.watch(opening.stop);
  return applied(rve, from, opening.parts);
}

Answer reference_answer(const PathState& from, const Opening& opening, const Relaxation& relaxation) {
  const Specimen specimen = opened(from.state, opening);
  Rve rve(specimen);
  rve.watch(opening.stop);
  const Matrix3 start = rve.stress();
  Answer answer;
  answer.made = applied(rve, from, opening.parts);
  if (from.time == 0) answer.at_rest = rve.relax(relaxation.unbalanced, relaxation.max_steps).target_held;
  answer.stress = rve.stress();
  answer.pressure = std::abs(mean_pressure(answer.stress, specimen.cell.dimension));
  answer.increment = (answer.stress - start).norm();
  return answer;
}

}  // namespace rvelab::study
