// Import: the state in the files is the state of the specimen.
#include <cmath>
#include <sstream>

#include "tests/io/imported.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

Vector3 branch(const Specimen& s, const Contact& c) {
  return s.grains.position[std::size_t(c.j)] + translation(s.cell, c.image) - s.grains.position[std::size_t(c.i)];
}

double overlap(const Specimen& s, const Contact& c) {
  return s.grains.radius[std::size_t(c.i)] + s.grains.radius[std::size_t(c.j)] - branch(s, c).norm();
}

/// Force on grain j, from the formulas of contact/ for equal materials.
Vector3 force(const Specimen& s, const Contact& c) {
  const double ri = s.grains.radius[std::size_t(c.i)], rj = s.grains.radius[std::size_t(c.j)];
  const Material& m = s.materials[0];
  const double r = ri * rj / (ri + rj), delta = overlap(s, c);
  const double modulus = m.young_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
  const double fn = s.contact.law == Law::linear ? 2 * m.young_modulus * r * delta
                                                 : 4. / 3 * modulus * std::sqrt(r) * delta * std::sqrt(delta);
  const Vector3 n = branch(s, c).normalized();
  const Vector3 ft = s.cell.dimension == 3 ? c.tangential_force : c.tangential_force[0] * Vector3(-n[1], n[0], 0);
  return fn * n + ft;
}

/// Cauchy stress, tension positive: sigma_kl = -(1/V) sum force_k branch_l.
Matrix3 stress(const Specimen& s) {
  Matrix3 sum = Matrix3::Zero();
  for (const Contact& c : s.contacts) sum -= force(s, c) * branch(s, c).transpose();
  return sum / s.cell.volume();
}

}  // namespace

TEST_CASE("an imported packing has the stress that was recorded with it") {
  for (const std::string name : {"dense", "hertz"}) {
    CAPTURE(name);
    const Specimen s = imported_packing(name);
    const auto recorded = meta(name)["stress_tension_positive_Pa"];
    const Matrix3 computed = stress(s);
    for (int k = 0; k < s.cell.dimension; ++k) {
      for (int l = 0; l < s.cell.dimension; ++l) {
        CHECK(std::abs(computed(k, l) - recorded[std::size_t(k)][std::size_t(l)].get<double>()) < 1e-6);
      }
    }
    CHECK(s.grains.size() == meta(name)["n_particles"]);
    CHECK(s.contacts.size() == meta(name)["n_contacts"]);
    CHECK(s.state.reference.pressure == 1e5);
  }
}

TEST_CASE("in an imported packing forces and moments balance on every grain") {
  const Specimen s = imported_packing("dense");
  std::vector<Vector3> resultant(s.grains.size(), Vector3::Zero());
  std::vector<double> torque(s.grains.size(), 0.0);
  for (const Contact& c : s.contacts) {
    const auto i = std::size_t(c.i), j = std::size_t(c.j);
    const Vector3 f = force(s, c), n = branch(s, c).normalized();
    resultant[i] -= f;
    resultant[j] += f;
    // Both torques -arm n x f_t on j and arm n x f_t on -i have the same sign; the rolling moment is opposite.
    const double twist = n.x() * f.y() - n.y() * f.x(), half = overlap(s, c) / 2;
    torque[i] -= (s.grains.radius[i] - half) * twist + c.rolling_moment.z();
    torque[j] -= (s.grains.radius[j] - half) * twist - c.rolling_moment.z();
  }
  double largest = 0, largest_torque = 0;
  for (std::size_t g = 0; g < s.grains.size(); ++g) {
    largest = std::max(largest, resultant[g].norm());
    largest_torque = std::max(largest_torque, std::abs(torque[g]));
  }
  CHECK(largest < 3e-7);                    // N, against contact forces of 100 N (reference README)
  CHECK(largest_torque < 3e-7 * 7e-3 * 2);  // N m
}

