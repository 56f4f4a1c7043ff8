// What HDF5's own library makes of our files, and we of its: nothing leads out of a file, nothing is missing in
// silence.
#include "rvelab/io/hdf5/file.hpp"

#include <hdf5.h>

#include <chrono>
#include <filesystem>

#include "random_specimen.hpp"
#include "rvelab/io/hdf5/seal.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/catch.hpp"
#include "tests/io/record_files.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

void seal(const std::string& path) {
  std::string bytes = bytes_of(path);
  const auto made = io::seal_of(std::as_bytes(std::span(bytes)));
  write_bytes(path, bytes + std::string(reinterpret_cast<const char*>(made.data()), made.size()));
}

/// Changes a file through HDF5's library, as h5py does, and gives it a seal that fits.
template <class Change>
void change(const std::string& path, Change change) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(file >= 0);
  change(file);
  REQUIRE(H5Fclose(file) >= 0);
  seal(path);
}

void write_dataset(hid_t file, const char* name, hid_t space, hid_t creation) {
  H5Ldelete(file, name, H5P_DEFAULT);
  const hid_t made = H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
  const std::vector<double> values(std::size_t(H5Sget_simple_extent_npoints(space)), 0.25);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // of a virtual one it may write nothing, which is no matter
  if (made >= 0) H5Dwrite(made, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(made);
}

}  // namespace

