// What fuzzing found, one test for each.
#include <hdf5.h>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/seal.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/import/csv.hpp"
#include "rvelab/io/journal/record_journal.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/protocol/protocol.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/solver/rve.hpp"
#include "rvelab/solver/snapshot.hpp"
#include "tests/catch.hpp"
#include "tests/fuzz/formats.hpp"
#include "tests/fuzz/seeds.hpp"
#include "tests/io/nine_discs.hpp"
#include "tests/io/random_specimen.hpp"

using namespace rvelab;
using namespace rvelab::fuzz;
using Catch::Matchers::Contains;
using test::input_error;

namespace {

Specimen nine_grains() { return test::nine_discs(); }

/// An HDF5 file as another program leaves it that changes something in it.
template <class Change>
std::string changed(View image, Change change) {
  const test::Folder folder;
  const std::string path = folder / "changed.h5";
  test::write_bytes(path, std::string(reinterpret_cast<const char*>(image.data()), image.size()));
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(file >= 0);
  change(file);
  H5Fclose(file);
  return test::bytes_of(path);
}

}  // namespace

TEST_CASE("a whole number that no double holds is a number like any other") {
  Specimen specimen = nine_grains();
  keys::set_key(specimen, "solver.min_height_m=9007199254740993");
  CHECK(specimen.solver.min_height == 9007199254740992.0);
  CHECK_THAT(input_error([&] { keys::set_key(specimen, "damping.local=9223372036854775807"); }),
             Contains("damping.local = 9223372036854775807 is out of range"));

  const std::string shear = "[test]\nname = \"t\"\n[[stage]]\nkind = \"simple_shear\"\nto_strain = 0.1\n";
  CHECK_THAT(input_error([&] { protocol::parse_protocol(shear + "record_every = -9223372036854775807\n", "t.toml"); }),
             Contains("record_every = -9223372036854775807 is out of range"));
  CHECK_THAT(input_error([&] {
               protocol::parse_protocol(
                   "[test]\nname = \"t\"\n[[stage]]\nkind = \"pressure_path\"\nto_Pa = [1e5, \"\", 2e5]\n", "t.toml");
             }),
             Contains("to_Pa"));
  const std::string path = "[test]\nname = \"t\"\n[[stage]]\nkind = \"deformation\"\n";
  const protocol::Protocol far =
      protocol::parse_protocol(path + "gradients = [[9223372036854775807, 0, 0, 1]]\n", "t.toml");
  CHECK(protocol::settings_of<protocol::DeformationStage>(far.stages.at(0))->gradients.at(0)(0, 0) ==
        9223372036854775808.0);
}

TEST_CASE("a number beyond all doubles in META.json is a mistake of the file") {
  const test::Folder folder;
  test::write_bytes(folder / "m.json", "{\"dim\": 2, \"thickness_m\": 1e999}");
  CHECK_THAT(input_error([&] { io::import_csv(data_file("nine_discs/grains.csv"), {}, folder / "m.json"); }),
             Contains("m.json: is not JSON") && Contains("1e999"));
}

