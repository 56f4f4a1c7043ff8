#include "rvelab/h5/file_calls.hpp"

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/version.hpp"

namespace rvelab::h5 {

namespace {

Specimen read_specimen(const std::string& path) { return io::read_specimen(path, io::Seal::required); }

}  // namespace
}  // namespace rvelab::h5

const rvelab::h5::FileCalls* rvelab_h5_file_calls() {
  using namespace rvelab::h5;
  static const FileCalls calls{rvelab::io::version, read_specimen, write_pool, read_pool};
  return &calls;
}
