#include "rvelab/study/whole_path.hpp"

#include <random>

#include "rvelab/error.hpp"
#include "rvelab/study/measures.hpp"
#include "rvelab/study/processor_time.hpp"

namespace rvelab::study {

Specimen perturbed(Specimen specimen, std::uint64_t repeat) {
  if (repeat <= 1) return specimen;
  constexpr double size = 1e-10;
  std::mt19937_64 generator(repeat);
  // The upper 53 bits, so that the numbers do not depend on the library: -1 to 1.
  const auto uniform = [&] { return 2 * static_cast<double>(generator() >> 11) / 9007199254740992.0 - 1; };
  for (std::size_t k = 0; k < specimen.grains.size(); ++k) {
    for (int i = 0; i < specimen.cell.dimension; ++i) {
      specimen.grains.position[k][i] += size * specimen.grains.radius[k] * uniform();
    }
  }
  return specimen;
}

Piece measured_path(const protocol::TestRun& run, double seconds) {
  Piece piece;
  for (const Measure& measure : measures()) {
    piece.columns[measure.name] = {measure.of(run.result, run.end_state.cell.dimension)};
  }
  piece.columns["seconds"] = {seconds};
  piece.columns["grain_steps"] = {static_cast<double>(run.result.grain_steps)};
  return piece;
}

Piece whole_path(const protocol::Protocol& protocol, const Specimen& specimen, const protocol::Watch& watch) {
  const double begin = processor_seconds();
  try {
    const protocol::TestRun run = protocol::run_protocol(protocol, specimen, watch);
    if (!run.complete) throw Interrupted();
    return measured_path(run, processor_seconds() - begin);
  } catch (const InputError&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& error) {
    Piece piece;
    for (const Measure& measure : measures()) piece.columns[measure.name] = {no_value};
    piece.columns["seconds"] = piece.columns["grain_steps"] = {no_value};
    piece.failure = error.what();
    return piece;
  }
}

}  // namespace rvelab::study
