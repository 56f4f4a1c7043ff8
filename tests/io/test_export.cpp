// What other programs are handed: the same grains, contacts and cell, in the frame and bounds that each of them wants.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/keys/material_toml.hpp"
#include "rvelab/keys/parameters.hpp"
#include "rvelab/measure/measures.hpp"
#include "tests/io/exported.hpp"
#include "tests/io/record_files.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

Specimen through_csv(const Folder& folder, const Specimen& specimen) {
  const io::CsvExport files = io::export_csv(specimen, folder / "s");
  io::ImportOptions options;
  options.material_path = files.material;
  return io::import_csv(files.particles, files.contacts, files.meta, options);
}

}  // namespace

TEST_CASE("a packing goes through CSV and comes back bit for bit where its frame is the laboratory's") {
  const Folder folder;
  for (const char* name : {"dense", "hertz", "soft"}) {
    CAPTURE(name);
    const Specimen specimen = reference_specimen(name);
    io::write_specimen(specimen, folder / "a.h5");
    io::write_specimen(through_csv(folder, specimen), folder / "b.h5");
    CHECK(test::first_difference(folder / "a.h5", folder / "b.h5").value_or("") == "");
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
  for (const Law law :
       {Law::linear, Law::linear_stiffness, Law::hertz_mindlin, Law::hertz_stiffness, Law::hertz_rough, Law::cones}) {
    for (const Dashpot dashpot : {Dashpot::none, Dashpot::coefficient, Dashpot::viscoelastic}) {
      if (dashpot == Dashpot::viscoelastic && (law == Law::hertz_rough || law == Law::cones)) continue;
      Specimen specimen;
      specimen.contact = {law, Slip::full_radius, true, false};
      specimen.damping.dashpot = dashpot;
      specimen.damping.normal_coefficient = 0.1 + 0.2;
      specimen.damping.global_viscous = 1e-300;
      specimen.solver.fixed_substeps = 17;
      specimen.solver.energy_balance = true;
      specimen.materials.resize(2);
      for (auto& material : specimen.materials) {
        for (const LawParameter& each : law_parameters())  // others go with no key of this law
          if (each.law == law) material.*each.value = 1.0 / 3;
        material.friction = std::tan(0.4);
      }
      specimen.materials[1].name = "grès \"fin\"";
      Specimen read;
      write_bytes(folder / "m.toml", keys::parameters_text(specimen));
      const std::string message = input_error([&] { keys::read_material_file(folder / "m.toml", read); });
      CAPTURE(name(law), name(dashpot), bytes_of(folder / "m.toml"), message);
      CHECK(message.empty());
      CHECK(differences(specimen, read) == 0);
    }
  }
}

TEST_CASE("material names that a CSV cell cannot hold are refused") {
  const Folder folder;
  Specimen specimen = reference_specimen("dense");
  specimen.materials[0].name = "sand, fine";
  CHECK_THAT(input_error([&] { io::export_csv(specimen, folder / "s"); }), Contains("sand, fine"));
  specimen.materials[0].name = "sand";
  specimen.materials.push_back(specimen.materials[0]);
  CHECK_THAT(input_error([&] { io::export_csv(specimen, folder / "s"); }), Contains("each once"));
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
  const std::vector<io::ExportState> states{state_of(reference_specimen("hertz"), 0), state_of(sheared("hertz"), 4)};
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
  Specimen specimen = reference_specimen("dense");
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
  Specimen specimen = reference_specimen("dense");
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
  test::write_records(result, end, "", folder / "r.h5");
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
