// Files, and parameters as text, by way of librvelab-h5.so. Declared in c_boundary.hpp.

#include <dlfcn.h>

#include <filesystem>
#include <mutex>

#include "rvelab/abi/c_boundary.hpp"
#include "rvelab/io/version.hpp"

namespace rvelab::abi {

namespace {

using pool::Refused;
using pool::Status;

constexpr const char* library_name = "librvelab-h5.so.1";

/// Where HDF5 is among the global symbols of the process, it may be another than the library was built with, and would
/// answer in the place of that: the library's own come first. Sanitizers want theirs first; where HDF5 is part of the
/// library no symbol is looked up.
int how_to_open() {
#ifdef RVELAB_SHARED_HDF5
  if (dlsym(RTLD_DEFAULT, "H5check_version") != nullptr) return RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND;
#endif
  return RTLD_NOW | RTLD_LOCAL;
}

std::mutex library_mutex;
const h5::FileCalls* loaded_calls = nullptr;

/// Folder of the library (or program) that this code is in, with its last stroke; "" if the loader does not know it.
std::string own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&library_mutex), &info) == 0 || info.dli_fname == nullptr) return {};
  const std::string name = info.dli_fname;
  const auto stroke = name.rfind('/');
  return stroke == std::string::npos ? std::string() : name.substr(0, stroke + 1);
}

}  // namespace

const h5::FileCalls& file_calls() {
  const std::lock_guard lock(library_mutex);
  if (loaded_calls != nullptr) return *loaded_calls;
  const std::string beside = own_folder() + library_name;
  void* library = dlopen(beside.c_str(), how_to_open());
  std::string reasons = library == nullptr ? dlerror() : "";
  if (library == nullptr) {
    library = dlopen(library_name, how_to_open());
    if (library == nullptr) reasons += std::string("; ") + dlerror();
  }
  const auto refuse = [&](const std::string& what) {
    throw Refused(Status::no_library, std::string("files and texts are read and written by ") + library_name + ": " +
                                          what +
                                          "; put the one of this version beside librvelab.so, or its folder into "
                                          "LD_LIBRARY_PATH");
  };
  if (library == nullptr) refuse(reasons);
  const auto get = reinterpret_cast<h5::GetFileCalls>(dlsym(library, h5::file_calls_name));
  const h5::FileCalls* const calls = get == nullptr ? nullptr : get();
  if (calls == nullptr || calls->version != std::string(io::version)) {
    const std::string found = calls == nullptr
                                  ? "it is none of rvelab's"
                                  : std::string("it is of rvelab ") + calls->version + ", this is " + io::version;
    dlclose(library);
    refuse(found);
  }
  const void* const own_hdf5 = dlsym(library, "H5check_version");
  if (own_hdf5 != nullptr && own_hdf5 != calls->hdf5)
    throw Refused(Status::no_library, std::string(library_name) +
                                          " was loaded by the host, and another HDF5 of the host answers for the one "
                                          "that it was built with; do not link or load it: librvelab.so does at the "
                                          "first call for a file");
  loaded_calls = calls;
  return *calls;
}

namespace {

/// Makes a call on a file. All its faults have one status, and what is wrong with a state is wrong with its file.
template <class Call>
auto of_file(const Call& call) {
  try {
    return call(file_calls());
  } catch (const std::filesystem::filesystem_error& error) {
    throw Refused(Status::bad_file, error.path1().string().substr(0, 200) + ": cannot be used (" +
                                        error.code().message() +
                                        "); give the path of a file in a folder that you may use");
  } catch (...) {
    char text[1024];
    const Status status = pool::status_of_exception(text, sizeof text);
    if (status != Status::bad_input && status != Status::bad_snapshot && status != Status::internal) throw;
    throw Refused(Status::bad_file, text);
  }
}

}  // namespace

Specimen read_specimen(const std::string& path) {
  return of_file([&](const h5::FileCalls& calls) { return calls.read_specimen(path); });
}

const h5::FileCalls& text_calls(const std::string& text) {
  ::operator delete(::operator new((1 << 20) + 100 * text.size()));
  return file_calls();
}

void write_pool(pool::Pool& pool, const std::string& path) {
  pool.write([&](const pool::Population& population, const pool::Pool::StateOf& state) {
    of_file([&](const h5::FileCalls& calls) { calls.write_pool(path, population, state); });
  });
}

void read_pool(pool::Pool& pool, const std::string& path) {
  pool.read([&](const pool::Pool::TakeState& take) {
    return of_file([&](const h5::FileCalls& calls) { return calls.read_pool(path, take); });
  });
}

}  // namespace rvelab::abi
