// Data files of LAMMPS, and files that are packed by gzip: the same grains, or a refusal.
#include "tests/gzipped.hpp"
#include "tests/io/four_spheres.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::string exchanged(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a data file of atom_style sphere holds the grains of its tilted box") {
  expect_four_spheres(read_as(data_of({})));
  expect_four_spheres(read_as(data_of({}, "")));
  expect_four_spheres(read_as(exchanged(data_of({}), " 0 -1 2\n", " 0 -1 2   # the first\r\n")));
  CHECK(read_as(data_of({})).told.empty());
  const Read denser = read_as(exchanged(data_of({}), " 2650 ", " 2700 "));
  CHECK_THAT(said(denser), Contains("density = 2700 kg/m3, and that of the material is 2650 kg/m3"));
}

TEST_CASE("header lines and sections of a data file come in any order") {
  const std::string whole = data_of({});
  const auto atoms = whole.find("Atoms"), velocities = whole.find("Velocities"), box = whole.find("-0.5 0.5 xlo");
  const std::string title = "made by hand\n\n", count = "4 atoms # grains\n", types = "2 atom types\n0 bonds\n";
  const std::string bounds = whole.substr(box, atoms - box), rows = whole.substr(atoms, velocities - atoms) + "\n";
  const std::string masses = "Masses\n\n1 1.5\n2 0.5\n\n", motion = whole.substr(velocities) + "\n";
  for (const std::string& text : {title + bounds + types + count + masses + rows + motion,
                                  title + types + bounds + count + motion + rows + masses,
                                  title + count + bounds + rows + "Pair Coeffs # gran/hertz/history\n\n1 7e9 0.25\n"}) {
    CAPTURE(text);
    expect_four_spheres(read_as(text));
  }
  CHECK_THAT(read_as(title + count + rows).error, Contains("no line of xlo xhi stands before the atoms"));
  CHECK_THAT(read_as(title + bounds + rows).error, Contains("no line \"N atoms\""));
  CHECK_THAT(read_as(title + count + count + bounds + rows).error, Contains("4 atoms # grains stands twice"));
  CHECK_THAT(read_as(title + count + bounds + motion).error, Contains("no section Atoms"));
  CHECK_THAT(read_as(title + count + exchanged(bounds, "-0.5 0.5 xlo", "0.5 xlo") + rows).error,
             Contains("is no such line of the box; allowed: 2 numbers"));
}

TEST_CASE("a data file of a general triclinic box is the same packing") {
  const FourSpheres four;
  const std::string whole = data_of(four);
  const auto box = whole.find("-0.5 0.5 xlo"), atoms = whole.find("Atoms");
  const char* names[] = {" avec\n", " bvec\n", " cvec\n"};
  std::string general;
  for (int k = 0; k < 3; ++k) general += digits(Vector3(four.cell.col(k))) + names[k];
  general += digits(four.low) + " abc origin\n\n";
  expect_four_spheres(read_as(whole.substr(0, box) + general + whole.substr(atoms)));
  CHECK_THAT(read_as(whole.substr(0, box) + general + whole.substr(box)).error,
             Contains("both avec, bvec, cvec and xlo xhi"));
}

TEST_CASE("another atom_style, and units without metres, are refused by name") {
  for (const std::string style : {"atomic", "ellipsoid", "hybrid sphere bond", "bpm/sphere"})
    CHECK_THAT(read_as(data_of({}, " # " + style)).error, Contains("Atoms # " + style));
  CHECK_THAT(read_as(exchanged(data_of({}, ""), "1 atom types", "3 ellipsoids")).error,
             Contains("ellipsoids are of another"));
  CHECK_THAT(read_as(exchanged(data_of({}, ""), "1 atom types", "3 bonds")).error, Contains("atoms with bonds"));
  CHECK_THAT(read_as(exchanged(data_of({}), " 2650 ", " ")).error,
             Contains("the row of Atoms has 9 columns; allowed: id type"));
  CHECK_THAT(read_as(exchanged(data_of({}, ""), "LAMMPS data file", "LIGGGHTS Description")).error,
             Contains("YADE's liggghts_in has the radius for the diameter"));
  const std::string units = "timestep = 0, units = ";
  expect_four_spheres(read_as(exchanged(data_of({}), "timestep = 0", units + "si")));
  CHECK_THAT(read_as(exchanged(data_of({}), "timestep = 0", units + "lj")).error,
             Contains("in.txt:1: the units are lj"));
}

