// What other programs are handed: the same grains, contacts and cell, in the frame and bounds that each of them wants.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "random_specimen.hpp"
#include "rvelab/io/compare.hpp"
#include "rvelab/io/export_csv.hpp"
#include "rvelab/io/export_lammps.hpp"
#include "rvelab/io/export_xdmf.hpp"
#include "rvelab/io/hdf5_file.hpp"
#include "rvelab/io/import_csv.hpp"
#include "rvelab/io/material_text.hpp"
#include "rvelab/io/record_file.hpp"
#include "rvelab/io/schema.hpp"
#include "rvelab/io/specimen_file.hpp"
#include "rvelab/io/states.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

Specimen packing(const std::string& name) {
  const std::string stem = std::string(RVELAB_TEST_DATA) + "/yade/" + name;
  return io::import_csv(stem + ".particles.csv", stem + ".contacts.csv", stem + ".json");
}

/// Sheared and turned, so that the lattice leans and the frame is not the laboratory's.
Specimen sheared(const std::string& name) {
  Rve rve(packing(name));
  Matrix3 dh = Matrix3::Zero();
  const int d = rve.cell().dimension;
  dh(0, d - 1) = 0.004;
  dh(d - 1, 0) = -0.002;
  if (d == 3) dh(0, 1) = dh(2, 1) = 0.003;
  for (int k = 0; k < 3; ++k) rve.apply(dh, 0);
  Specimen specimen = rve.specimen();
  CHECK((specimen.cell.rotation - Matrix3::Identity()).norm() > 1e-3);
  return specimen;
}

io::ExportState state_of(const Specimen& specimen, long record = 0) {
  const Rve rve(specimen);
  return {record, 0, rve.specimen(), rve.network()};
}

Specimen through_csv(const Folder& folder, const Specimen& specimen) {
  const io::CsvExport files = io::export_csv(specimen, folder / "s");
  io::ImportOptions options;
  options.material_path = files.material;
  return io::import_csv(files.particles, files.contacts, files.meta, options);
}

/// x modulo the lattice, as fractions next to zero.
Vector3 apart(const Matrix3& lattice, const Vector3& difference) {
  Vector3 fraction = lattice.inverse() * difference;
  for (int k = 0; k < 3; ++k) fraction[k] -= std::round(fraction[k]);
  return fraction;
}

}  // namespace

TEST_CASE("a packing goes through CSV and comes back bit for bit where its frame is the laboratory's") {
  const Folder folder;
  for (const char* name : {"dense", "hertz", "soft"}) {
    CAPTURE(name);
    const Specimen specimen = packing(name);
    io::write_specimen(specimen, folder / "a.h5");
    io::write_specimen(through_csv(folder, specimen), folder / "b.h5");
    CHECK(io::first_difference(folder / "a.h5", folder / "b.h5").value_or("") == "");
  }
}

TEST_CASE("a sheared and turned state comes back through CSV to round-off, contacts and stress included") {
  const Folder folder;
  for (const char* name : {"dense", "hertz"}) {
    CAPTURE(name);
    const Specimen before = sheared(name);
    const Specimen after = through_csv(folder, before);
    REQUIRE(after.contacts.size() == before.contacts.size());
    const Matrix3 lattice = before.cell.rotation * before.cell.lattice;
    CHECK((after.cell.rotation * after.cell.lattice - lattice).norm() < 1e-15 * lattice.norm() * 10);
    for (std::size_t g = 0; g < before.grains.size(); ++g) {
      const Vector3 moved =
          after.cell.rotation * after.grains.position[g] - before.cell.rotation * before.grains.position[g];
      CHECK(apart(lattice, moved).norm() < 1e-14);
    }
    const Matrix3 stress = Rve(before).contact_stress();
    CHECK((Rve(after).contact_stress() - stress).norm() < 1e-9 * stress.norm());
  }
}

