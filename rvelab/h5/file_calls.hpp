// librvelab-h5.so reads and writes files for librvelab.so, of the same version: values and exceptions cross between
// them.
#pragma once

#include "rvelab/h5/pool_file.hpp"

namespace rvelab::h5 {

/// Each throws as the function of pool_file.hpp or of io that it is.
struct FileCalls {
  const char* version;  ///< of rvelab; both libraries must be of one
  Specimen (*read_specimen)(const std::string& path);
  void (*write_pool)(const std::string& path, const pool::Population& population, const pool::Pool::StateOf& state);
  pool::Population (*read_pool)(const std::string& path, const pool::Pool::TakeState& take);
};

/// Name of the function that librvelab-h5.so exports.
constexpr const char* file_calls_name = "rvelab_h5_file_calls";
using GetFileCalls = const FileCalls* (*)();

}  // namespace rvelab::h5

extern "C" [[gnu::visibility("default")]] const rvelab::h5::FileCalls* rvelab_h5_file_calls();
