// Tables of other programs: YADE's export.text and SpherePack, spreadsheets, tables without ids.
#include "tests/io/four_spheres.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// An upright cell, as --cell gives it.
FourSpheres upright() {
  FourSpheres four;
  four.cell = Vector3(1, 1.25, 0.75).asDiagonal();
  return four;
}

io::ImportOptions in_cell() {
  io::ImportOptions options;
  options.cell = upright().cell.diagonal();
  return options;
}

/// Rows "x y z r" with what stands before and behind each.
std::string table_of(const std::string& head, const std::string& delimiter, bool with_id, bool comma = false,
                     const std::string& end = "\n", const std::vector<std::string>& more = {}) {
  std::string text = head;
  const FourSpheres four = upright();
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& [at, radius] = four.grains[k];
    std::string row = with_id ? std::to_string(k + 1) + delimiter : "";
    row += digits(at[0]) + delimiter + digits(at[1]) + delimiter + digits(at[2]) + delimiter + digits(radius);
    if (comma) std::replace(row.begin(), row.end(), '.', ',');
    text += row + (more.empty() ? "" : delimiter + more[k]) + end;
  }
  return text;
}

}  // namespace

TEST_CASE("YADE's export.text is read: its format names the columns, apart by tabs or blanks") {
  const Read read = read_as(table_of("#format x_y_z_r\n", "\t", false), in_cell());
  expect_four_spheres(read, upright());
  CHECK_THAT(said(read), Contains("no column id: grains are numbered from 1"));
  expect_four_spheres(read_as(table_of("#format x_y_z_r\n# made by YADE, of four grains\n", "  ", false), in_cell()),
                      upright());
  expect_four_spheres(read_as(table_of("#format x_y_z_r\r\n\r\n", " \t", false, false, "\r\n"), in_cell()), upright());
  expect_four_spheres(
      read_as(table_of("#format id_x_y_z_r_matId\n", "\t", true, false, "\n", {"1", "1", "0", "1"}), in_cell()),
      upright());
  expect_four_spheres(
      read_as(table_of("#format x_y_z_r_attrs\n# x y z r b.mask\n", "\t", false, false, "\n", {"1", "2", "3", "4"}),
              in_cell()),
      upright());
  expect_four_spheres(
      read_as(table_of("#format x_y_z_r_attrs\n", "\t", false, false, "\n", {"1\t5", "2\t5", "3\t5", "4\t5"}),
              in_cell()),
      upright());
  CHECK_THAT(read_as(table_of("#format x_y_r\n", "\t", false), in_cell()).error,
             Contains("in.txt:2: the row has 4 cells; allowed: those of #format x_y_r, 3"));
  CHECK_THAT(read_as("#format x_y_z_r\n0 0 0 0.1\n0 0 0\n", in_cell()).error,
             Contains("in.txt:3: the row has 3 cells"));
}

TEST_CASE("matId of YADE numbers the materials from 0") {
  const Folder folder;
  write_bytes(folder / "two.toml", sand + "[[material]]\nname = \"gravel\"\nnormal_stiffness_N_m1_5 = 3e7\n");
  io::ImportOptions options = in_cell();
  options.material_path = folder / "two.toml";
  const auto with = [&](const std::string& last) {
    return read_as(table_of("#format x_y_z_r_matId\n", "\t", false, false, "\n", {"1", "0", "0", last}), options);
  };
  CHECK(with("1").specimen.grains.material == std::vector<std::int32_t>{1, 0, 0, 1});
  CHECK_THAT(with("2").error, Contains("column matId = 2 is no material; allowed: 0 to 1"));
}

TEST_CASE("a SpherePack of YADE brings its cell; members of a clump are refused") {
  const std::string head = "##PERIODIC:: 1 1.25 0.75\n";
  const Read read = read_as(table_of(head, " ", false, false, "\n", {"-1", "-1", "-1", "-1"}));
  expect_four_spheres(read, upright());
  CHECK_THAT(said(read), Contains("taken as x, y, z, radius"));
  expect_four_spheres(read_as(table_of(head, " ", false)), upright());
  CHECK_THAT(read_as(table_of(head, " ", false, false, "\n", {"-1", "3", "3", "-1"})).error,
             Contains("in.txt:4: column clumpId = 3 is the clump of "));
  CHECK_THAT(read_as(table_of("##PERIODIC:: 1 -1 1\n", " ", false)).error, Contains("states no cell"));
  CHECK_THAT(read_as(table_of(head, " ", false), in_cell()).error, Contains("leave --cell out"));
}