TEST_CASE("an imported specimen is sorted, wrapped into the primary cuboid, at rest, and of the given parameters") {
  for (const std::string name : {"dense", "hertz"}) {
    CAPTURE(name);
    const Specimen s = imported_packing(name);
    CHECK(std::is_sorted(s.grains.id.begin(), s.grains.id.end()));
    for (std::size_t g = 0; g < s.grains.size(); ++g) {
      for (int k = 0; k < s.cell.dimension; ++k) {
        REQUIRE(std::abs(s.grains.position[g][k]) <= s.cell.lattice(k, k) / 2);
      }
      REQUIRE(s.grains.velocity[g] == Vector3::Zero());
      REQUIRE(s.grains.spin[g] == Vector3::Zero());
    }
    for (std::size_t k = 0; k < s.contacts.size(); ++k) {
      const Contact& c = s.contacts[k];
      REQUIRE(c.i <= c.j);
      REQUIRE(overlap(s, c) > 0);
      if (k == 0) continue;
      const Contact& b = s.contacts[k - 1];
      REQUIRE(std::tie(b.i, b.j, b.image) < std::tie(c.i, c.j, c.image));
    }
  }
  const Specimen dense = imported_packing("dense"), hertz = imported_packing("hertz");
  CHECK(dense.shape == Shape::disc);
  CHECK(dense.cell.lattice(2, 2) == 0.1);
  CHECK(dense.cell.rotation == Matrix3::Identity());
  CHECK(dense.contact.law == Law::linear);
  CHECK(dense.contact.rolling);
  CHECK(dense.materials[0].friction == Approx(std::tan(23 * std::acos(-1.0) / 180)).epsilon(1e-15));
  CHECK(dense.materials[0].stiffness_ratio == 0.5);
  CHECK(dense.materials[0].rolling_friction == 0.05);
  CHECK(dense.contacts[0].last_root_overlap == 0);
  CHECK(hertz.shape == Shape::sphere);
  CHECK(hertz.contact.law == Law::hertz_mindlin);
  CHECK(!hertz.contact.rolling);
  CHECK(hertz.materials[0].friction == 0.5);
  for (const Contact& c : hertz.contacts) {
    REQUIRE(c.last_root_overlap * c.last_root_overlap == Approx(overlap(hertz, c)).epsilon(1e-12));
  }
}

TEST_CASE("contacts written the other way round are the same contacts") {
  // id1 and id2 swapped: shift, force and moment change sign.
  const Folder folder;
  std::istringstream text(bytes_of(packings + "dense.contacts.csv"));
  std::string turned;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with('#') || line.starts_with("id1")) {
      turned += line + "\n";
      continue;
    }
    std::vector<std::string> cell;
    std::istringstream row(line);
    for (std::string each; std::getline(row, each, ',');) cell.push_back(each);
    const auto minus = [](const std::string& number) {
      return number.starts_with('-') ? number.substr(1) : "-" + number;
    };
    turned += cell[1] + "," + cell[0] + "," + minus(cell[2]) + "," + minus(cell[3]) + "," + cell[4] + "," +
              minus(cell[5]) + "," + minus(cell[6]) + "," + minus(cell[7]);
    for (std::size_t k = 8; k < cell.size(); ++k) turned += "," + cell[k];
    turned += "\r\n";
  }
  write_bytes(folder / "turned.csv", turned);
  const Specimen s = imported_packing("dense");
  const Specimen t = io::import_csv(packings + "dense.particles.csv", folder / "turned.csv", packings + "dense.json");
  REQUIRE(s.contacts.size() == t.contacts.size());
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const Contact &a = s.contacts[k], &b = t.contacts[k];
    REQUIRE(std::tie(a.i, a.j, a.image) == std::tie(b.i, b.j, b.image));
    REQUIRE((a.tangential_force - b.tangential_force).norm() == 0);
    REQUIRE((a.rolling_moment - b.rolling_moment).norm() == 0);
  }
}

