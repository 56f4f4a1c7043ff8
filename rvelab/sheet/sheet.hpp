// The data sheet of a soil: the tests that it is made of, its numbers and its figures.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "rvelab/protocol/protocol.hpp"
#include "rvelab/records/record.hpp"

namespace rvelab::sheet {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// What a test of a plan is for.
enum class Purpose {
  isotropic,        ///< isotropic compression with probes: G0, e over p
  oedometer,        ///< loading and unloading without lateral strain
  drained,          ///< triaxial, of discs biaxial
  undrained,        ///< the same at constant volume
  undrained_shear,  ///< simple shear at constant volume
  cyclic_strain,    ///< simple shear of a strain amplitude: G, damping
  cyclic_stress     ///< undrained cyclic to liquefaction
};

/// A test that came to its end.
struct Test {
  std::string name;  ///< unique in the sheet, of its record file: "drained_dense_100kPa_s2"
  Purpose purpose = Purpose::drained;
  std::size_t density = 0;            ///< row of the plan's densities
  std::string density_name;           ///< "loose"
  double relative_density = unknown;  ///< asked, 0 to 1; NaN: the recipe has no limits of density
  std::uint64_t seed = 0;             ///< of its specimen
  double pressure = unknown;          ///< asked, at the start, Pa
  double amplitude = unknown;         ///< of cycles: shear strain, or stress ratio (q or tau over twice/once p; page)
  double void_ratio = unknown;        ///< at the start of the test
  int dimension = 3;
  protocol::Protocol protocol;
  records::TestResult result;
};

/// One number of the sheet. Compression positive; SI, angles in degrees.
struct Number {
  std::string key;           ///< in summary.json, ends in its unit: "phi_cs_deg"
  std::string label;         ///< on the page
  std::string unit;          ///< "" for a pure number
  std::string density_name;  ///< "": of all densities together
  double relative_density = unknown;
  double pressure = unknown;  ///< Pa; NaN: of all pressures together
  double mean = unknown;
  double standard_error = unknown;       ///< over specimens; NaN from a single one
  double low = unknown, high = unknown;  ///< 95 % interval; NaN from a single specimen
  double calculation_error = unknown;    ///< from the error estimates of the records it is read off
  std::vector<std::string> tests;        ///< names of the tests that it comes from
  std::string definition, source;        ///< one line each
  double published = unknown;            ///< --beside, or of the plan
  std::string published_by;
  std::string group;   ///< heading on the page that it stands under: "Strength"
  std::string remark;  ///< why the number is not to be used, and models do not take it; "": none
};

struct Series {
  std::string label;
  std::vector<double> x, y, error;  ///< error: half of an interval of 95 %, or empty
  bool line = true;                 ///< false: symbols
  bool measured = false;            ///< of a laboratory, or published
};

struct Figure {
  std::string key, title, x_label, y_label, caption;
  bool x_logarithmic = false, y_logarithmic = false;
  std::vector<Series> series;
  std::string group;  ///< as that of the numbers
};

struct Sheet {
  std::string soil;  ///< name of the recipe
  std::vector<Number> numbers;
  std::vector<Figure> figures;
  std::vector<std::string> remarks;  ///< what is left out, and why, one sentence each
};

}  // namespace rvelab::sheet
