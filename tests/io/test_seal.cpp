// Damaged files: what rvelab writes carries a checksum that is held against every bit before anything reads it.
#include "rvelab/io/hdf5/seal.hpp"

#include <hdf5.h>

#include <algorithm>
#include <limits>
#include <random>

#include "nine_discs.hpp"
#include "random_specimen.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/catch.hpp"
#include "tests/io/record_files.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

void write_random_records(const std::string& path) {
  test::write_records(random_result(2), random_specimen(3), "[test]\nname = \"any\"\n", path);
}

/// As h5py leaves a file that it opened for writing: HDF5 cuts off what stands behind its own end.
void open_for_writing(const std::string& path, const std::string& dataset, double value) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(file >= 0);
  const hid_t set = H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
  REQUIRE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value) >= 0);
  H5Dclose(set);
  H5Fclose(file);
}

void write_variable_length(hid_t file, const char* name) {
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, H5T_VARIABLE);
  const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const char* const text = "text";
  REQUIRE(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &text) >= 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Tclose(type);
}

/// Datasets and attributes of an open file whose values have a variable length.
int variable_lengths(hid_t file) {
  int found = 0;
  const auto look = [](hid_t object, const char* name, const H5O_info_t* info, void* count) -> herr_t {
    const auto count_in = [&](hid_t type) {
      if (H5Tdetect_class(type, H5T_VLEN) > 0 || H5Tis_variable_str(type) > 0) ++*static_cast<int*>(count);
      H5Tclose(type);
    };
    const hid_t opened = H5Oopen(object, name, H5P_DEFAULT);
    if (info->type == H5O_TYPE_DATASET) count_in(H5Dget_type(opened));
    for (int k = 0; k < H5Aget_num_attrs(opened); ++k) {
      const hid_t attribute =
          H5Aopen_by_idx(opened, ".", H5_INDEX_NAME, H5_ITER_INC, hsize_t(k), H5P_DEFAULT, H5P_DEFAULT);
      count_in(H5Aget_type(attribute));
      H5Aclose(attribute);
    }
    H5Oclose(opened);
    return 0;
  };
  REQUIRE(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, look, &found, H5O_INFO_BASIC) >= 0);
  H5Fclose(file);
  return found;
}

int variable_lengths(const std::string& path) {
  return variable_lengths(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
}

}  // namespace

TEST_CASE("every single flipped bit of a specimen or record file is refused before anything reads it") {
  const Folder folder;
  io::write_specimen(random_specimen(1), folder / "s.h5");
  write_random_records(folder / "r.h5");
  std::mt19937 random(13);
  for (const std::string name : {"s.h5", "r.h5"}) {
    const std::string whole = bytes_of(folder / name);
    const auto read = [&] {
      name == "s.h5" ? void(io::read_specimen(folder / "x.h5")) : void(test::read_records(folder / "x.h5"));
    };
    for (int k = 0; k < 300; ++k) {
      // Every fourth in the last bytes, where the checksum itself stands.
      const std::size_t from = k % 4 == 0 ? whole.size() - io::seal_bytes : 0;
      const std::size_t at = from + random() % (whole.size() - from);
      std::string flipped = whole;
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << random() % 8));
      write_bytes(folder / "x.h5", flipped);
      CAPTURE(name, at);
      CHECK_THAT(input_error(read), Contains("x.h5: ") && (Contains("is damaged") || Contains("checksum")));
    }
    write_bytes(folder / "x.h5", whole);
    CHECK(input_error(read).empty());
  }
}

TEST_CASE("bytes added, taken away or exchanged are refused as a flipped bit is") {
  const Folder folder;
  io::write_specimen(random_specimen(1), folder / "s.h5");
  const std::string whole = bytes_of(folder / "s.h5");
  const auto refused = [&](std::string bytes) {
    write_bytes(folder / "x.h5", bytes);
    return input_error([&] { io::read_specimen(folder / "x.h5"); });
  };
  const std::size_t content = whole.size() - io::seal_bytes;
  CHECK_THAT(refused(whole.substr(0, content / 2) + whole.substr(content / 2 + 8)), Contains("its seal says"));
  CHECK_THAT(refused(whole.substr(0, 4096) + std::string(8, '\0') + whole.substr(4096)), Contains("its seal says"));
  CHECK_THAT(refused(whole.substr(0, content)), Contains("truncated") && Contains("rvelab seal"));
  CHECK_THAT(refused(whole + "more"), Contains("truncated") && Contains("rvelab seal"));
  CHECK_THAT(refused(whole.substr(content)), Contains("is damaged"));
}

