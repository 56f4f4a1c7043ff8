// librvelab-h5.so reads and writes files, parameters and stages as text, for librvelab.so, of the same version: values
// and exceptions cross between them.
#pragma once

#include <atomic>
#include <string>

#include "rvelab/pool/pool.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab::h5 {

/// Each throws InputError or Error as io::read_specimen and io::write_specimen do. Files of pools are described in
/// rvelab/io/README.md.
struct FileCalls {
  const char* version;  ///< of rvelab; both libraries must be of one
  Specimen (*read_specimen)(const std::string& path);
  void (*write_pool)(const std::string& path, const pool::Population& population, const pool::Pool::StateOf& state);
  pool::Population (*read_pool)(const std::string& path, const pool::Pool::TakeState& take);
  std::string (*parameters_text)(const Specimen& specimen);  ///< this and the next: keys/parameters.hpp
  void (*set_parameters)(Specimen& specimen, const std::string& text);
  void (*check_stages)(const std::string& text);  ///< this and the next: file_calls.cpp
  std::int64_t (*run_stages)(Specimen& specimen, const std::string& text, const std::atomic<bool>& stop);
  const void* hdf5;  ///< its function H5check_version, of whatever HDF5 it is
};

/// Name of the function that librvelab-h5.so exports.
constexpr const char* file_calls_name = "rvelab_h5_file_calls";
using GetFileCalls = const FileCalls* (*)();

}  // namespace rvelab::h5

extern "C" [[gnu::visibility("default")]] const rvelab::h5::FileCalls* rvelab_h5_file_calls();
