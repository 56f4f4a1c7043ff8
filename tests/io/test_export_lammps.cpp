// Dumps and data files of LAMMPS: the same grains and cell, within the tilts that LAMMPS takes.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/parameters.hpp"
#include "tests/io/exported.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("vectors within LAMMPS' tilt limits span the same lattice, and the box holds each grain once") {
  Matrix3 lattice;
  lattice << 1.0, 1.3, -7.7, 0, 0.9, 0.52, 0, 0, 1.1;
  const Matrix3 within = io::within_tilt_limits(lattice);
  CHECK(std::abs(within(0, 1)) <= 0.5 * within(0, 0));
  CHECK(std::abs(within(0, 2)) <= 0.5 * within(0, 0));
  CHECK(std::abs(within(1, 2)) <= 0.5 * within(1, 1));
  const Matrix3 change = lattice.inverse() * within;
  CHECK((change - change.array().round().matrix()).norm() < 1e-14);
  CHECK(within.diagonal() == lattice.diagonal());
  const io::Box box(within);
  for (const Vector3& point : {Vector3(0.1, 0.2, -0.3), Vector3(3, -2, 5), Vector3(-0.49, 0.44, 0.54)}) {
    const Vector3 inside = box.wrapped(point);
    CHECK((within.inverse() * inside).cwiseAbs().maxCoeff() <= 0.5 + 1e-15);
    CHECK(apart(lattice, inside - point).norm() < 1e-14);
    CHECK(box.wrapped(inside) == inside);  // what is inside keeps its bits
  }
}

TEST_CASE("a dump read back by the importer has the cell, the positions and the radii of the specimen") {
  const Folder folder;
  for (const char* name : {"dense", "hertz"}) {
    CAPTURE(name);
    const Specimen before = sheared(name);
    const io::ExportState state = state_of(before);
    io::export_lammps_dump({state_of(reference_specimen(name)), state}, folder / "s.dump");  // the last timestep counts
    write_bytes(folder / "m.toml", keys::parameters_text(before));
    io::ImportOptions options;
    options.material_path = folder / "m.toml";
    const Specimen after = io::import_csv(folder / "s.dump", std::nullopt, std::nullopt, options);
    CHECK(after.cell.dimension == before.cell.dimension);
    const Matrix3& lattice = before.cell.lattice;
    CHECK((after.cell.lattice - io::within_tilt_limits(lattice)).norm() < 1e-15);
    CHECK(after.grains.radius == before.grains.radius);
    REQUIRE(after.grains.size() == before.grains.size());
    const std::int64_t moved_up = std::max<std::int64_t>(0, 1 - before.grains.id.front());
    for (std::size_t g = 0; g < before.grains.size(); ++g) {
      CHECK(after.grains.id[g] == before.grains.id[g] + moved_up);
      CHECK(apart(lattice, after.grains.position[g] - before.grains.position[g]).norm() < 1e-14);
    }
    // The forces are those of the positions: normal springs only, the history is not in a dump.
    CHECK(Rve(after).network().contacts.size() == state.network.contacts.size());
  }
}

TEST_CASE("dumps with diameters, with positions that are not wrapped, or in parts of the box are the same packing") {
  const Folder folder;
  for (const char* name : {"dense", "hertz"}) {
    const Specimen before = sheared(name);
    io::export_lammps_dump({state_of(before)}, folder / "s.dump");
    write_bytes(folder / "m.toml", keys::parameters_text(before));
    io::ImportOptions options;
    options.material_path = folder / "m.toml";
    const Specimen usual = io::import_csv(folder / "s.dump", std::nullopt, std::nullopt, options);
    const bool flat = usual.cell.dimension == 2;
    for (const std::string kind : {"u", "s", "su"}) {
      CAPTURE(name, kind);
      std::istringstream whole(bytes_of(folder / "s.dump"));
      std::ostringstream edited;
      edited.precision(17);
      double low[3], high[3], tilt[3];
      long row = 0;
      for (std::string line; std::getline(whole, line); ++row) {
        if (row >= 5 && row < 8) std::istringstream(line) >> low[row - 5] >> high[row - 5] >> tilt[row - 5];
        if (row == 8) {
          edited << "ITEM: ATOMS id type diameter x" << kind << " y" << kind << (flat ? "\n" : " z" + kind + "\n");
        } else if (row < 8) {
          edited << line << "\n";
        } else {
          long id = 0, type = 0;
          double x[3], r = 0;
          std::istringstream(line) >> id >> type >> x[0] >> x[1] >> x[2] >> r;
          // The box of LAMMPS: its corner, from the cuboid around it, and its lengths.
          const double xy = tilt[0], xz = tilt[1], yz = tilt[2];
          const double corner[3] = {low[0] - std::min({0.0, xy, xz, xy + xz}), low[1] - std::min(0.0, yz), low[2]};
          const double size[3] = {high[0] - std::max({0.0, xy, xz, xy + xz}) - corner[0],
                                  high[1] - std::max(0.0, yz) - corner[1], high[2] - low[2]};
          double s[3];
          s[2] = (x[2] - corner[2]) / size[2];
          s[1] = (x[1] - corner[1] - yz * s[2]) / size[1];
          s[0] = (x[0] - corner[0] - xy * s[1] - xz * s[2]) / size[0];
          edited << id << " " << type << " +" << 2 * r;
          const double images = kind == "s" ? 0 : double(id % 3) - 1;  // along y
          const double moved[3] = {x[0] + images * xy, x[1] + images * size[1], x[2]};
          for (int k = 0; k < (flat ? 2 : 3); ++k) edited << " " << (kind == "u" ? moved[k] : s[k] + (k == 1) * images);
          edited << "\n";
        }
      }
      write_bytes(folder / "t.dump", edited.str());
      const Specimen other = io::import_csv(folder / "t.dump", std::nullopt, std::nullopt, options);
      CHECK(other.cell.lattice == usual.cell.lattice);
      REQUIRE(other.grains.id == usual.grains.id);
      CHECK(other.grains.radius == usual.grains.radius);
      double farthest = 0;
      for (std::size_t g = 0; g < usual.grains.size(); ++g) {
        const Vector3 gap = apart(usual.cell.lattice, other.grains.position[g] - usual.grains.position[g]);
        farthest = std::max(farthest, gap.norm());
      }
      CHECK(farthest < 1e-14);
    }
  }
}

