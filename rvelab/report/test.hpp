// A recorded test in a page, and the tests of one name together. Compression is positive in a page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/ensemble/measures.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/report/json.hpp"

namespace rvelab::report {

/// The content of a record file.
struct Test {
  std::string path, file;  ///< as given; without its folder
  std::string group;       ///< folder of the file, relative to the given path
  io::RecordedTest recorded;
  protocol::Protocol protocol;
  int dimension = 2;
  std::vector<double> measured;           ///< of ensemble::measures()
  calibrate::PrincipalStresses strength;  ///< Pa; NaN: the test has no strength

  const std::vector<records::Record>& records() const { return recorded.result.records; }
  /// Stress that distinguishes tests of one kind: p at the first record of the last stage, or the held lateral one, Pa.
  double pressure = 0;
  /// F since the start of the test at each record: that of the stage times that at the end of the stages before.
  std::vector<Matrix3> deformation;
};

/// Reads it; empty without records, as for a test of probes only. InputError: not a record file.
std::optional<Test> read_test(const std::string& path, const std::string& group);

/// A quantity over the records of a test.
struct Column {
  std::string key, label, unit, meaning;
  std::vector<double> values;
  std::vector<double> errors;  ///< from the error estimate of the record; empty: the quantity has no error
};

/// All quantities of curves, in the units of a page (kPa, %, degrees).
std::vector<Column> columns_of(const Test& test);

/// A key of each kind of test: tests of one kind differ only by their specimen.
struct Kind {
  std::string label;            ///< distinguishes it from the others
  std::vector<std::size_t> of;  ///< rows of the tests
  std::size_t set = 0;          ///< kinds of one set differ only by their pressure
  double pressure = 0;          ///< Pa, mean of its tests
};

/// Tests of one name and dimension sorted into kinds: group, settings without pressures, material, number of grains,
/// pressure (classes with gaps of 3 %), void ratio at the start (gaps of 0.02).
std::vector<Kind> kinds_of(const std::vector<Test>& tests);

}  // namespace rvelab::report
