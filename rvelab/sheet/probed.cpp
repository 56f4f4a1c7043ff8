#include "rvelab/sheet/probed.hpp"

#include <cmath>

#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::sheet {
namespace {

/// Pressure that an isotropic stage, or the last point of a pressure path, brings the grains to; NaN of other stages.
double pressure_after(const protocol::Stage& stage) {
  if (const auto* isotropic = protocol::settings_of<protocol::IsotropicStage>(stage)) return isotropic->pressure;
  const auto* path = protocol::settings_of<protocol::PressurePathStage>(stage);
  return path != nullptr && !path->pressures.empty() ? path->pressures.back() : unknown;
}

void add_probes_of(const Test& test, std::vector<Probed>& all) {
  std::size_t made = 0;
  double pressure = unknown;
  for (std::size_t stage = 0; stage < test.protocol.stages.size() && made < test.result.probes.size(); ++stage) {
    const protocol::Stage& own = test.protocol.stages[stage];
    if (const double after = pressure_after(own); std::isfinite(after)) pressure = after;
    if (own.kind != "probe") {
      // A stage that shears: what is probed afterwards is not at isotropic stress.
      if (own.kind != "isotropic" && own.kind != "pressure_path" && own.kind != "relax") return;
      continue;
    }
    const Eigen::MatrixXd& stiffness = test.result.probes[made++].stiffness;
    Probed probed{&test, stiffness.diagonal().tail(stiffness.rows() - test.dimension).mean(), pressure, pressure,
                  test.void_ratio};
    for (const records::Record& record : test.result.records) {
      if (std::size_t(record.stage) >= stage) break;
      probed.p = mean_pressure(record.stress, test.dimension);
      if ((record.quantities & records::asked<records::VoidRatio>) != 0) probed.void_ratio = record.void_ratio;
    }
    all.push_back(probed);
  }
}

}  // namespace

std::vector<Probed> probed_moduli(const std::vector<Test>& tests) {
  std::vector<Probed> all;
  for (const Test& test : tests) add_probes_of(test, all);
  return all;
}

}  // namespace rvelab::sheet
