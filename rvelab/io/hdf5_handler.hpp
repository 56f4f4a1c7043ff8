// HDF5's error handler as a host left it.
#pragma once

namespace rvelab::io {

/// Puts the error handler that HDF5 had when this was made back at the end, whatever was done to it meanwhile.
class Hdf5Handler {
 public:
  Hdf5Handler();
  ~Hdf5Handler();
  Hdf5Handler(const Hdf5Handler&) = delete;
  Hdf5Handler& operator=(const Hdf5Handler&) = delete;

 private:
  bool new_style_ = true;
  void (*call_)() = nullptr;
  void* argument_ = nullptr;
};

}  // namespace rvelab::io