TEST_CASE("a dump states the cuboid around the tilted box, and its tilts") {
  const Folder folder;
  io::export_lammps_dump({state_of(sheared("hertz"), 7)}, folder / "s.dump");
  std::istringstream text(bytes_of(folder / "s.dump"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  REQUIRE(lines.size() == 9 + 1000);
  CHECK(lines[0] == "ITEM: TIMESTEP");
  CHECK(lines[1] == "7");
  CHECK(lines[3] == "1000");
  CHECK(lines[4] == "ITEM: BOX BOUNDS xy xz yz pp pp pp");
  CHECK(lines[8] == "ITEM: ATOMS id type x y z radius vx vy vz");
  double low[3], high[3], tilt[3];
  for (std::size_t k = 0; k < 3; ++k) std::istringstream(lines[5 + k]) >> low[k] >> high[k] >> tilt[k];
  CHECK(tilt[0] != 0);
  CHECK(tilt[1] != 0);
  // The eight corners of the tilted box reach the cuboid's faces and no farther.
  const double size = high[2] - low[2];
  CHECK(high[1] - low[1] > std::abs(tilt[2]));
  CHECK(low[0] + high[0] == Approx(0).margin(1e-12 * size));
  for (std::size_t k = 9; k < lines.size(); ++k) {
    double id, type, x[3];
    std::istringstream(lines[k]) >> id >> type >> x[0] >> x[1] >> x[2];
    CHECK(id >= 1);
    for (std::size_t axis = 0; axis < 3; ++axis) CHECK((x[axis] >= low[axis] && x[axis] <= high[axis]));
  }
}

TEST_CASE("a dump that is cut, not periodic or of unknown types is refused with its line") {
  const Folder folder;
  io::export_lammps_dump({state_of(reference_specimen("dense"))}, folder / "s.dump");
  const std::string whole = bytes_of(folder / "s.dump");
  write_bytes(folder / "m.toml", keys::parameters_text(reference_specimen("dense")));
  const auto message = [&](std::string text, const std::string& materials = "") {
    write_bytes(folder / "t.dump", text);
    write_bytes(folder / "n.toml", bytes_of(folder / "m.toml") + materials);
    io::ImportOptions options;
    options.material_path = folder / "n.toml";
    return input_error([&] { io::import_csv(folder / "t.dump", std::nullopt, std::nullopt, options); });
  };
  CHECK(message(whole).empty());
  CHECK_THAT(message(whole.substr(0, whole.find("ITEM: BOX"))), Contains("no ITEM: BOX BOUNDS"));
  CHECK_THAT(message(whole.substr(0, whole.find("ITEM: ATOMS"))), Contains("no ITEM: ATOMS"));
  CHECK_THAT(message(whole.substr(0, whole.size() - 8)), Contains("t.dump:409: the row has"));
  std::string mixed = whole;
  mixed.replace(mixed.find(" x y z "), 7, " xs y z ");
  CHECK_THAT(message(mixed), Contains("t.dump:9: has some coordinates in parts of the box"));
  std::string walls = whole;
  walls.replace(walls.find("pp pp pp"), 8, "ff pp pp");
  CHECK_THAT(message(walls), Contains("t.dump:5"));
  const std::string second = "[[material]]\nname = 'b'\nyoung_modulus_Pa = 1e8\nstiffness_ratio = 0.5\n";
  CHECK(message(whole, second).empty());
  std::string types = whole;
  types.replace(types.find("\n2 1 ") + 1, 3, "2 3");
  CHECK_THAT(message(types, second), Contains("t.dump:11: column type = 3 is no material; allowed: 1 to 2"));
}
