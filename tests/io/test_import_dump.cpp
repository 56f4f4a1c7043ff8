// Dumps of LAMMPS, LIGGGHTS and OVITO: read as what they are, or refused; nothing is believed that may be cut.
#include "tests/io/four_spheres.hpp"

#include "rvelab/measure/measures.hpp"
#include "rvelab/solver/rve.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

io::ImportOptions at_step(std::int64_t timestep) {
  io::ImportOptions options;
  options.timestep = timestep;
  return options;
}

io::ImportOptions of_dimension(int dimension) {
  io::ImportOptions options;
  options.dimension = dimension;
  return options;
}

}  // namespace

TEST_CASE("a dump with more or fewer rows than its ITEM: NUMBER OF ATOMS is refused with both counts") {
  const std::string whole = frame_of({}, 0);
  expect_four_spheres(read_as(whole));
  CHECK_THAT(read_as(replaced(whole, "ATOMS\n4\n", "ATOMS\n7\n")).error,
             Contains("in.txt:9: ITEM: NUMBER OF ATOMS says 7, and 4 rows follow"));
  CHECK_THAT(read_as(replaced(whole, "ATOMS\n4\n", "ATOMS\n3\n")).error, Contains("says 3, and 4 rows follow"));
  CHECK_THAT(read_as(replaced(whole, "ATOMS\n4\n", "ATOMS\n-4\n")).error,
             Contains("in.txt:4: -4 is no number of atoms"));
  CHECK_THAT(read_as(replaced(whole, "\n2 1 ", "\n2 ")).error,
             Contains("in.txt:11: the row has 5 cells; allowed: one for "
                      "each of the 6 columns"));
}

TEST_CASE("a dump cut anywhere is refused, or holds the whole timestep before the cut") {
  FourSpheres later;
  later.grains[0].radius = 0.2;
  const std::string first = frame_of({}, 100), both = first + frame_of(later, 200);
  for (std::size_t size = 0; size < both.size(); ++size) {
    CAPTURE(size);
    const Read read = read_as(both.substr(0, size));
    if (size == first.size()) {
      expect_four_spheres(read);
    } else {
      REQUIRE(!read.error.empty());
      CHECK((read.error.find("--timestep 100 reads it") != std::string::npos) == (size > first.size()));
    }
  }
  const std::string cut = both.substr(0, both.size() - 3);
  CHECK_THAT(read_as(cut).error, Contains("not ended by a line break") &&
                                     Contains("the last whole timestep before it is 100: --timestep 100 reads it"));
  expect_four_spheres(read_as(cut, at_step(100)));
  CHECK_THAT(said(read_as(both)), Contains("2 timesteps, 100 to 200; the last is read"));
  CHECK(read_as(both).specimen.grains.radius[0] == 0.2);
  CHECK_THAT(read_as(both, at_step(150)).error, Contains("no timestep 150; allowed: 100, 200"));
  CHECK_THAT(read_as(replaced(first, "ATOMS\n4\n", "ATOMS\n5\n") + cut.substr(first.size())).error,
             Contains("no timestep before it is whole"));
  CHECK_THAT(read_as("id,x,y,z,r\n1,0,0,0,1\n", at_step(1)).error, Contains("is no dump of LAMMPS"));
}

TEST_CASE("units and time of a dump are read: si as it is, cgs, micro and nano in metres, the others refused by name") {
  const std::string whole = frame_of({}, 100);
  expect_four_spheres(read_as("ITEM: UNITS\nsi\nITEM: TIME\n0.25\n" + whole + "ITEM: TIME\n0.5\n" + frame_of({}, 200)));
  // LAMMPS states the units once, before the first timestep.
  CHECK_THAT(read_as("ITEM: UNITS\nlj\nITEM: TIME\n0.25\n" + whole + frame_of({}, 200)).error,
             Contains("in.txt:2: the units are lj, which have no metre; allowed: si"));
  for (const std::string units : {"real", "metal", "electron"})
    CHECK_THAT(read_as("ITEM: UNITS\n" + units + "\n" + whole).error, Contains("the units are " + units));
  CHECK_THAT(read_as("ITEM: UNITS\nparsec\n" + whole).error, Contains("does not know"));
  FourSpheres centimetres;
  centimetres.cell *= 100;
  centimetres.low *= 100;
  for (PlacedSphere& grain : centimetres.grains) {
    grain.at *= 100;
    grain.radius *= 100;
  }
  const Read converted = read_as("ITEM: UNITS\ncgs\n" + frame_of(centimetres, 0));
  CHECK_THAT(said(converted), Contains("units cgs"));
  const FourSpheres four;
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(converted.specimen.grains.radius[k] == Approx(four.grains[k].radius).epsilon(1e-15));
    CHECK(converted.specimen.cell.lattice(1, 2) == Approx(0.125).epsilon(1e-14));
  }
}

