// Ellipses in files: read from CSV, kept by specimen files, shown by XDMF, refused where a form knows round grains
// only.
#include <Eigen/Geometry>

#include "random_specimen.hpp"
#include "rvelab/io/export/export.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/import/csv.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

void write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

const std::string hertz =
    "[contact]\nlaw = 'hertz_mindlin'\nhertz_radius = 'curvature'\n[[material]]\nname = 'soil'\n"
    "young_modulus_Pa = 2e9\npoisson_ratio = 0.25\nfriction = 0.6\n";
const std::string material =
    "[contact]\nlaw = 'linear_stiffness'\n[[material]]\nname = 'soil'\nnormal_stiffness_N_m = 6e6\n"
    "tangential_stiffness_N_m = 6e6\nfriction = 0.6\n";

/// Two ellipses that lie tip to tip, and two that stand on them: four contacts.
const std::string grains =
    "id,x,y,a,b,angle\n"
    "3,0.0050,0.0024,0.005,0.004,90\n"
    "1,0.0000,-0.0049,0.005,0.004,0\n"
    "2,0.0099,-0.0049,0.005,0.004,0\n"
    "7,-0.0030,0.0030,0.005,0.004,-90\n";

Specimen imported(const Folder& folder, const std::string& text = grains, const std::string& soil = material) {
  write(folder / "e.csv", text);
  write(folder / "m.toml", soil);
  io::ImportOptions options;
  options.cell = Vector3(0.02, 0.02, 1);
  options.material_path = folder / "m.toml";
  return io::import_csv(folder / "e.csv", std::nullopt, std::nullopt, options);
}

}  // namespace

TEST_CASE("ellipses come from a CSV with a, b and angle") {
  const Folder folder;
  const Specimen s = imported(folder);
  REQUIRE(s.shape == Shape::ellipse);
  REQUIRE(s.grains.size() == 4);
  CHECK(s.grains.id == std::vector<std::int64_t>{1, 2, 3, 7});
  CHECK(s.grains.radius[0] == Approx(std::sqrt(0.02e-3)));
  CHECK((s.grains.orientation[2] - Vector3(0, 1, 0)).norm() < 1e-15);
  const Network net = Rve(s).network();
  REQUIRE(net.contacts.size() > 2);
  CHECK(net.grains[0].inertia == Approx(0.25 * net.grains[0].mass * (25e-6 + 16e-6)));
  CHECK(net.grains[0].mass == Approx(2650 * 3.14159265358979 * 20e-6));
  // 1 and 2 lie tip to tip: they overlap by 1e-4 m along x.
  CHECK(net.contacts[0].overlap == Approx(1e-4));
  CHECK(net.contacts[0].normal[0] == Approx(1));
  CHECK_THROWS_WITH(imported(folder, "id,x,y,a,b,angle\n1,0,0,0.004,0.005,0\n"), Contains("0 < b <= a <= 10 b"));
  CHECK_THROWS_WITH(imported(folder, "id,x,y,a,b,angle\n1,0,0,0.05,0.004,0\n"), Contains("0 < b <= a <= 10 b"));
  CHECK_THROWS_WITH(imported(folder, "id,x,y,a,b\n1,0,0,0.004,0.004\n"), Contains("angle"));
}

TEST_CASE("ellipses come back from a specimen file bit for bit, and go on as they were") {
  const Folder folder;
  Rve rve(imported(folder));
  const Matrix3 squeeze = Vector3(-1e-3, -2e-3, 0).asDiagonal();
  rve.apply(squeeze, 0);
  io::write_specimen(rve.specimen(), folder / "e.h5");
  const Specimen read = io::read_specimen(folder / "e.h5");
  CHECK(differing_fields(rve.specimen(), read).empty());
  Rve again(read);
  CHECK(rve.apply(squeeze, 0).stress == again.apply(squeeze, 0).stress);
  CHECK(rve.save() == again.save());
}

