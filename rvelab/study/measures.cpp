#include "rvelab/study/measures.hpp"

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/error.hpp"

namespace rvelab::study {

namespace {

/// Half of the window around the peak that the dilation is taken over.
constexpr double dilation_window = 0.005;

/// The secant stiffness is that up to this driving strain.
constexpr double secant_strain = 1e-3;

double peak_friction_angle(const records::TestResult& test, int dimension) {
  const auto records = calibrate::last_stage(test);
  return records.empty() ? no_value : calibrate::friction_angle_deg(calibrate::peak(records, dimension).stresses);
}

/// Slope of ln det F, expansion positive, over the size of the driving strain: least squares around the peak.
double dilation_at_peak(const records::TestResult& test, int dimension) {
  const auto records = calibrate::last_stage(test);
  if (records.empty()) return no_value;
  const double middle = calibrate::peak(records, dimension).strain;
  double count = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const records::Record& record : records) {
    const double strain = std::abs(record.strain), volume = record.deformation_gradient.determinant();
    if (std::abs(record.strain - middle) > dilation_window || !(volume > 0)) continue;
    const double expansion = std::log(volume);
    count += 1;
    x += strain;
    y += expansion;
    xx += strain * strain;
    xy += strain * expansion;
  }
  const double spread = count * xx - x * x;
  return count < 3 || !(spread > 0) ? no_value : (count * xy - x * y) / spread;
}

double void_ratio_at_end(const records::TestResult& test, int) {
  if (test.records.empty() || (test.records.back().quantities & records::asked<records::VoidRatio>) == 0)
    return no_value;
  return test.records.back().void_ratio;
}

/// Change of sigma_1 - sigma_3 from the start of the last stage to secant_strain, straight between records, over it.
double small_strain_stiffness(const records::TestResult& test, int dimension) {
  const auto records = calibrate::last_stage(test);
  const auto difference = [&](const records::Record& record) {
    return 2 * calibrate::principal_stresses(record.stress, dimension).t();
  };
  for (std::size_t k = 1; k < records.size(); ++k) {
    const double before = std::abs(records[k - 1].strain), strain = std::abs(records[k].strain);
    if (strain < secant_strain * (1 - 1e-9) || !(strain > before)) continue;
    const double part = (secant_strain - before) / (strain - before);
    const double at = (1 - part) * difference(records[k - 1]) + part * difference(records[k]);
    return (at - difference(records.front())) / secant_strain;
  }
  return no_value;
}

}  // namespace

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all{
      {"peak_friction_angle_deg", "degrees", "of the largest sigma_1 - sigma_3 of the last stage", peak_friction_angle},
      {"dilation_at_peak", "1", "slope of ln det F over the driving strain within 0.5 % of the peak", dilation_at_peak},
      {"end_void_ratio", "1", "void ratio of the last record", void_ratio_at_end},
      {"small_strain_stiffness_Pa", "Pa", "secant of sigma_1 - sigma_3 to 0.1 % of the last stage's driving strain",
       small_strain_stiffness},
  };
  return all;
}

Specimen perturbed(Specimen specimen, std::uint64_t repeat) {
  if (repeat <= 1) return specimen;
  constexpr double size = 1e-10;
  std::mt19937_64 generator(repeat);
  // The upper 53 bits, so that the numbers do not depend on the library: -1 to 1.
  const auto uniform = [&] { return 2 * double(generator() >> 11) / 9007199254740992.0 - 1; };
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
  piece.columns["grain_steps"] = {double(run.result.grain_steps)};
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
