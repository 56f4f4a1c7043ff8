// A recorded test as a page tells it, and the tests of one name together. Compression is positive in a page.
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

/// A record file that was read.
struct Test {
  std::string path, file;  ///< as given; without its folder
  std::string group;       ///< folder of the file, relative to what was given
  io::RecordedTest recorded;
  protocol::Protocol protocol;
  int dimension = 2;
  std::vector<double> measured;           ///< of ensemble::measures()
  calibrate::PrincipalStresses strength;  ///< Pa; NaN: the test leads to no strength

  const std::vector<records::Record>& records() const { return recorded.result.records; }
  /// Stress that tests of one kind differ by: p at the first record of the last stage, or the held lateral one, Pa.
  double pressure = 0;
  /// F since the start of the test at each record: that of the stage times that at the end of the stages before.
  std::vector<Matrix3> deformation;
};

/// Reads it; nothing where no record was made, as by a test of probes alone. InputError: no record file.
std::optional<Test> read_test(const std::string& path, const std::string& group);

/// A quantity over the records of a test.
struct Column {
  std::string key, label, unit, meaning;
  std::vector<double> values;
  std::vector<double> errors;  ///< by the error estimate of the record; none: it has no such
};

/// Everything that curves can be made of, in the units of a page (kPa, %, degrees).
std::vector<Column> columns_of(const Test& test);

/// A key of each kind of test: those of one kind differ by their specimen alone.
struct Kind {
  std::string label;            ///< what tells it from the others
  std::vector<std::size_t> of;  ///< rows of the tests
  std::size_t set = 0;          ///< kinds of one set differ by their pressure alone
  double pressure = 0;          ///< Pa, mean of its tests
};

/// Tests of one name and dimension sorted into kinds: group, settings without pressures, material, number of grains,
/// pressure (classes with gaps of 3 %), void ratio at the start (gaps of 0.02).
std::vector<Kind> kinds_of(const std::vector<Test>& tests);

}  // namespace rvelab::report