TEST_CASE("Hertz's radius from curvature comes from a material file and goes through files and snapshots") {
  const Folder folder;
  Rve rve(imported(folder, grains, hertz));
  CHECK(rve.specimen().contact.hertz_radius == HertzRadius::curvature);
  Matrix3 squeeze = Vector3(-1e-4, -2e-4, 0).asDiagonal();
  squeeze(0, 1) = 1e-4;
  rve.apply(squeeze, 1e-6);
  Rve restored(imported(folder, grains, hertz));
  restored.restore(rve.save());
  io::write_specimen(rve.specimen(), folder / "e.h5");
  const Specimen read = io::read_specimen(folder / "e.h5");
  CHECK(differing_fields(rve.specimen(), read).empty());
  Rve again(read);
  const Matrix3 stress = rve.apply(squeeze, 1e-6).stress;
  CHECK(stress.norm() > 1);
  CHECK(stress == again.apply(squeeze, 1e-6).stress);
  CHECK(stress == restored.apply(squeeze, 1e-6).stress);
  CHECK(rve.save() == again.save());
  CHECK(rve.save() == restored.save());

  Specimen other = read;
  other.contact.hertz_radius = HertzRadius::equivalent;
  CHECK(differing_fields(other, read) == std::vector<std::string>{"contact/hertz_radius"});
  CHECK(Rve(other).apply(squeeze, 1e-6).stress != stress);
}

TEST_CASE("XDMF shows axes and orientation of ellipses, and their stresses add up") {
  const Folder folder;
  const Rve rve(imported(folder));
  const io::ExportState state{0, 0, rve.specimen(), rve.network()};
  io::export_xdmf({state}, folder / "e.xdmf");
  const auto heavy = io::Hdf5File::open(folder / "e.xdmf.h5");
  const auto orientation = heavy.read<double>("/state_0/grains/orientation");
  REQUIRE(orientation.size() == 12);
  CHECK(orientation[7] == Approx(1));
  CHECK(heavy.read<double>("/state_0/grains/semi_major_m")[0] == 0.005);
  CHECK(heavy.read<double>("/state_0/grains/semi_minor_m")[0] == 0.004);
  CHECK_THAT(bytes_of(folder / "e.xdmf"), Contains("Name=\"orientation\" AttributeType=\"Vector\""));
  Matrix3 sum = Matrix3::Zero();
  const auto stresses = io::grain_stresses(state.network);
  for (std::size_t g = 0; g < stresses.size(); ++g)
    sum += grain_volume(Shape::ellipse, state.network.grains[g].radius, 1) * stresses[g];
  const Matrix3 expected = contact_stress(state.network);
  CHECK((sum / state.network.cell.volume() - expected).norm() < 1e-12 * expected.norm());
}

TEST_CASE("ellipses written as CSV come back with their contacts") {
  const Folder folder;
  Specimen start = imported(folder, grains, GENERATE(material, hertz));
  start.solver.fixed_substeps = 2;  // to a tolerance these few grains, which nothing confines, have time to part
  Rve rve(start);
  Matrix3 strain = Vector3(-1e-3, -2e-3, 0).asDiagonal();
  strain(0, 1) = 4e-3;
  rve.apply(strain, 0);
  rve.apply(Matrix3(Eigen::AngleAxisd(0.4, Vector3::UnitZ()).toRotationMatrix() - Matrix3::Identity()), 0);
  const Specimen s = rve.specimen();
  const io::CsvExport files = io::export_csv(s, folder / "out");
  CHECK_THAT(bytes_of(files.particles), Contains("id,x,y,a,b,angle,material"));
  io::ImportOptions options;
  options.material_path = files.material;
  const Specimen back = io::import_csv(files.particles, files.contacts, files.meta, options);
  REQUIRE(back.shape == Shape::ellipse);
  REQUIRE(back.contacts.size() == s.contacts.size());
  double largest = 0;
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    largest = std::max(largest, std::abs(s.contacts[k].tangential_force[0]));
    CHECK(back.contacts[k].tangential_force[0] == Approx(s.contacts[k].tangential_force[0]).epsilon(1e-14));
    CHECK(back.contacts[k].last_root_overlap == Approx(s.contacts[k].last_root_overlap).epsilon(1e-9));
  }
  CHECK(back.contact.hertz_radius == s.contact.hertz_radius);
  CHECK(largest > 1);
  const Matrix3 before = rve.stress(), after = Rve(back).stress();
  CHECK((after - before).norm() < 1e-12 * before.norm());
}

TEST_CASE("what knows round grains only refuses ellipses by name") {
  const Folder folder;
  const Rve rve(imported(folder));
  const io::ExportState state{0, 0, rve.specimen(), rve.network()};
  CHECK_THROWS_WITH(io::export_lammps_dump({state}, folder / "e.dump"), Contains("has ellipses"));
  CHECK_THROWS_WITH(io::export_lammps_data(state, folder / "e.data"), Contains("has ellipses"));
}