TEST_CASE("names of columns may stand in a comment, and a table of numbers alone is refused") {
  expect_four_spheres(read_as(table_of("# by numpy\n# id x y z radius\n", " ", true), in_cell()), upright());
  expect_four_spheres(read_as(table_of("# x, y, z, r\n", ",", false), in_cell()), upright());
  expect_four_spheres(read_as(table_of("id x y  z radius\n", " ", true), in_cell()), upright());
  expect_four_spheres(read_as(table_of("x\ty\tz\tradius\n", "\t", false), in_cell()), upright());
  CHECK_THAT(read_as(table_of("", ",", true), in_cell()).error,
             Contains("in.txt:1: has no header line before its numbers"));
}

TEST_CASE("tables without ids, with sep=, semicolons, decimal commas and empty cells at the end are read") {
  expect_four_spheres(read_as(table_of("x,y,z,radius\n", ",", false), in_cell()), upright());
  for (const std::string head :
       {"sep=;\r\nid;x;y;z;radius\r\n", "\xef\xbb\xbf\"sep=;\"\r\nid;x;y;z;radius\r\n", "SEP=;\nID;X;Y;Z;Radius\n"}) {
    for (const bool comma : {false, true})
      expect_four_spheres(read_as(table_of(head, ";", true, comma, "\r\n"), in_cell()), upright());
  }
  expect_four_spheres(read_as(table_of("sep=|\nx|y|z|r\n", "|", false), in_cell()), upright());
  expect_four_spheres(read_as(table_of("sep=\t\nx\ty\tz\tr\n", "\t", false, true), in_cell()), upright());
  expect_four_spheres(read_as(table_of("x;y;z;r;;\n", ";", false, true, ";;\n") + ";;;;;\n", in_cell()), upright());
  // A spreadsheet where the comma is decimal quotes each number of a table apart by commas.
  expect_four_spheres(
      read_as("x,y,z,diameter\n\"-0,31\",\"0,17\",\"0,02\",\"0,42\"\n\"0,13\",\"0,21\",\"-0,11\",\"0,54\"\n"
              "\"0,37\",\"-0,41\",\"0,3\",\"0,375\"\n\"-0,2\",\"-0,35\",\"0,1\",\"0,6\"\n",
              in_cell()),
      upright());
  CHECK_THAT(read_as(table_of("sep=ab\nx;y;z;r\n", ";", false), in_cell()).error,
             Contains("in.txt:1: sep=ab names no separator"));
}

TEST_CASE("a comma that may group digits is refused, and decimal commas beside decimal points") {
  CHECK_THAT(read_as("x;y;z;r\n0,5;0;0;0,1\n0.25;0;0;0,1\n", in_cell()).error,
             Contains("in.txt:2: column x = 0,5 has a decimal comma, and "));
  CHECK_THAT(read_as("x,y,z,r\n\"1,234\",0,0,1\n", in_cell()).error,
             Contains("may be a decimal comma or groups of digits"));
  CHECK_THAT(read_as("x,y,z,r\n0,1,0,2,0,3,0,1\n", in_cell()).error, Contains("decimal commas"));
}

TEST_CASE("a table of spheres in one plane is told, and --dimension 2 reads discs") {
  const std::string text = "x,y,z,r\n0,0,1,0.1\n0.3,0,1,0.1\n0,0.3,1,0.1\n";
  const Read layer = read_as(text, in_cell());
  CHECK(layer.specimen.cell.dimension == 3);
  CHECK_THAT(said(layer), Contains("the same z; taken as spheres (3D), a layer; --dimension 2 reads discs"));
  io::ImportOptions discs = in_cell();
  discs.dimension = 2;
  CHECK(read_as(text, discs).specimen.shape == Shape::disc);
  discs.dimension = 3;
  CHECK_THAT(read_as("x,y,r\n0,0,0.1\n", discs).error, Contains("column z is missing"));
}

TEST_CASE("The dimension asked for must be that of META.json, and contacts want ids") {
  io::ImportOptions options;
  options.dimension = 3;
  CHECK_THAT(input_error([&] { imported_packing("dense", options); }), Contains("--dimension 3 and dim = 2"));
  const Folder folder;
  write_bytes(folder / "p.csv", "x,y,r\n1,1,1\n2.9,1,1\n");
  write_bytes(folder / "m.json", meta("dense").dump());
  auto json = meta("dense");
  json.erase("n_particles");
  write_bytes(folder / "m.json", json.dump());
  std::string notes;
  options.dimension.reset();
  options.tell = [&](const std::string& note) { notes += note; };
  CHECK_THAT(input_error([&] {
               io::import_csv(folder / "p.csv", packings + "dense.contacts.csv", folder / "m.json", options);
             }),
             Contains("has no column id"));
  CHECK(notes.empty());  // what is refused is not described before
}