TEST_CASE("every parameter goes through the material file, whatever law and dashpot use it") {
  const Folder folder;
  for (const Law law : {Law::linear, Law::linear_given, Law::hertz_mindlin, Law::hertz_given}) {
    for (const Dashpot dashpot : {Dashpot::none, Dashpot::coefficient, Dashpot::viscoelastic}) {
      Specimen specimen;
      specimen.contact = {law, Slip::full_radius, true, false};
      specimen.damping.dashpot = dashpot;
      specimen.damping.normal_coefficient = 0.1 + 0.2;
      specimen.damping.global_viscous = 1e-300;
      specimen.solver.fixed_substeps = 17;
      specimen.solver.energy_balance = true;
      specimen.materials.resize(2);
      for (auto& material : specimen.materials) {
        const bool given = law == Law::linear_given || law == Law::hertz_given;
        (given ? material.normal_stiffness : material.young_modulus) = 7e8 / 3;
        material.tangential_stiffness = 1.0 / 3;
        material.poisson_ratio = 0.3;
        material.friction = std::tan(0.4);
      }
      specimen.materials[1].name = "grès \"fin\"";
      Specimen read;
      write_bytes(folder / "m.toml", io::material_file_text(specimen));
      const std::string message = input_error([&] { keys::read_material_file(folder / "m.toml", read); });
      CAPTURE(name(law), name(dashpot), bytes_of(folder / "m.toml"), message);
      CHECK(message.empty());
      CHECK(differences(specimen, read) == 0);
    }
  }
}

TEST_CASE("material names that a CSV cell cannot hold are refused") {
  const Folder folder;
  Specimen specimen = packing("dense");
  specimen.materials[0].name = "sand, fine";
  CHECK_THAT(input_error([&] { io::export_csv(specimen, folder / "s"); }),
             Contains("sand, fine") && Contains("rename"));
  specimen.materials[0].name = "sand";
  specimen.materials.push_back(specimen.materials[0]);
  CHECK_THAT(input_error([&] { io::export_csv(specimen, folder / "s"); }), Contains("each once"));
}

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
    io::export_lammps_dump({state_of(packing(name)), state}, folder / "s.dump");  // the last timestep counts
    write_bytes(folder / "m.toml", io::material_file_text(before));
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
    write_bytes(folder / "m.toml", io::material_file_text(before));
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
  io::export_lammps_dump({state_of(packing("dense"))}, folder / "s.dump");
  const std::string whole = bytes_of(folder / "s.dump");
  write_bytes(folder / "m.toml", io::material_file_text(packing("dense")));
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
  CHECK_THAT(message(walls), Contains("t.dump:5") && Contains("not periodic"));
  const std::string second = "[[material]]\nname = 'b'\nyoung_modulus_Pa = 1e8\nstiffness_ratio = 0.5\n";
  CHECK(message(whole, second).empty());
  std::string types = whole;
  types.replace(types.find("\n2 1 ") + 1, 3, "2 3");
  CHECK_THAT(message(types, second), Contains("t.dump:11: column type = 3 is no material; allowed: 1 to 2"));
}

TEST_CASE("the mean stresses of the grains, weighted with their volumes, are the contact stress") {
  for (const char* name : {"dense", "hertz"}) {
    CAPTURE(name);
    const Network network = state_of(sheared(name)).network;
    const auto stresses = io::grain_stresses(network);
    Matrix3 sum = Matrix3::Zero();
    for (std::size_t g = 0; g < stresses.size(); ++g) {
      sum += grain_volume(network.shape, network.grains[g].radius, network.cell.lattice(2, 2)) * stresses[g];
    }
    const Matrix3 expected = contact_stress(network);
    CHECK((sum / network.cell.volume() - expected).norm() < 1e-12 * expected.norm());
  }
}

