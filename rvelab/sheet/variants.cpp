// The tests of a plan as protocols, one for each pressure and amplitude. Declared in plan.hpp.
#include <algorithm>
#include <filesystem>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/sheet/plan.hpp"

namespace rvelab::sheet {
namespace {

/// The stage that goes to and fro, and what drives it.
struct CyclicStage {
  std::string name;
  bool simple_shear = false, stress_controlled = false;
};

/// InputError if the protocol has none.
CyclicStage cyclic_stage(const PlanTest& test, const protocol::Protocol& protocol) {
  for (const protocol::Stage& stage : protocol.stages) {
    const auto* const compression = protocol::settings_of<protocol::CompressionStage>(stage);
    const auto* const shear = protocol::settings_of<protocol::SimpleShearStage>(stage);
    if ((compression != nullptr && compression->cycles.count > 0) || (shear != nullptr && shear->cycles.count > 0))
      return {stage.name, shear != nullptr, (shear != nullptr ? shear->cycles : compression->cycles).reverse_at > 0};
  }
  throw InputError(
      "test." + test.name + ": " + protocol.path +
      " has no stage of compression or simple_shear with cycles, which its amplitudes are of; allowed: one "
      "with stage.NAME.cycles > 0, such as cyclic_shear; name another protocol or another purpose");
}

/// Whether nothing but one axis moves.
bool is_oedometric(const protocol::Stage& stage) {
  if (const auto* const compression = protocol::settings_of<protocol::CompressionStage>(stage))
    return compression->lateral == protocol::CompressionStage::Lateral::zero_strain;
  const auto* const path = protocol::settings_of<protocol::PathStage>(stage);
  if (path == nullptr) return false;
  Matrix3 named = Matrix3::Zero();
  for (const protocol::PathRow& row : path->rows)
    if (row.in_stress() || !row.to.empty()) named += row.strain.cwiseAbs() + row.stress.cwiseAbs();
  return (named.array() != 0).count() == 1 && !named.diagonal().isZero(0);
}

/// InputError unless the protocol ends with a stage that gives what the purpose asks for.
void expect_purpose(const PlanTest& test, const protocol::Protocol& protocol) {
  using protocol::CompressionStage, protocol::SimpleShearStage;
  const auto* const compression = protocol::settings_of<CompressionStage>(protocol.stages.back());
  const auto* const shear = protocol::settings_of<SimpleShearStage>(protocol.stages.back());
  const auto refuse = [&](const std::string& what, const std::string& such_as) {
    throw InputError("test." + test.name + ": " + protocol.path + " does not end with " + what +
                     ", which its purpose asks for; allowed: a protocol that does, such as " + such_as +
                     "; name one, or another purpose");
  };
  const auto lateral_is = [&](CompressionStage::Lateral lateral) {
    return compression != nullptr && compression->lateral == lateral;
  };
  const bool cycles = compression != nullptr && compression->cycles.count > 0;
  if (test.purpose == Purpose::drained && !lateral_is(CompressionStage::Lateral::constant_stress))
    refuse("a compression at constant lateral stress", "triaxial");
  if (test.purpose == Purpose::drained && (!(compression->to_strain > 0) || cycles))
    refuse("a compression in one direction, to_strain > 0 without cycles", "triaxial");
  if (test.purpose == Purpose::oedometer && !is_oedometric(protocol.stages.back()))
    refuse("a stage that moves one axis alone", "oedometer_unloading");
  if (test.purpose == Purpose::undrained && !lateral_is(CompressionStage::Lateral::constant_volume))
    refuse("a compression at constant volume", "triaxial_undrained");
  if (test.purpose == Purpose::undrained && (!(compression->to_strain > 0) || cycles))
    refuse("a compression in one direction, to_strain > 0 without cycles", "triaxial_undrained");
  if (test.purpose == Purpose::undrained_shear &&
      (shear == nullptr || shear->normal != SimpleShearStage::Normal::constant_volume || shear->cycles.count > 0))
    refuse("simple shear at constant volume, without cycles", "simple_shear_undrained");
  if (test.purpose == Purpose::isotropic &&
      std::none_of(protocol.stages.begin(), protocol.stages.end(),
                   [](const protocol::Stage& stage) { return stage.kind == "probe"; }))
    throw InputError("test." + test.name + ": " + protocol.path +
                     " has no stage of kind = \"probe\", which its purpose asks for; allowed: a protocol with probes, "
                     "such as isotropic_probes; name one");
}

/// The protocol with settings of the test; an InputError names the test.
protocol::Protocol protocol_of(const PlanTest& test, const std::string& path,
                               const std::vector<std::string>& settings) {
  try {
    return protocol::read_protocol(path, settings);
  } catch (const InputError& error) {
    throw InputError("test." + test.name + ": " + error.what());
  }
}

/// One variant: the protocol with pressure and amplitude.
TestVariant variant(const Plan& plan, std::size_t row, const std::string& path, double pressure, double amplitude) {
  const PlanTest& test = plan.tests[row];
  TestVariant made{row, pressure, amplitude, {}, test.name, ""};
  std::vector<std::string> settings = test.settings;
  if (pressure > 0) {
    if (!protocol_of(test, path, test.settings).uses_pressure)
      throw InputError("test." + test.name + ".pressures_Pa: no stage of " + path +
                       " takes its pressure from test.pressure_Pa; allowed: a protocol in which one does; remove "
                       "pressures_Pa, or the pressures of its stages");
    settings.push_back("test.pressure_Pa=" + io::exact(pressure));
    made.suffix += "_" + in_words(pressure / 1000) + "kPa";
  }
  made.protocol = protocol_of(test, path, settings);
  if (!(made.pressure > 0)) made.pressure = made.protocol.pressure;
  if (amplitude > 0) {
    made.suffix += "_" + in_words(amplitude);
    const CyclicStage stage = cyclic_stage(test, made.protocol);
    const std::string key = "stage." + stage.name + ".";
    if (test.purpose == Purpose::cyclic_strain) {
      if (!stage.simple_shear || stage.stress_controlled)
        throw InputError("test." + test.name + ": the cycles of " + path + " are " +
                         (stage.simple_shear ? "turned by a stress, reverse_at_Pa" : "of a compression") +
                         ", and purpose = \"cyclic_strain\" reads simple shear between strains; allowed: such a "
                         "protocol, such as cyclic_shear; name one, or another purpose");
      settings.push_back(key + "to_strain=" + io::exact(amplitude));
      settings.push_back(key + "record_every=" + io::exact(amplitude / double(test.records_per_amplitude)));
    } else {
      const double stress = (stage.simple_shear ? 1 : 2) * amplitude * made.pressure;
      settings.push_back(key + "reverse_at_Pa=" + io::exact(stress));
    }
    made.protocol = protocol_of(test, path, settings);
  }
  expect_purpose(test, made.protocol);
  return made;
}

std::string name_of(const std::string& path) { return std::filesystem::path(path).stem().string(); }

}  // namespace

std::string TestVariant::name_with(const std::string& density, std::size_t number) const {
  return name + "_" + density + suffix + "_s" + std::to_string(number + 1);
}

std::vector<TestVariant> variants_of(const Plan& plan, int dimension, std::vector<std::string>& remarks) {
  std::vector<TestVariant> variants;
  std::vector<std::string> left_out(purpose_names().size());  // why, of each purpose
  std::vector<bool> served(left_out.size(), false);
  for (std::size_t row = 0; row < plan.tests.size(); ++row) {
    const PlanTest& test = plan.tests[row];
    const auto purpose = std::size_t(test.purpose);
    const bool plane = dimension == 2 && !test.protocol_2D.empty();
    const std::string& path = plane ? test.protocol_2D : test.protocol;
    if (const int its = protocol_of(test, path, test.settings).dimension; its != 0 && its != dimension) {
      left_out[purpose] =
          test.name + " is left out: " + name_of(path) + " is a test in " +
          (its == 3 ? "space, and the grains are in the plane" : "the plane, and the grains are in space");
      continue;
    }
    served[purpose] = true;
    if (plane && path != test.protocol)
      remarks.push_back(test.name + " is " + name_of(path) + " in the place of " + name_of(test.protocol) +
                        ", since the grains are in the plane");
    const std::vector<double> none{unknown};
    for (const double pressure : test.pressures.empty() ? none : test.pressures)
      for (const double amplitude : test.amplitudes.empty() ? none : test.amplitudes)
        variants.push_back(variant(plan, row, path, pressure, amplitude));
  }
  for (std::size_t purpose = 0; purpose < served.size(); ++purpose)
    if (!served[purpose] && !left_out[purpose].empty()) remarks.push_back(left_out[purpose]);
  if (variants.empty())
    throw InputError(plan.path + ": every test is left out for grains in " + (dimension == 2 ? "the plane" : "space") +
                     "; allowed: one protocol or more of their dimension; give protocol_2D, or another plan");
  return variants;
}

bool goes_through(const Plan& plan, const PlanTest& test, const std::string& density, std::size_t number) {
  if (test.seeds && number >= std::size_t(*test.seeds)) return false;
  const auto named = [&](const PlanDensity& each) { return each.name == density; };
  if (test.densities.empty() || std::none_of(plan.densities.begin(), plan.densities.end(), named)) return true;
  return std::find(test.densities.begin(), test.densities.end(), density) != test.densities.end();
}

}  // namespace rvelab::sheet