TEST_CASE("a data file cut anywhere is refused, unless whole sections are missing at its end") {
  const std::string whole = data_of({});
  const auto velocities = whole.find("\nVelocities");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    CAPTURE(size);
    const Read read = read_as(whole.substr(0, size));
    if (size == velocities || size == velocities + 1) {
      expect_four_spheres(read);
    } else {
      REQUIRE(!read.error.empty());
    }
  }
  CHECK_THAT(read_as(exchanged(whole, "4 atoms", "5 atoms")).error,
             Contains("the section Atoms has 4 rows, and the file says 5"));
  CHECK_THAT(read_as(exchanged(whole, "4 atoms", "3 atoms")).error,
             Contains("the section Atoms has 4 rows, and the file says 3"));
}

TEST_CASE("files that gzip has packed are read, in several members too") {
  const std::string dump = frame_of({}, 100);
  expect_four_spheres(read_as(gzipped(dump)));
  expect_four_spheres(read_as(gzipped(data_of({}))));
  expect_four_spheres(read_as(gzipped(dump.substr(0, 200)) + gzipped(dump.substr(200)) + std::string(8, '\0')));
}

TEST_CASE("a packed file that is cut, damaged or grows beyond all text is refused, and takes no memory") {
  const std::string packed = gzipped(frame_of({}, 100));
  for (std::size_t size = 2; size < packed.size(); ++size) {
    CAPTURE(size);
    CHECK_THAT(read_as(packed.substr(0, size)).error, Contains("the gzip file ends early"));
  }
  std::string damaged = packed;
  damaged[damaged.size() - 6] ^= 1;  // its checksum
  CHECK_THAT(read_as(damaged).error, Contains("the gzip file is damaged"));
  CHECK_THAT(read_as(packed + "more").error, Contains("other bytes follow the gzip data"));
  const std::string bomb = gzipped(std::string(100 << 20, '\n'));
  CHECK_THAT(read_as(bomb).error, Contains("unpacks to more than") && Contains("gunzip"));
}

TEST_CASE("a file that is no text is named as what it is, packed or not, with what makes a text of it") {
  using namespace std::string_literals;
  const std::string number(8, '\x01'), rest(40, '\xff');
  const struct {
    std::string head;
    const char *what, *remedy;
  } files[] = {
      {"LammpS RestartT\0"s, "a binary restart file of LAMMPS", "write_data"},
      {number + "DUMPCUSTOM", "a binary dump of LAMMPS", "write_dump"},
      {"\x89HDF\r\n\x1a\n", "an HDF5 file", "rvelab export"},
      {"\x28\xb5\x2f\xfd", "packed by zstd", "unzstd"},
      {"BZh9", "packed by bzip2", "bunzip2"},
      {"PK\x03\x04", "packed by zip", "as CSV"},
      {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "a workbook of Excel (.xls)", "as CSV"},
      {"\x93NUMPY\x01\0"s, "an array of numpy (.npy)", "numpy.savetxt"},
      {"# vtk DataFile Version 3.0\npacking\nBINARY\n", "a VTK file", "ParaView"},
      {"<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">", "a VTK file", "ParaView"},
      {"\x16\0\0\0\0\0\0\0serialization::archive"s, "a save of YADE", "export.text"},
      {"<?xml version=\"1.0\"?>\n<!DOCTYPE boost_serialization>", "a save of YADE", "export.text"},
  };
  for (const auto& [head, what, remedy] : files) {
    CAPTURE(what);
    for (const std::string& bytes : {head + rest, gzipped(head + rest)})
      CHECK_THAT(read_as(bytes).error, Contains(std::string("is ") + what + "; allowed: text") && Contains(remedy));
    CHECK_THAT(input_error([&, &head = head] { keys::parse_toml_text(head + rest, "r.toml"); }),
               Contains(std::string("r.toml: is ") + what + ", not TOML"));
  }
}
