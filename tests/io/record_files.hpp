// Record files written and read whole, and the first difference of two files.
#pragma once

#include <optional>
#include <string>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"

namespace rvelab::test {

/// Writes a complete test, of which the specimen that it began with is not known.
inline void write_records(const records::TestResult& result, const Specimen& end_state, const std::string& protocol,
                          const std::string& path) {
  io::RecordedTest test;
  test.provenance = io::provenance_of(protocol, end_state);
  test.provenance.specimen_crc32c = 0;
  test.result = result;
  test.checkpoint.specimen = end_state;
  io::write_recorded_test(test, path);
}

inline records::TestResult read_records(const std::string& path) { return io::read_recorded_test(path).result; }

inline std::string read_protocol_text(const std::string& path) {
  return io::read_recorded_test(path).provenance.protocol;
}

inline std::optional<std::string> first_difference(const std::string& path_a, const std::string& path_b) {
  return io::compare_files(path_a, path_b).difference;
}

}  // namespace rvelab::test