TEST_CASE("XDMF names arrays that are in the file beside it, of the extents and types that it states") {
  const Folder folder;
  const std::vector<io::ExportState> states{state_of(packing("hertz"), 0), state_of(sheared("hertz"), 4)};
  io::export_xdmf(states, folder / "s.xdmf");
  const auto heavy = io::Hdf5File::open(folder / "s.xdmf.h5");
  const std::string text = bytes_of(folder / "s.xdmf");
  std::map<std::string, io::Hdf5Entry> entries;
  for (const auto& entry : heavy.entries()) entries[entry.name] = entry;
  const std::map<std::string, std::string> types{{"NumberType=\"Float\" Precision=\"8\"", "float64"},
                                                 {"NumberType=\"Int\" Precision=\"4\"", "int32"},
                                                 {"NumberType=\"Int\" Precision=\"8\"", "int64"},
                                                 {"NumberType=\"UChar\" Precision=\"1\"", "uint8"}};
  std::size_t named = 0;
  const std::string start = "<DataItem Format=\"HDF\" ";
  for (auto at = text.find(start); at != std::string::npos; at = text.find(start, at + 1)) {
    const std::string item = text.substr(at, text.find("</DataItem>", at) - at);
    const std::string reference = "s.xdmf.h5:";
    REQUIRE(item.find(reference) != std::string::npos);
    const std::string name = item.substr(item.find(reference) + reference.size());
    CAPTURE(item);
    REQUIRE(entries.contains(name));
    std::string extents;
    for (const auto extent : entries[name].shape) extents += (extents.empty() ? "" : " ") + std::to_string(extent);
    CHECK(item.find("Dimensions=\"" + extents + "\"") != std::string::npos);
    const auto type = std::find_if(types.begin(), types.end(),
                                   [&](const auto& each) { return item.find(each.first) != std::string::npos; });
    REQUIRE(type != types.end());
    CHECK(type->second == entries[name].type);
    ++named;
  }
  CHECK(named == entries.size());  // nothing lies in the heavy file that the light one does not name
  CHECK_THAT(text, Contains("<Time Value=\"0\"/>") && Contains("<Time Value=\"4\"/>"));

  // Contacts lie between the centres that touch, in the laboratory frame, and carry the stress.
  const auto points = heavy.read<double>("/state_1/contacts/points_m");
  const auto force = heavy.read<double>("/state_1/contacts/force_N");
  const auto grains = heavy.read<double>("/state_1/grains/points_m");
  const Network& network = states[1].network;
  REQUIRE(points.size() == 6 * network.contacts.size());
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t c = 0; c < network.contacts.size(); ++c) {
    const Vector3 from(points[6 * c], points[6 * c + 1], points[6 * c + 2]);
    const Vector3 to(points[6 * c + 3], points[6 * c + 4], points[6 * c + 5]);
    const std::size_t i = std::size_t(network.contacts[c].i);
    CHECK(from == Vector3(grains[3 * i], grains[3 * i + 1], grains[3 * i + 2]));
    const std::size_t j = std::size_t(network.contacts[c].j);
    CHECK((to - from).norm() < network.grains[i].radius + network.grains[j].radius);
    sum -= Vector3(force[3 * c], force[3 * c + 1], force[3 * c + 2]) * (to - from).transpose();
  }
  const Matrix3 expected = Rve(states[1].specimen).contact_stress();
  CHECK((sum / network.cell.volume() - expected).norm() < 1e-12 * expected.norm());

  // The outline has the twelve edges of the cell vectors.
  const auto cell = heavy.read<double>("/state_1/cell/points_m");
  REQUIRE(cell.size() == 12 * 6);
  const Matrix3 lattice = network.cell.rotation * network.cell.lattice;
  for (std::size_t edge = 0; edge < 12; ++edge) {
    const Vector3 along(cell[6 * edge + 3] - cell[6 * edge], cell[6 * edge + 4] - cell[6 * edge + 1],
                        cell[6 * edge + 5] - cell[6 * edge + 2]);
    CHECK((along - lattice.col(int(edge / 4))).norm() < 1e-14);
  }
}

