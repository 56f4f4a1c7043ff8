#include "tools/mpm/files/hdf5.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <span>

#include "rvelab/io/hdf5/seal.hpp"
#include "rvelab/keys/regular_file.hpp"
#include "tools/mpm/error.hpp"

namespace mpm {
namespace {

hid_t checked(hid_t id, const std::string& path, const std::string& what) {
  if (id < 0) throw InputError(path + ": " + what);
  return id;
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  // In memory: a file of HDF5 that cannot be written stays open in the library, which then fails at the program's end.
  constexpr std::size_t growth = 1 << 20;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, growth, false);
  // Under a name that no file has: HDF5 would read the one that it replaces.
  file_ = H5Fcreate((path_ + ".partial").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  H5Pclose(access);
  if (file_ < 0) throw std::runtime_error(path_ + ": there is no memory for what is to be written");
}

OutputFile::~OutputFile() {
  if (file_ >= 0) H5Fclose(file_);
}

void OutputFile::put(const std::string& name, std::int64_t type, const void* values, const Extents& extents) {
  const std::vector<hsize_t> sizes(extents.begin(), extents.end());
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const hid_t space = H5Screate_simple(int(sizes.size()), sizes.data(), nullptr);
  const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(how, 0);  // runs that are the same have files that are the same
  const hid_t set = H5Dcreate2(file_, name.c_str(), type, space, links, how, H5P_DEFAULT);
  const bool failed = set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0;
  if (set >= 0) H5Dclose(set);
  H5Sclose(space);
  H5Pclose(how);
  H5Pclose(links);
  if (failed) throw std::runtime_error(path_ + ": there is no memory for " + name);
}

void OutputFile::write(const std::string& name, const std::vector<double>& values, const Extents& extents) {
  put(name, H5T_NATIVE_DOUBLE, values.data(), extents);
}

void OutputFile::write(const std::string& name, const std::vector<std::int64_t>& values) {
  put(name, H5T_NATIVE_INT64, values.data(), {values.size()});
}

void OutputFile::publish(bool sealed) {
  const auto size = H5Fflush(file_, H5F_SCOPE_GLOBAL) < 0 ? -1 : H5Fget_file_image(file_, nullptr, 0);
  std::vector<std::byte> bytes(std::size_t(std::max<ssize_t>(size, 0)));
  if (size < 0 || H5Fget_file_image(file_, bytes.data(), bytes.size()) < 0) {
    throw std::runtime_error(path_ + ": there is no memory for what is to be written");
  }
  H5Fclose(file_);
  file_ = -1;
  if (sealed) {
    const auto seal = rvelab::io::seal_of(bytes);
    bytes.insert(bytes.end(), seal.begin(), seal.end());
  }
  publish_file(path_, reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void publish_file(const std::string& path, const char* bytes, std::size_t size) {
  const std::string partial = path + ".partial";
  std::ofstream file(partial, std::ios::binary);
  if (!file && errno != ENOSPC) throw InputError(path + ": cannot be written; give a folder that you may write to");
  file.write(bytes, std::streamsize(size));
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(partial, path, error);
  if (file && !error) return;
  std::filesystem::remove(partial, error);
  throw std::runtime_error(path + ": cannot be written; is the disc full?");
}

std::vector<std::byte> file_bytes(const std::string& path) {
  try {
    return rvelab::keys::whole_file<std::vector<std::byte>>(
        path, "a file of this run, put back from a copy, or start the run anew");
  } catch (const rvelab::InputError& error) {
    throw InputError(error.what());
  }
}

InputFile::InputFile(const std::string& path) : path_(path) {
  auto bytes = file_bytes(path);
  const std::size_t whole = bytes.size();
  // The seal that these bytes ask for, beside the one that they have.
  const bool room = whole > rvelab::io::seal_bytes;
  const auto body = std::span(bytes).first(room ? whole - rvelab::io::seal_bytes : 0);
  const auto seal = rvelab::io::seal_of(body);
  if (!room || !std::equal(seal.begin(), seal.end(), bytes.begin() + std::ptrdiff_t(body.size()))) {
    throw InputError(path + ": is damaged (" + std::to_string(whole) +
                     " bytes, and its seal is not theirs); put it back from a copy, or start the run anew");
  }
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, 1 << 20, false);
  H5Pset_file_image(access, bytes.data(), body.size());
  // Under a name that no file can have: HDF5 would refuse to read another by it.
  const hid_t opened = H5Fopen((path + "/image").c_str(), H5F_ACC_RDONLY, access);
  H5Pclose(access);
  file_ = checked(opened, path, "is no HDF5 file; put it back from a copy, or start the run anew");
}

InputFile::~InputFile() { H5Fclose(file_); }

template <class Value>
std::vector<Value> InputFile::get(const std::string& name, std::int64_t type) const {
  const hid_t set =
      checked(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), path_,
              "holds no " + name + ": it is not of this program, or of another version; start the run anew");
  const hid_t space = H5Dget_space(set);
  std::vector<Value> values(std::size_t(H5Sget_simple_extent_npoints(space)));
  const bool failed = H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0;
  H5Sclose(space);
  H5Dclose(set);
  if (failed)
    throw InputError(path_ + ": " + name + " cannot be read; put the file back from a copy, or start the run anew");
  return values;
}

std::vector<double> InputFile::read(const std::string& name) const { return get<double>(name, H5T_NATIVE_DOUBLE); }

std::vector<std::int64_t> InputFile::read_whole(const std::string& name) const {
  return get<std::int64_t>(name, H5T_NATIVE_INT64);
}

}  // namespace mpm
