// Specimen files: out and back bitwise, whole or not at all, and a clear word for what is no specimen.
#include "rvelab/io/hdf5/specimen_file.hpp"

#include <sys/stat.h>

#include "random_specimen.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("a specimen comes back from its file bit for bit, whatever its fields hold") {
  const Folder folder;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Specimen written = random_specimen(seed);
    io::write_specimen(written, folder / "s.h5");
    const Specimen read = io::read_specimen(folder / "s.h5");
    CHECK(differing_fields(written, read).empty());
  }
}

TEST_CASE("the comparison of specimens sees one flipped bit") {
  const Specimen a = random_specimen(3);
  Specimen b = a;
  std::uint64_t bits;
  std::memcpy(&bits, &b.state.last_step.mean_spin[2], sizeof bits);
  bits ^= 1;
  std::memcpy(&b.state.last_step.mean_spin[2], &bits, sizeof bits);
  CHECK(differences(a, a) == 0);
  CHECK(differences(a, b) == 1);
}

TEST_CASE("a specimen without contacts comes back as it was, one without grains is refused") {
  const Folder folder;
  Specimen written = random_specimen(4, 1, 0);
  io::write_specimen(written, folder / "one.h5");
  CHECK(differences(written, io::read_specimen(folder / "one.h5")) == 0);
  CHECK(io::read_specimen(folder / "one.h5").contacts.empty());
  written.grains = {};
  io::write_specimen(written, folder / "none.h5");
  CHECK_THAT(input_error([&] { io::read_specimen(folder / "none.h5"); }), Contains("/grains/id: 0 grains"));
}

TEST_CASE("the same specimen gives the same bytes, at any time and place") {
  const Folder folder, other;
  io::write_specimen(random_specimen(5), folder / "a.h5");
  io::write_specimen(random_specimen(5), other / "b.h5");
  CHECK(bytes_of(folder / "a.h5") == bytes_of(other / "b.h5"));
  CHECK(!std::filesystem::exists(folder / "a.h5.tmp"));
}

TEST_CASE("constants of laws that no material has are in no file of it") {
  const Folder folder;
  Specimen specimen = random_specimen(6);
  for (Material& m : specimen.materials) m.roughness = m.cone_slope = 0;
  const auto checksum = io::digest(specimen);
  io::write_specimen(specimen, folder / "without.h5");
  const auto has = [&](const char* file, const char* name) {
    return io::Hdf5File::open(folder / file).has(std::string("/materials/") + name);
  };
  CHECK(!has("without.h5", "roughness_m"));
  CHECK(!has("without.h5", "cone_slope"));
  CHECK(has("without.h5", "adhesion_N"));
  CHECK(differing_fields(specimen, io::read_specimen(folder / "without.h5")).empty());
  specimen.materials.back().roughness = 2e-7;
  CHECK(io::digest(specimen) != checksum);
  io::write_specimen(specimen, folder / "with.h5");
  CHECK(has("with.h5", "roughness_m"));
  CHECK(!has("with.h5", "cone_slope"));
  CHECK(differing_fields(specimen, io::read_specimen(folder / "with.h5")).empty());
}

TEST_CASE("how a specimen was packed comes back from its file, and changes nothing else in it") {
  const Folder folder;
  const Specimen written = random_specimen(9);
  const io::SpecimenOrigin origin{"[pack]\nname = \"sand\"\n", 18446744073709551615u, 37, 0.02};
  io::write_specimen(written, folder / "packed.h5", &origin);
  io::write_specimen(written, folder / "plain.h5");
  const auto read = io::read_origin(folder / "packed.h5");
  REQUIRE(read);
  CHECK(read->recipe == origin.recipe);
  CHECK(read->seed == origin.seed);
  CHECK(read->draw == origin.draw);
  CHECK(read->preparation_friction == origin.preparation_friction);
  CHECK(!read->expansion);  // as of files written before it was stored
  CHECK(!read->strain_difference);
  io::SpecimenOrigin agitated = origin;
  agitated.expansion = 0.0057;
  agitated.strain_difference = -0.25;
  io::write_specimen(written, folder / "agitated.h5", &agitated);
  CHECK(io::read_origin(folder / "agitated.h5")->expansion == 0.0057);
  CHECK(io::read_origin(folder / "agitated.h5")->strain_difference == -0.25);
  CHECK(!io::compare_files(folder / "packed.h5", folder / "agitated.h5").difference);
  CHECK(differences(written, io::read_specimen(folder / "packed.h5")) == 0);
  CHECK(!io::read_origin(folder / "plain.h5"));
  CHECK_THAT(input_error([&] { io::read_origin(folder / "none.h5"); }), Contains("no such file"));
}

TEST_CASE("a file that cannot be written leaves the one that was there") {
  const Folder folder;
  const Specimen first = random_specimen(6);
  io::write_specimen(first, folder / "s.h5");
  std::filesystem::create_directory(folder / "s.h5.tmp");  // the place of the temporary is taken
  CHECK_THAT(input_error([&] { io::write_specimen(random_specimen(7), folder / "s.h5"); }), Contains("s.h5"));
  CHECK(differences(first, io::read_specimen(folder / "s.h5")) == 0);
  CHECK_THAT(input_error([&] { io::write_specimen(first, folder / "missing/s.h5"); }), Contains("existing folder"));
}

