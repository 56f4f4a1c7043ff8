// The plan of a data sheet: specimens by density and seed, and the tests that each of them goes through. Read from a
// TOML file: [sheet], [[density]], [[test]].
#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

#include "rvelab/sheet/sheet.hpp"

namespace rvelab::sheet {

/// Names of purposes as plans write them, in the order of Purpose.
const std::vector<std::string>& purpose_names();

struct PlanDensity {
  std::string name;                        ///< in names of tests: letters, digits, - and _
  std::optional<double> relative_density;  ///< of the specimen, or
  std::optional<double> void_ratio;        ///< this; none: by the settings
  std::vector<std::string> settings;       ///< KEY=value of the recipe, of this density alone
};

struct PlanTest {
  std::string name;
  Purpose purpose = Purpose::drained;
  std::string protocol;                ///< path, or the name of an installed one
  std::string protocol_2D;             ///< in its place for grains in the plane; "": the same
  std::vector<std::string> densities;  ///< names; empty: all
  std::vector<double> pressures;       ///< Pa, of test.pressure_Pa; empty: that of the protocol
  std::vector<double> amplitudes;      ///< cycles: shear strain; or stress over pressure, of a triaxial test q/(2 p)
  long records_per_amplitude = 25;     ///< cyclic_strain: records on the way to the amplitude
  std::optional<long> seeds;           ///< on the first of the specimens only
  std::vector<std::string> settings;   ///< KEY=value of the protocol
};

struct Plan {
  std::string path;
  long seeds = 3;                     ///< specimens of a density
  std::optional<double> pressure;     ///< Pa, at which specimens are packed; none: that of the recipe
  std::vector<std::string> settings;  ///< KEY=value of the recipe
  std::vector<PlanDensity> densities;
  std::vector<PlanTest> tests;
  std::string resolved;  ///< with every default and assignment, TOML

  /// Settings of the recipe for the specimens of a density, those of pressure and density among them.
  std::vector<std::string> recipe_settings(const PlanDensity& density) const;
};

/// Whether an assignment "table.key=value" is of a plan, not of the recipe.
bool is_of_plan(const std::string& assignment);

/// Reads a plan after `assignments` ("sheet.seeds=2", "test.drained.pressures_Pa=[1e5]") have been applied. InputError
/// with every mistake and its line; `path` serves messages.
Plan read_plan(toml::table file, const std::string& path, const std::vector<std::string>& assignments = {});

/// A test of the plan at one pressure and amplitude: what one specimen goes through.
struct TestVariant {
  std::size_t row = 0;         ///< of Plan::tests
  double pressure = unknown;   ///< Pa, at the start
  double amplitude = unknown;  ///< of cycles
  protocol::Protocol protocol;
  /// "drained_dense_100kPa_s2", of a specimen with this density and number.
  std::string name_with(const std::string& density, std::size_t number) const;
  std::string name, suffix;  ///< "drained", "_100kPa"
};

/// Every variant of a plan whose protocols are paths, for specimens of a dimension; those of another one are left out.
/// `remarks` gets a sentence for each that is replaced, and for each purpose that no test is left for. InputError: a
/// protocol is wrong, or does not give what its purpose asks for; none is left.
std::vector<TestVariant> variants_of(const Plan& plan, int dimension, std::vector<std::string>& remarks);

/// Whether specimens of a density, by its name, and of a number from 0 within it, go through a test. A name that the
/// plan has not, of given specimens, goes through all.
bool goes_through(const Plan& plan, const PlanTest& test, const std::string& density, std::size_t number);

}  // namespace rvelab::sheet
