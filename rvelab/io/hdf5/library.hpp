// What reading and writing trees share of libhdf5. For read.cpp and write.cpp alone: nothing else calls it.
//
// The bytes are in memory, and no file is opened. The library has no lock, prints what it finds, and may be that of the
// host too: here one thread uses it at a time, it is silent meanwhile, and its message goes into ours.
#pragma once

#define H5_USE_110_API  // the one of Debian 12, which later libraries have too
#include <hdf5.h>

#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "rvelab/io/hdf5/tree.hpp"

namespace rvelab::io::hdf5 {

/// The library looks for a file of this name first; none can have it.
inline constexpr const char* no_file = "/dev/null/rvelab";

inline std::mutex& library_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// While it lives, the library is this thread's and prints nothing.
class Turn {
 public:
  Turn() : lock_(library_mutex()) {
    static const herr_t without_atexit = H5dont_atexit();  // librvelab-h5.so may be gone at the end of its host
    static_cast<void>(without_atexit);
    H5Eget_auto2(H5E_DEFAULT, &report_, &shown_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  ~Turn() { H5Eset_auto2(H5E_DEFAULT, report_, shown_); }

 private:
  std::lock_guard<std::mutex> lock_;
  H5E_auto2_t report_ = nullptr;
  void* shown_ = nullptr;
};

/// The innermost reason for which the last call failed. std::bad_alloc if it was memory.
inline std::string reason() {
  struct Found {
    char text[200] = "no reason given";
    bool no_memory = false;
  } found;
  const auto look = [](unsigned number, const H5E_error2_t* error, void* data) -> herr_t {
    Found& found = *static_cast<Found*>(data);
    found.no_memory = found.no_memory || error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC;
    if (number == 0 && error->desc != nullptr) std::strncpy(found.text, error->desc, sizeof found.text - 1);
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &found);
  if (found.no_memory) throw std::bad_alloc();
  return std::string("HDF5: ") + found.text;
}

/// Without memory the library may be of no use to the process any more, so what it will take is asked for before.
inline void expect_memory(std::size_t bytes) {
  constexpr std::size_t own = 1 << 20;
  ::operator delete(::operator new(bytes + own));
}

/// An identifier of the library, closed at the end.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

/// How a file in memory is opened; it grows by `growth` bytes.
inline Handle access_in_memory(std::size_t growth) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, growth, false);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  H5Pset_libver_bounds(access, H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  return access;
}

struct NumberType {
  Type type;
  hid_t id;
};

inline std::vector<NumberType> number_types() {
  return {{{Kind::floating, 8}, H5T_IEEE_F64LE}, {{Kind::floating, 4}, H5T_IEEE_F32LE},
          {{Kind::whole, 8}, H5T_STD_I64LE},     {{Kind::whole, 4}, H5T_STD_I32LE},
          {{Kind::whole, 2}, H5T_STD_I16LE},     {{Kind::whole, 1}, H5T_STD_I8LE},
          {{Kind::natural, 8}, H5T_STD_U64LE},   {{Kind::natural, 4}, H5T_STD_U32LE},
          {{Kind::natural, 2}, H5T_STD_U16LE},   {{Kind::natural, 1}, H5T_STD_U8LE}};
}

}  // namespace rvelab::io::hdf5