TEST_CASE("a general triclinic box of any three vectors is the same packing, turned") {
  const FourSpheres four;
  const Eigen::Quaterniond turn(0.3, -0.7, 0.5, 0.2);
  const Matrix3 q = turn.normalized().toRotationMatrix();
  const Vector3 origin(3, -2, 11);
  const auto general = [&](const Matrix3& cell, const std::string& columns, bool scaled) {
    std::string text = "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS abc origin pp pp pp\n";
    for (int k = 0; k < 3; ++k) text += digits(Vector3(cell.col(k))) + " " + digits(origin[k]) + "\n";
    text += "ITEM: ATOMS id type " + columns + " radius\n";
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3 parts = four.cell.inverse() * (four.grains[k].at - four.low);
      const Vector3 at = scaled ? parts : Vector3(origin + cell * parts);
      text += std::to_string(k + 1) + " 1 " + digits(at) + " " + digits(four.grains[k].radius) + "\n";
    }
    return text;
  };
  for (const bool scaled : {false, true}) {
    const Read read = read_as(general(q * four.cell, scaled ? "xs ys zs" : "x y z", scaled));
    INFO(read.error);
    const Specimen& s = read.specimen;
    REQUIRE(s.grains.size() == 4);
    CHECK((s.cell.lattice - four.cell).norm() < 1e-14);
    CHECK((s.cell.rotation - q).norm() < 1e-14);
    // All of it moves together: vectors from grain to grain are those of the packing that is not turned.
    for (std::size_t k = 1; k < 4; ++k) {
      const Vector3 gap = s.grains.position[k] - s.grains.position[0] - four.grains[k].at + four.grains[0].at;
      const Vector3 images = four.cell.inverse() * gap;
      CHECK((images - images.array().round().matrix()).norm() < 1e-13);
    }
    const Read upright = read_as(frame_of(four, 0));
    const Rve one{s}, other{upright.specimen};
    CHECK(std::abs(void_ratio(one.network()) - void_ratio(other.network())) < 1e-14);
    const Matrix3 stress = q.transpose() * one.stress() * q;
    CHECK((stress - other.stress()).norm() < 1e-10 * stress.norm());
  }
  Matrix3 left = q * four.cell;
  left.col(0).swap(left.col(1));
  CHECK_THAT(read_as(general(left, "x y z", false)).error, Contains("right-handed"));
  const std::string whole = general(q * four.cell, "x y z", false);
  CHECK_THAT(read_as(replaced(whole, "abc origin pp", "abc origin ff")).error, Contains("not periodic along a"));
  CHECK_THAT(read_as(replaced(whole, " 3\n", "\n")).error, Contains("in.txt:6:"));
}

TEST_CASE("a general triclinic box of discs turns about z alone") {
  const Eigen::AngleAxisd turn(2.1, Vector3::UnitZ());
  const Matrix3 cell = (Matrix3() << 1, 0.3, 0, 0, 0.8, 0, 0, 0, 0.1).finished(), turned = turn.matrix() * cell;
  const auto dump = [](const Matrix3& vectors) {
    std::string text = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS abc origin pp pp pp\n";
    for (int k = 0; k < 3; ++k) text += digits(Vector3(vectors.col(k))) + (k == 2 ? " -0.05\n" : " 0\n");
    text += "ITEM: ATOMS id type x y z radius\n";
    for (int k = 0; k < 3; ++k) {
      const Vector3 at = vectors * Vector3(0.2 + 0.3 * k, 0.1 * k * k, 0);
      text += std::to_string(k + 1) + " 1 " + digits(at[0]) + " " + digits(at[1]) + " 0 0.1\n";
    }
    return text;
  };
  const Read upright = read_as(dump(cell)), read = read_as(dump(turned));
  INFO(read.error << upright.error);
  REQUIRE(read.specimen.grains.size() == 3);
  CHECK(read.specimen.cell.dimension == 2);
  CHECK((read.specimen.cell.lattice - cell).norm() < 1e-15);
  CHECK((read.specimen.cell.rotation - turn.matrix()).norm() < 1e-15);
  for (std::size_t k = 0; k < 3; ++k)
    CHECK((read.specimen.grains.position[k] - upright.specimen.grains.position[k]).norm() < 1e-15);
  Matrix3 out = turned;
  out(2, 0) = 0.1;
  CHECK_THAT(read_as(dump(out)).error, Contains("leaves the plane of x and y"));
}