TEST_CASE("HDF5's library reads what is written, name by name and bit by bit") {
  const Folder folder;
  const Specimen specimen = random_specimen(4);
  io::write_specimen(specimen, folder / "s.h5");
  const hid_t file = H5Fopen((folder / "s.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(file >= 0);
  const auto ours = io::Hdf5File::open(folder / "s.h5");
  for (const io::Hdf5Entry& entry : ours.entries()) {
    CAPTURE(entry.name);
    const hid_t dataset = H5Dopen2(file, entry.name.c_str(), H5P_DEFAULT), type = H5Dget_type(dataset);
    REQUIRE(dataset >= 0);
    CHECK(H5Aexists(dataset, "units") > 0);
    if (H5Tget_class(type) != H5T_STRING) {
      const io::hdf5::Values& stored = *ours.tree().objects.at(entry.name).dataset;
      std::vector<std::byte> found(stored.bytes.size() + 1);
      CHECK(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, found.data()) >= 0);
      found.pop_back();
      CHECK(std::equal(found.begin(), found.end(), stored.bytes.begin(), stored.bytes.end()));
    }
    H5Tclose(type);
    H5Dclose(dataset);
  }
  H5Fclose(file);
}

TEST_CASE("groups of any number of members are found by HDF5's library and by us") {
  const Folder folder;
  for (const int members : {0, 1, 8, 9, 300, 3000}) {
    CAPTURE(members);
    io::publish(folder / "g.h5", [&](io::Hdf5File& file) {
      for (int k = 0; k < members; ++k) file.write_text("/g/" + std::to_string(k), {"x"}, {});
      file.write_text("/last", {"y"}, {});
    });
    const hid_t file = H5Fopen((folder / "g.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    REQUIRE(file >= 0);
    for (int k = 0; k < members; ++k) {
      if (H5Lexists(file, ("/g/" + std::to_string(k)).c_str(), H5P_DEFAULT) <= 0) FAIL_CHECK(k << " is not found");
    }
    CHECK(H5Lexists(file, "/last", H5P_DEFAULT) > 0);
    CHECK((members == 0 || H5Lexists(file, "/g/x", H5P_DEFAULT) == 0));
    H5Fclose(file);
    CHECK(io::Hdf5File::open(folder / "g.h5").groups("/g").size() == std::size_t(members));
    std::filesystem::remove(folder / "g.h5");
  }
}

TEST_CASE("what leads out of a sealed file, or has a second name in it, is refused by name") {
  const Folder folder;
  const Specimen specimen = random_specimen(5);
  io::write_specimen(specimen, folder / "whole.h5");
  io::write_specimen(specimen, folder / "other.h5");
  const std::string other = folder / "other.h5", path = folder / "x.h5";
  const auto refusal = [&](auto with) {
    std::filesystem::copy_file(folder / "whole.h5", path, std::filesystem::copy_options::overwrite_existing);
    change(path, with);
    const std::string message = input_error([&] { io::read_specimen(path); });
    CHECK(message == input_error([&] { io::compare_files(path, path); }));
    CHECK(message == input_error([&] { io::seal_file(path, folder / "new.h5"); }));
    return message;
  };
  CHECK_THAT(refusal([&](hid_t file) {
               H5Ldelete(file, "/grains/position_m", H5P_DEFAULT);
               H5Lcreate_external(other.c_str(), "/grains/position_m", file, "/grains/position_m", H5P_DEFAULT,
                                  H5P_DEFAULT);
             }),
             Contains("/grains/position_m is a link to another file (") && Contains("other.h5"));
  CHECK_THAT(refusal([&](hid_t file) {
               const hid_t group = H5Gcreate2(file, "/notes", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
               H5Lcreate_external(other.c_str(), "/shape", group, "shape", H5P_DEFAULT, H5P_DEFAULT);
               H5Gclose(group);
             }),
             Contains("/notes/shape is a link to another file (") && Contains("other.h5"));
  CHECK_THAT(refusal([&](hid_t file) {
               H5Ldelete(file, "/grains/radius_m", H5P_DEFAULT);
               H5Lcreate_soft("/grains/semi_major_m", file, "/grains/radius_m", H5P_DEFAULT, H5P_DEFAULT);
             }),
             Contains("/grains/radius_m is a link to another name (/grains/semi_major_m)"));
  CHECK_THAT(refusal([&](hid_t file) { H5Lcreate_hard(file, "/", file, "/cell/again", H5P_DEFAULT, H5P_DEFAULT); }),
             Contains("/cell/again is a second name"));
  // A dataset of nine rows that is stored in another way.
  const hsize_t rows = 9;
  const auto stored = [&](const auto& choose) {
    return refusal([&](hid_t file) {
      const hid_t space = H5Screate_simple(1, &rows, nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
      choose(creation, space);
      write_dataset(file, "/grains/radius_m", space, creation);
      H5Pclose(creation);
      H5Sclose(space);
    });
  };
  CHECK_THAT(stored([&](hid_t creation, hid_t) { H5Pset_external(creation, (folder / "raw.bin").c_str(), 0, 72); }),
             Contains("/grains/radius_m keeps its values in another file"));
  CHECK_THAT(stored([&](hid_t creation, hid_t space) {
               H5Pset_virtual(creation, space, other.c_str(), "/grains/radius_m", space);
             }),
             Contains("/grains/radius_m is a virtual dataset"));
  CHECK_THAT(stored([&](hid_t creation, hid_t) {
               H5Pset_chunk(creation, 1, &rows);
               H5Pset_shuffle(creation);
             }),
             Contains("/grains/radius_m is compressed or filtered"));
  CHECK_THAT(stored([&](hid_t creation, hid_t) { H5Pset_chunk(creation, 1, &rows); }),
             Contains("/grains/radius_m is in chunks"));
  CHECK_THAT(refusal([&](hid_t file) {
               hid_t at = H5Gopen2(file, "/", H5P_DEFAULT);
               for (int depth = 0; depth < 2000; ++depth) {
                 const hid_t next = H5Gcreate2(at, "g", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
                 H5Gclose(at);
                 at = next;
               }
               H5Gclose(at);
             }),
             Contains("/g/g/g") && Contains("groups in one another"));
}

TEST_CASE("values of other types than numbers and text of fixed length are refused by name") {
  const Folder folder;
  io::write_specimen(random_specimen(5), folder / "whole.h5");
  const std::string path = folder / "x.h5";
  const auto refusal = [&](hid_t type, bool named, bool attribute) {
    std::filesystem::copy_file(folder / "whole.h5", path, std::filesystem::copy_options::overwrite_existing);
    change(path, [&](hid_t file) {
      const hid_t space = H5Screate(H5S_SCALAR), own = H5Tcopy(type);
      if (named) H5Tcommit2(file, "/type", own, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      if (named) H5Ldelete(file, "/type", H5P_DEFAULT);  // the dataset keeps it
      const hid_t made = attribute ? H5Acreate2(file, "mark", own, space, H5P_DEFAULT, H5P_DEFAULT)
                                   : H5Dcreate2(file, "/a", own, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      REQUIRE(made >= 0);
      attribute ? H5Aclose(made) : H5Dclose(made);
      H5Sclose(space);
      H5Tclose(own);
    });
    return input_error([&] { io::Hdf5File::open(path); });
  };
  const hid_t text = H5Tcopy(H5T_C_S1), truth = H5Tenum_create(H5T_STD_I8LE), pair = H5Tcreate(H5T_COMPOUND, 16);
  H5Tset_size(text, H5T_VARIABLE);
  for (const auto& [name, value] : {std::pair{"FALSE", 0}, {"TRUE", 1}}) H5Tenum_insert(truth, name, &value);
  H5Tinsert(pair, "x", 0, H5T_IEEE_F64LE);
  const hid_t odd = H5Tcopy(H5T_STD_U32LE);
  H5Tset_precision(odd, 17);
  for (const bool attribute : {false, true}) {
    const std::string what = attribute ? "attribute mark of / " : "dataset /a ";
    CHECK_THAT(refusal(text, false, attribute), Contains(what + "holds text of variable length"));
    CHECK_THAT(refusal(truth, false, attribute), Contains(what + "holds values that are neither numbers nor text"));
    CHECK_THAT(refusal(pair, false, attribute), Contains(what + "holds values that are neither numbers nor text"));
    CHECK_THAT(refusal(H5T_IEEE_F64BE, false, attribute), Contains(what + "holds numbers of another layout"));
    CHECK_THAT(refusal(odd, false, attribute), Contains(what + "holds numbers of another layout"));
    CHECK_THAT(refusal(H5T_IEEE_F64LE, true, attribute), Contains(what + "has a type that lies elsewhere"));
  }
  for (const hid_t type : {text, truth, pair, odd}) H5Tclose(type);
}

TEST_CASE("a file of the newest layout of HDF5 is refused, and what to do is said") {
  const Folder folder;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  H5Fclose(H5Fcreate((folder / "x.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access));
  H5Pclose(access);
  seal(folder / "x.h5");
  CHECK_THAT(input_error([&] { io::Hdf5File::open(folder / "x.h5"); }),
             Contains("x.h5: is an HDF5 file of another layout (superblock of version ") && Contains("earliest"));
}

TEST_CASE("the same content gives the same bytes, in whatever order it was put in") {
  const auto bytes = [](bool turned) {
    auto file = io::Hdf5File::in_memory("any");
    const std::vector<double> numbers(1000, 0.5);
    const auto put = [&](const std::string& name) { file.write<double>(name, numbers, {10, 100}, "m"); };
    turned ? put("/b") : put("/a/c");
    turned ? put("/a/c") : put("/b");
    file.write_text("/a/text", {"x", "longer"}, {2});
    file.set_attribute("format", "any");
    return file.image();
  };
  const auto first = bytes(false);
  const std::vector<std::byte> dirty(first.size(), std::byte{0xa5});  // what the next ones may find in their memory
  CHECK(bytes(true) == first);
  CHECK(bytes(false) == first);
}

TEST_CASE("a host's own HDF5 keeps its messages and its open files") {
  const Folder folder;
  io::write_specimen(random_specimen(4), folder / "s.h5");
  const auto report = [](hid_t, void* told) -> herr_t { return ++*static_cast<int*>(told), 0; };
  H5E_auto2_t before = nullptr;
  void* data = nullptr;
  int told = 0;
  H5Eget_auto2(H5E_DEFAULT, &before, &data);
  H5Eset_auto2(H5E_DEFAULT, report, &told);
  const hid_t file = H5Fcreate((folder / "own.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  auto image = io::Hdf5File::open(folder / "s.h5").image();
  std::fill(image.begin() + 96, image.end(), std::byte{0});  // all but the superblock
  CHECK_THAT(input_error([&] { io::Hdf5File::from_image("x", image); }), Contains("x: is damaged (HDF5: "));
  io::read_specimen(folder / "s.h5");
  io::write_specimen(random_specimen(4), folder / "t.h5");
  CHECK(told == 0);
  CHECK(H5Gopen2(file, "/none", H5P_DEFAULT) < 0);
  CHECK(told == 1);
  CHECK(H5Fclose(file) >= 0);
  H5Eset_auto2(H5E_DEFAULT, before, data);
}

TEST_CASE("a dataset of the file's own version that is missing is refused by name") {
  const Folder folder;
  const io::SpecimenOrigin origin{"[pack]\n", 1, 2, 0.5};
  io::write_specimen(random_specimen(6), folder / "s.h5", &origin);
  test::write_records(random_result(6), random_specimen(7), "[test]\n", folder / "r.h5");
  for (const std::string name : {"s.h5", "r.h5"}) {
    const auto read = [&](const std::string& path) {
      return input_error([&] {
        io::read_origin(path);
        name == "s.h5" ? void(io::read_specimen(path)) : void(io::read_recorded_test(path));
      });
    };
    CHECK(read(folder / name).empty());
    const auto entries = io::Hdf5File::open(folder / name).entries();
    CHECK(entries.size() > 90);
    for (const io::Hdf5Entry& entry : entries) {
      CAPTURE(entry.name);
      const std::string path = folder / "x.h5";
      std::filesystem::copy_file(folder / name, path, std::filesystem::copy_options::overwrite_existing);
      change(path, [&](hid_t file) { H5Ldelete(file, entry.name.c_str(), H5P_DEFAULT); });
      CHECK_THAT(read(path), Contains("x.h5: dataset " + entry.name + " is missing"));
    }
  }
}