TEST_CASE("nothing of variable length is written, in files or in the frames of a journal") {
  const Folder folder;
  const io::SpecimenOrigin origin{"[pack]\n", 1, 2, 0.5};
  io::write_specimen(random_specimen(1), folder / "s.h5", &origin);
  write_random_records(folder / "r.h5");
  const io::RunStart start{"any", "[test]\n", {"a", "a longer one"}, random_specimen(1)};
  const auto frame = [&](const std::vector<std::byte>& bytes, std::size_t number_bytes) {
    write_bytes(folder / "f.h5",
                {reinterpret_cast<const char*>(bytes.data()) + number_bytes, bytes.size() - number_bytes});
    return variable_lengths(folder / "f.h5");
  };
  CHECK(variable_lengths(folder / "s.h5") == 0);
  CHECK(variable_lengths(folder / "r.h5") == 0);
  CHECK(frame(io::encode_begin(start), 0) == 0);
  CHECK(frame(io::encode_checkpoint(random_checkpoint(1)), 0) == 0);
  CHECK(frame(io::encode_snapshot(1, random_specimen(2)), 8) == 0);
  const hid_t file = H5Fopen((folder / "s.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  write_variable_length(file, "/text");
  CHECK(variable_lengths(file) == 1);  // the count sees it
}

TEST_CASE("texts come back as they were: empty, of any length, of any alphabet") {
  const Folder folder;
  const std::vector<std::string> texts{"", "a", std::string(100'000, 'x'), "Körnung ≤ 2 mm\n\ttan φ", ""};
  io::publish(folder / "t.h5", [&](io::Hdf5File& file) {
    file.write_text("/list", texts, {5});
    file.write_text("/none", {}, {0});
    file.write_text("/empty", {""}, {});
    file.set_attribute("words", "Reibung µ");
  });
  const auto file = io::Hdf5File::open(folder / "t.h5");
  CHECK(file.sealed());
  CHECK(file.read_text("/list") == texts);
  CHECK(file.read_text("/none").empty());
  CHECK(file.read_text("/empty") == std::vector<std::string>{""});
  CHECK(file.attribute("words") == "Reibung µ");
}

TEST_CASE("a file that another program changed is refused, and taken over when it is sealed") {
  const Folder folder;
  Specimen specimen = nine_discs();
  io::write_specimen(specimen, folder / "s.h5");
  open_for_writing(folder / "s.h5", "/solver/skin", 0.125);
  CHECK_THAT(
      input_error([&] { io::read_specimen(folder / "s.h5"); }),
      Contains("another program has changed it") && Contains("`rvelab seal " + (folder / "s.h5") + " -o NEW.h5`"));
  CHECK_THAT(input_error([&] { io::compare_files(folder / "s.h5", folder / "s.h5"); }), Contains("rvelab seal"));
  const io::SealedFile sealed = io::seal_file(folder / "s.h5", folder / "new.h5");
  CHECK(!sealed.had_seal);
  CHECK(sealed.kind == io::FileKind::specimen);
  specimen.solver.skin = 0.125;
  CHECK(differences(io::read_specimen(folder / "new.h5"), specimen) == 0);
  io::write_specimen(specimen, folder / "straight.h5");
  CHECK(!test::first_difference(folder / "new.h5", folder / "straight.h5"));
  // What no RVE can be made of would only be refused when it is used.
  for (const double skin : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    io::write_specimen(specimen, folder / "edited.h5");
    open_for_writing(folder / "edited.h5", "/solver/skin", skin);
    CHECK_THAT(input_error([&] { io::seal_file(folder / "edited.h5", folder / "y.h5"); }),
               Contains("edited.h5: ") && Contains("skin") && Contains("nothing was written"));
    CHECK(!std::filesystem::exists(folder / "y.h5"));
  }
  // What does not fit its checksum is damaged and not edited; and what is no longer a specimen is not sealed.
  std::string bytes = bytes_of(folder / "new.h5");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_bytes(folder / "x.h5", bytes);
  CHECK_THAT(input_error([&] { io::seal_file(folder / "x.h5", folder / "y.h5"); }), Contains("x.h5: is damaged"));
  open_for_writing(folder / "new.h5", "/cell/dimension", 4);
  CHECK_THAT(input_error([&] { io::seal_file(folder / "new.h5", folder / "y.h5"); }), Contains("/cell/dimension = 4"));
  CHECK(!std::filesystem::exists(folder / "y.h5"));
}

TEST_CASE("a record file that another program changed is sealed with all that it holds") {
  const Folder folder;
  test::write_records(random_result(2), nine_discs(), "[test]\nname = \"any\"\n", folder / "r.h5");
  const std::string protocol = test::read_protocol_text(folder / "r.h5");
  std::filesystem::copy_file(folder / "r.h5", folder / "old.h5");
  open_for_writing(folder / "r.h5", "/test/pressure_Pa", 5e4);
  const io::SealedFile sealed = io::seal_file(folder / "r.h5", folder / "new.h5");
  CHECK(sealed.kind == io::FileKind::records);
  CHECK(io::Hdf5File::open(folder / "new.h5").sealed());
  CHECK(test::read_records(folder / "new.h5").pressure == 5e4);
  CHECK(test::read_protocol_text(folder / "new.h5") == protocol);
  CHECK_THAT(test::first_difference(folder / "old.h5", folder / "new.h5").value(), Contains("/test/pressure_Pa"));
}