TEST_CASE("a sealed file whose dataset says that it is larger than what is stored of it is refused by name") {
  const test::Folder folder;
  const Bytes whole = specimen_seed();
  std::string bytes = changed(View(whole).first(whole.size() - io::seal_bytes), [](hid_t file) {
    const hsize_t rows = hsize_t{1} << 40;  // none of which is written
    const hid_t space = H5Screate_simple(1, &rows, nullptr);
    H5Ldelete(file, "/grains/radius_m", H5P_DEFAULT);
    H5Dclose(H5Dcreate2(file, "/grains/radius_m", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
  });
  const auto seal = io::seal_of(std::as_bytes(std::span(bytes)));
  bytes.append(reinterpret_cast<const char*>(seal.data()), seal.size());
  test::write_bytes(folder / "s.h5", bytes);
  CHECK_THAT(input_error([&] { io::read_specimen(folder / "s.h5"); }),
             Contains("/grains/radius_m says that it is larger than what is stored of it"));
}

TEST_CASE("a journal whose columns have no width is refused, and no row is read by it") {
  const test::Folder folder;
  const Specimen specimen = nine_grains();
  const std::string begin =
      changed(io::encode_begin({"test", "[test]\nname = \"test\"\n", {"shear"}, specimen}), [](hid_t file) {
        const hid_t dataset = H5Dopen2(file, "/journal/column_bytes", H5P_DEFAULT);
        std::int64_t bytes[256] = {};
        H5Dread(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
        bytes[0] = -1;
        H5Dwrite(dataset, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
        H5Dclose(dataset);
      });
  const std::string path = folder / "run.h5.journal";
  {
    io::Journal journal(path);
    journal.begin();
    journal.append(io::begin_frame, std::as_bytes(std::span(begin)));
    journal.append(io::record_frame, io::encode_record(0, records::Record{}));
  }
  CHECK_THAT(input_error([&] { io::read_record_journal(path); }), Contains("its list of columns is damaged"));
}

TEST_CASE("a state whose stress or void ratio is beyond all numbers is refused when it is opened") {
  Specimen specimen = nine_grains();
  specimen.cell.lattice(2, 2) = 1e-310;  // the thickness
  CHECK_THAT(input_error([&] { Rve rve(specimen); }), Contains("make a mass of"));
  specimen.cell.lattice(2, 2) = 1e-320;
  CHECK_THAT(input_error([&] { Rve rve(specimen); }), Contains("grains of 0 m^3 in a cell of"));
  specimen = nine_grains();
  specimen.grains.radius.assign(specimen.grains.size(), 1e-170);
  CHECK_THAT(input_error([&] { Rve rve(specimen); }), Contains("grains of 0 m^3 in a cell of 9e-05 m^3"));
}

TEST_CASE("a strain increment per sub-step out of all proportion leaves an increment that is made or refused") {
  for (const double target : {1e-322, 1e300})
    for (const double pace : {1e-322, 1e-6, 1e300}) {
      CAPTURE(target, pace);
      Specimen specimen = nine_grains();
      specimen.state.control.strain_per_step = pace;
      specimen.state.control.target_unbalanced_ratio = target;
      Matrix3 increment = Matrix3::Zero();
      if (pace > 1)
        specimen.state.control.deferred.stretch(1, 1) = 1.0087890625;
      else
        increment(1, 1) = 1e-4;
      Rve rve(specimen);
      try {
        rve.apply(increment, 0);
        CHECK(rve.stress().allFinite());
      } catch (const Error& error) {
        CHECK_THAT(error.what(), Contains("max_substeps"));
      }
    }
}

// Who looked at the grains made it: 1e7 sub-steps and more.
TEST_CASE("a deferred stretch of more than a sub-step is refused by name") {
  Specimen specimen = nine_grains();
  specimen.state.control.strain_per_step = 1e-6;
  specimen.state.control.deferred.stretch(1, 1) = 1 + 0.9e-6;
  CHECK_NOTHROW(Rve(specimen).network());
  specimen.state.control.deferred.stretch(1, 1) = 1 + 1.1e-6;
  CHECK_THAT(input_error([&] { Rve{specimen}; }), Contains("strain_per_step = 1e-06"));
}

TEST_CASE("a snapshot with any one byte another and a head that fits is refused, or is a state") {
  const auto snapshot =
      std::find_if(formats().begin(), formats().end(), [](const Format& format) { return format.name == "snapshot"; });
  const Bytes seed = snapshot->seeds().at(0);
  std::size_t refused = 0;
  for (std::size_t at = sizeof(SnapshotHead); at < seed.size(); ++at) {
    for (const auto value : {std::byte{0x03}, std::byte{0x07}, std::byte{0xff}}) {
      Bytes input = seed;
      input[at] = value;
      CAPTURE(at, std::to_integer<int>(value));
      Answer answer = Answer::taken;
      REQUIRE_NOTHROW(answer = snapshot->check(input));
      refused += answer == Answer::refused ? 1 : 0;
    }
  }
  CHECK(refused > 0);
}