TEST_CASE("the sliding flag of a contact counts as the measure does") {
  const Folder folder;
  Specimen specimen = packing("dense");
  Rve rve(specimen);
  Matrix3 dh = Matrix3::Zero();
  dh(0, 1) = 0.01;
  rve.apply(dh, 0);
  const io::ExportState state = state_of(rve.specimen());
  io::export_xdmf({state}, folder / "s.xdmf");
  const auto sliding = io::Hdf5File::open(folder / "s.xdmf.h5").read<std::uint8_t>("/state_0/contacts/sliding");
  const double fraction = double(std::count(sliding.begin(), sliding.end(), 1)) / double(sliding.size());
  CHECK(fraction == sliding_fraction(state.network));
  CHECK(fraction > 0);
}

TEST_CASE("a state without contacts has no block of them") {
  const Folder folder;
  Specimen specimen = packing("dense");
  specimen.contacts.clear();
  for (double& radius : specimen.grains.radius) radius *= 0.5;
  io::export_xdmf({state_of(specimen)}, folder / "s.xdmf");
  CHECK(bytes_of(folder / "s.xdmf").find("Name=\"contacts\" GridType") == std::string::npos);
  CHECK(!io::Hdf5File::open(folder / "s.xdmf.h5").has("/state_0/contacts"));
}

namespace {

/// A record file with states under /snapshots, named as given.
void add_snapshots(const std::string& from, const std::string& to, const std::map<std::string, Specimen>& snapshots) {
  const auto source = io::Hdf5File::open(from);
  io::publish(to, [&](io::Hdf5File& file) {
    for (const auto& name : source.attributes()) file.set_attribute(name, source.attribute(name));
    const auto copy = [&]<class Scalar>(const io::Hdf5Entry& entry, Scalar) {
      file.write<Scalar>(entry.name, source.read<Scalar>(entry.name), entry.shape, entry.units);
    };
    for (const auto& entry : source.entries()) {
      if (entry.type == "text") file.write_text(entry.name, source.read_text(entry.name), entry.shape);
      if (entry.type == "float64") copy(entry, double());
      if (entry.type == "int32") copy(entry, std::int32_t());
      if (entry.type == "int64") copy(entry, std::int64_t());
      if (entry.type == "uint64") copy(entry, std::uint64_t());
      if (entry.type == "uint8") copy(entry, std::uint8_t());
    }
    for (const auto& [name, specimen] : snapshots) io::put_specimen(file, "/snapshots/" + name, specimen);
  });
}

}  // namespace

TEST_CASE("the states of a file are its snapshots in the order of their records, then its end state") {
  const Folder folder;
  const Specimen end = random_specimen(1), early = random_specimen(2), late = random_specimen(3);
  io::write_specimen(end, folder / "s.h5");
  REQUIRE(io::read_states(folder / "s.h5").size() == 1);
  const records::TestResult result = random_result(4);
  io::write_records(result, end, "", folder / "r.h5");
  const auto without = io::read_states(folder / "r.h5");
  REQUIRE(without.size() == 1);
  CHECK(without[0].record == 23);
  CHECK(differences(without[0].specimen, end) == 0);

  add_snapshots(folder / "r.h5", folder / "t.h5", {{"000010", late}, {"000003", early}});
  const auto states = io::read_states(folder / "t.h5");
  REQUIRE(states.size() == 3);
  CHECK(states[0].record == 3);
  CHECK(differences(states[0].specimen, early) == 0);
  CHECK(std::memcmp(&states[0].strain, &result.records[3].strain, sizeof(double)) == 0);
  CHECK(states[1].record == 10);
  CHECK(differences(states[1].specimen, late) == 0);
  CHECK(differences(states[2].specimen, end) == 0);
  add_snapshots(folder / "r.h5", folder / "u.h5", {{"first", early}});
  CHECK_THAT(input_error([&] { io::read_states(folder / "u.h5"); }), Contains("/snapshots/first"));
}