TEST_CASE("a column that stands twice in a dump is taken where its values are equal, as LIGGGHTS' tutorials have it") {
  const FourSpheres four;
  const auto dump = [&](const std::string& second_type) {
    std::string text = frame_of(four, 0).substr(0, frame_of(four, 0).find("ITEM: ATOMS")) +
                       "ITEM: ATOMS id type type x y z ix iy iz vx vy vz fx fy fz omegax omegay omegaz radius \n";
    for (std::size_t k = 0; k < 4; ++k)
      text += std::to_string(k + 1) + " 1 " + (k == 2 ? second_type : "1") + " " + digits(four.grains[k].at) +
              " 0 0 -1 0.1 0 0 0 0 0 0 0 3e-7 " + digits(four.grains[k].radius) + " \n";
    return text;
  };
  expect_four_spheres(read_as(dump("1")));
  expect_four_spheres(read_as(dump("1.0")));
  CHECK_THAT(read_as(dump("2")).error, Contains("in.txt:12: the column type stands twice, here with 1 and 2"));
}

TEST_CASE("boundaries: pp pp pp, and along z any of discs") {
  FourSpheres discs;
  discs.cell(0, 2) = discs.cell(1, 2) = 0;
  for (PlacedSphere& grain : discs.grains) grain.at[2] = 0;
  const Read flat = read_as(frame_of(discs, 0, "pp pp ff"));
  INFO(flat.error);
  CHECK(flat.specimen.cell.dimension == 2);
  CHECK(flat.specimen.cell.lattice(2, 2) == 0.75);  // the thickness is the height of the box
  CHECK(flat.specimen.grains.size() == 4);
  CHECK_THAT(read_as(frame_of(discs, 0, "pp pp ff"), of_dimension(3)).error, Contains("not periodic along c (z)"));
  CHECK_THAT(read_as(frame_of(discs, 0, "pp ff pp")).error, Contains("not periodic along b (y)"));
  CHECK_THAT(read_as(frame_of({}, 0, "pp pp ff")).error, Contains("not periodic along c (z); allowed: pp pp pp"));
  CHECK_THAT(read_as(frame_of({}, 0, "pp pp")).error, Contains("does not say which boundaries are periodic"));
}

TEST_CASE("centres in one plane: what they were taken for is told, and --dimension chooses") {
  FourSpheres layer;
  layer.cell(0, 2) = layer.cell(1, 2) = 0;
  for (PlacedSphere& grain : layer.grains) grain.at[2] = 0.002;
  const Read discs = read_as(frame_of(layer, 0));
  CHECK(discs.specimen.shape == Shape::disc);
  CHECK_THAT(said(discs), Contains("the same z; taken as discs (2D); --dimension 3"));
  const Read spheres = read_as(frame_of(layer, 0), of_dimension(3));
  expect_four_spheres(spheres, layer);
  CHECK(spheres.told.empty());
  CHECK(read_as(frame_of(layer, 0), of_dimension(2)).told.empty());
  CHECK_THAT(read_as(frame_of({}, 0), of_dimension(2)).error,
             Contains("--dimension 2 wants all centres at one z") && Contains("-0.11 to 0.3 m"));
  FourSpheres wall = {};
  for (PlacedSphere& grain : wall.grains) grain.at[1] = 0.25;
  const Read upright = read_as(frame_of(wall, 0));
  expect_four_spheres(upright, wall);
  CHECK_THAT(said(upright), Contains("the same y; taken as spheres (3D), a layer"));
  CHECK(read_as(frame_of({}, 0)).told.empty());
}

TEST_CASE("a dump of something else is refused as what it is") {
  const std::string head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ENTRIES\n1\n";
  CHECK_THAT(read_as(head + bounds_of({}) + "ITEM: ENTRIES c_1[1]\n2\n").error, Contains("is not of atoms"));
  CHECK_THAT(read_as(replaced(frame_of({}, 0), " radius", " mass")).error,
             Contains("r or radius or diameter is missing"));
  CHECK_THAT(
      read_as(replaced(frame_of({}, 0), "ITEM: BOX", "ITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\nITEM: BOX")).error,
      Contains("BOX BOUNDS stands twice"));
}