TEST_CASE("a cell that is turned in the laboratory is the same cell in its own frame") {
  // Two spheres across the boundary, in a sheared cell, written upright and turned by the 3-4-5 angle about z.
  const Folder folder;
  const std::string parameters = "\"dim\":3,\"E_Pa\":1e7,\"nu\":0.25,\"mu\":0.5,\"density\":2650,\"p0_Pa\":10,";
  write_bytes(folder / "upright.json", "{" + parameters + "\"hSize\":[[1,0.2,0.1],[0,1,0.3],[0,0,1]]}");
  write_bytes(folder / "turned.json", "{" + parameters + "\"hSize\":[[0.6,-0.68,-0.18],[0.8,0.76,0.26],[0,0,1]]}");
  const Matrix3 q = (Matrix3() << 0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, 1).finished();
  const Vector3 x1(0.1, 0.2, 0.3), x2(0.98, 0.25, 0.35), fs(0.002, -0.03, 0.01);
  const double length = (x2 - Vector3(1, 0, 0) - x1).norm(), delta = 0.2 - length;
  const double fn = 4. / 3 * 1e7 / (2 * (1 - 0.0625)) * std::sqrt(0.05) * std::pow(delta, 1.5);
  const auto write = [&](const std::string& name, const Matrix3& frame) {
    std::ostringstream particles, contacts;
    particles.precision(17);
    contacts.precision(17);
    const Vector3 a = frame * x1, b = frame * x2, f = frame * fs;
    particles << "id,x,y,z,r\n7," << a.x() << ',' << a.y() << ',' << a.z() << ",0.1\n12," << b.x() << ',' << b.y()
              << ',' << b.z() << ",0.1\n";
    contacts << "id1,id2,sx,sy,sz,fn,fsx,fsy,fsz\n7,12,-1,0,0," << fn << ',' << f.x() << ',' << f.y() << ',' << f.z()
             << '\n';
    write_bytes(folder / (name + ".p.csv"), particles.str());
    write_bytes(folder / (name + ".c.csv"), contacts.str());
    return io::import_csv(folder / (name + ".p.csv"), folder / (name + ".c.csv"), folder / (name + ".json"));
  };
  const Specimen upright = write("upright", Matrix3::Identity()), turned = write("turned", q);
  CHECK(upright.cell.rotation == Matrix3::Identity());
  CHECK((turned.cell.rotation - q).norm() < 1e-15);
  CHECK((turned.cell.lattice - upright.cell.lattice).norm() < 1e-15);
  REQUIRE(turned.contacts.size() == 1);
  CHECK(turned.contacts[0].image == upright.contacts[0].image);
  CHECK((turned.contacts[0].tangential_force - upright.contacts[0].tangential_force).norm() < 1e-16);
  CHECK(std::abs(overlap(turned, turned.contacts[0]) - delta) < 1e-15);
  for (std::size_t g = 0; g < 2; ++g) {
    CHECK((turned.grains.position[g] - upright.grains.position[g]).norm() < 1e-15);
  }
  const Matrix3 laboratory = turned.cell.rotation * stress(turned) * turned.cell.rotation.transpose();
  CHECK((laboratory - q * stress(upright) * q.transpose()).norm() < 1e-12 * stress(upright).norm());
}

TEST_CASE("particles of LAMMPS come in with --cell and --material, sorted by id") {
  const Specimen s = LooseSpheres("id,x,y,z,radius\n3, 1.9 ,2.5,3.5,0.1\n\n# note\n1,0.1,0.2,0.3,0.2\n").specimen();
  CHECK(s.grains.id == std::vector<std::int64_t>{1, 3});
  CHECK(s.grains.radius == std::vector<double>{0.2, 0.1});
  CHECK((s.grains.position[1] - Vector3(-0.1, -0.5, -0.5)).norm() < 1e-15);
  CHECK(s.cell.lattice == Matrix3(Vector3(2, 3, 4).asDiagonal()));
  CHECK(s.materials[0].normal_stiffness == 2e7);
  CHECK(s.contact.law == Law::hertz_stiffness);
  const Specimen discs = LooseSpheres("id,x,y,radius\n1,0.1,0.2,0.2\n").specimen();
  CHECK(discs.shape == Shape::disc);
  CHECK(discs.cell.lattice(2, 2) == 4);  // the slab's thickness
}

TEST_CASE("several materials go by the column material") {
  const std::string two = sand + "[[material]]\nname = \"gravel\"\nnormal_stiffness_N_m1_5 = 3e7\n";
  const Specimen s = LooseSpheres("id,x,y,z,radius,material\n1,0,0,0,0.1,gravel\n2,1,1,1,0.1,sand\n", two).specimen();
  CHECK(s.grains.material == std::vector<std::int32_t>{1, 0});
  CHECK_THAT(LooseSpheres("id,x,y,z,radius\n1,0,0,0,0.1\n", two).error(), Contains("column `material`"));
  CHECK_THAT(LooseSpheres("id,x,y,z,radius,material\n1,0,0,0,0.1,silt\n", two).error(),
             Contains("p.csv:2: column material = silt"));
}

TEST_CASE("what --set says is kept, and is the last word") {
  io::ImportOptions options;
  options.settings = {"contact.slip=full_radius_ratcheting", "material.friction=0", "solver.skin=0.15"};
  const Specimen s = imported_packing("dense", options);
  CHECK(s.contact.slip == Slip::full_radius_ratcheting);
  CHECK(s.materials[0].friction == 0);
  CHECK(s.solver.skin == 0.15);
  CHECK(s.contacts.size() == 795);
  options.settings = {"contact.slip=ratcheting"};
  CHECK_THAT(input_error([&] { imported_packing("dense", options); }), Contains("contact.slip"));
}