TEST_CASE("a full disc is one error, and the published file stays") {
  if (!std::filesystem::exists("/dev/full")) return;
  const Folder folder;
  std::filesystem::create_symlink("/dev/full", folder / "s.h5.tmp");
  write_bytes(folder / "s.h5", "what was there");
  CHECK_THROWS_WITH(io::write_specimen(random_specimen(8), folder / "s.h5"),
                    Contains("s.h5") && Contains("No space left") && Contains("untouched"));
  CHECK(bytes_of(folder / "s.h5") == "what was there");
}

TEST_CASE("what is no specimen file is refused with its name and the reason") {
  const Folder folder;
  const auto message = [&](const std::string& name) { return input_error([&] { io::read_specimen(folder / name); }); };
  CHECK_THAT(message("none.h5"), Contains("none.h5"));
  CHECK_THAT(input_error([&] { io::read_specimen(folder / ""); }), Contains("not a regular file"));
  write_bytes(folder / "text.h5", "id,x,y,r\n");
  CHECK_THAT(message("text.h5"), Contains("not an HDF5 file"));
  write_bytes(folder / "empty.h5", "");
  CHECK_THAT(message("empty.h5"), Contains("not an HDF5 file"));
  io::publish(folder / "foreign.h5", [](io::Hdf5File& file) { file.write_text("/note", {"of another program"}, {}); });
  CHECK_THAT(message("foreign.h5"), Contains("format is \"\""));
}

TEST_CASE("a file cut anywhere is refused, never read in part") {
  const Folder folder;
  io::write_specimen(random_specimen(9), folder / "whole.h5");
  const std::string whole = bytes_of(folder / "whole.h5");
  for (std::size_t k = 0; k < 40; ++k) {
    write_bytes(folder / "cut.h5", whole.substr(0, whole.size() * k / 40));
    CHECK_THAT(input_error([&] { io::read_specimen(folder / "cut.h5"); }), Contains("cut.h5"));
  }
  write_bytes(folder / "cut.h5", whole.substr(0, whole.size() - 1));
  CHECK_THAT(input_error([&] { io::read_specimen(folder / "cut.h5"); }), Contains("truncated"));
}

TEST_CASE("a file of another version of the format is refused, and what to do is said") {
  const Folder folder;
  const auto with_version = [&](const std::string& version) {
    io::publish(folder / "v.h5", [&](io::Hdf5File& file) {
      file.set_attribute("format", "rvelab specimen");
      file.set_attribute("format_version", version);
      io::put_specimen(file, "", random_specimen(10));
    });
    return input_error([&] { io::read_specimen(folder / "v.h5"); });
  };
  CHECK(with_version("2.1").empty());
  for (const std::string version : {"1.12", "2.0", "3.0", "one"}) {
    CHECK_THAT(with_version(version),
               Contains("v.h5: has the format version \"" + version + "\"; this program reads 2.1") &&
                   Contains("make the file again") && Contains("/provenance"));
  }
}

TEST_CASE("a file whose parts contradict each other is refused") {
  const Folder folder;
  const auto message = [&](auto change) {
    Specimen specimen = random_specimen(11);
    change(specimen);
    io::write_specimen(specimen, folder / "s.h5");
    return input_error([&] { io::read_specimen(folder / "s.h5"); });
  };
  CHECK(message([](Specimen&) {}).empty());
  CHECK_THAT(message([](Specimen& s) { s.grains.radius.pop_back(); }),
             Contains("/grains/radius_m has 16 rows; allowed: 17"));
  CHECK_THAT(message([](Specimen& s) { s.grains.material[3] = 3; }), Contains("/grains/material[3]"));
  CHECK_THAT(message([](Specimen& s) { s.contacts[2].j = 17; }), Contains("contacts/j[2] = 17"));
  CHECK_THAT(message([](Specimen& s) { s.contacts[2].i = s.contacts[2].j + 1; }), Contains("i <= j"));
  CHECK_THAT(message([](Specimen& s) { s.cell.dimension = 4; }), Contains("/cell/dimension = 4"));
}

TEST_CASE("a dataset that is missing, of another kind or shape is named") {
  const Folder folder;
  const auto message = [&](auto extra) {
    io::publish(folder / "p.h5", [&](io::Hdf5File& file) {
      io::stamp(file, io::FileKind::specimen);
      extra(file);
    });
    return input_error([&] { io::read_specimen(folder / "p.h5"); });
  };
  CHECK_THAT(message([](io::Hdf5File&) {}), Contains("/shape"));
  const double number = 2;
  CHECK_THAT(message([&](io::Hdf5File& file) {
               file.write<double>("/shape", {&number, 1}, {}, "1");
             }),
             Contains("/shape"));
  CHECK_THAT(message([&](io::Hdf5File& file) { file.write_text("/shape", {"cube"}, {}); }), Contains("/shape"));
  CHECK_THAT(message([&](io::Hdf5File& file) {
               file.write_text("/shape", {"disc"}, {});
               file.write<double>("/cell/dimension", {&number, 1}, {}, "1");
             }),
             Contains("/cell/dimension"));
  CHECK_THAT(message([&](io::Hdf5File& file) {
               file.write_text("/shape", {"disc", "disc"}, {2});
             }),
             Contains("/shape"));
}
