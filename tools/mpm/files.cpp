#include "tools/mpm/files.hpp"

#include <hdf5.h>

#include <filesystem>

#include "tools/mpm/tensors.hpp"

namespace mpm {
namespace {

hid_t checked(hid_t id, const std::string& path, const std::string& what) {
  if (id < 0) throw Mistake(path + ": " + what);
  return id;
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path), partial_(path + ".partial") {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  file_ = checked(H5Fcreate(partial_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), path,
                  "cannot be written; give a folder that you may write to");
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
  if (failed) throw Mistake(path_ + ": " + name + " cannot be written; is the disc full?");
}

void OutputFile::write(const std::string& name, const std::vector<double>& values, const Extents& extents) {
  put(name, H5T_NATIVE_DOUBLE, values.data(), extents);
}

void OutputFile::write(const std::string& name, const std::vector<std::int64_t>& values) {
  put(name, H5T_NATIVE_INT64, values.data(), {values.size()});
}

void OutputFile::write(const std::string& name, const std::string& text) {
  put(name, H5T_NATIVE_UINT8, text.data(), {text.size()});
}

void OutputFile::publish() {
  const bool failed = H5Fclose(file_) < 0;
  file_ = -1;
  std::error_code error;
  if (!failed) std::filesystem::rename(partial_, path_, error);
  if (failed || error) throw Mistake(path_ + ": cannot be written; is the disc full?");
}

InputFile::InputFile(const std::string& path) : path_(path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  file_ = checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), path,
                  "is missing, or no whole HDF5 file; put it back from a copy, or start the run anew");
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
    throw Mistake(path_ + ": " + name + " cannot be read; put the file back from a copy, or start the run anew");
  return values;
}

std::vector<double> InputFile::read(const std::string& name) const { return get<double>(name, H5T_NATIVE_DOUBLE); }

std::vector<std::int64_t> InputFile::read_whole(const std::string& name) const {
  return get<std::int64_t>(name, H5T_NATIVE_INT64);
}

std::string InputFile::read_text(const std::string& name) const {
  const auto bytes = get<std::uint8_t>(name, H5T_NATIVE_UINT8);
  return {bytes.begin(), bytes.end()};
}

}  // namespace mpm
