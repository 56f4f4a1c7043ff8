// Import: the state in the files is the state of the specimen, and files that do not belong together are refused.
#include "rvelab/io/import/csv.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "random_specimen.hpp"
#include "tests/catch.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

const std::string packings = std::string(RVELAB_TEST_DATA) + "/yade/";

Specimen imported_packing(const std::string& name, const io::ImportOptions& options = {}) {
  return io::import_csv(packings + name + ".particles.csv", packings + name + ".contacts.csv",
                        packings + name + ".json", options);
}

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

nlohmann::json meta(const std::string& name) { return nlohmann::json::parse(bytes_of(packings + name + ".json")); }

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
    CHECK(s.state.reference_pressure == 1e5);
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

namespace {

const std::string sand =
    "[contact]\nlaw = \"hertz_given\"\n[[material]]\nname = \"sand\"\nnormal_stiffness_N_m1_5 = 2e7\n"
    "tangential_stiffness_N_m = 2e6\nfriction = 0.3\n";

struct LooseSpheres {
  Folder folder;
  io::ImportOptions options;
  explicit LooseSpheres(const std::string& particles, const std::string& material = sand) {
    write_bytes(folder / "p.csv", particles);
    write_bytes(folder / "m.toml", material);
    options.material_path = folder / "m.toml";
    options.cell = Vector3(2, 3, 4);
  }
  Specimen specimen() const { return io::import_csv(folder / "p.csv", std::nullopt, std::nullopt, options); }
  std::string error() const {
    return input_error([&] { specimen(); });
  }
};

}  // namespace

TEST_CASE("particles of LAMMPS come in with --cell and --material, sorted by id") {
  const Specimen s = LooseSpheres("id,x,y,z,radius\n3, 1.9 ,2.5,3.5,0.1\n\n# note\n1,0.1,0.2,0.3,0.2\n").specimen();
  CHECK(s.grains.id == std::vector<std::int64_t>{1, 3});
  CHECK(s.grains.radius == std::vector<double>{0.2, 0.1});
  CHECK((s.grains.position[1] - Vector3(-0.1, -0.5, -0.5)).norm() < 1e-15);
  CHECK(s.cell.lattice == Matrix3(Vector3(2, 3, 4).asDiagonal()));
  CHECK(s.materials[0].normal_stiffness == 2e7);
  CHECK(s.contact.law == Law::hertz_given);
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
             Contains("p.csv:2: column material = silt") && Contains("gravel, sand"));
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
  CHECK_THAT(input_error([&] { imported_packing("dense", options); }),
             Contains("contact.slip") && Contains("ratcheting"));
}

TEST_CASE("a bad particle file is refused with file, line, column, value and remedy") {
  const auto error = [](const std::string& text) { return LooseSpheres(text).error(); };
  CHECK_THAT(error("id,x,y,z\n1,0,0,0\n"), Contains("p.csv") && Contains("r or radius") && Contains("id,x,y,z"));
  CHECK_THAT(error("# c\nid,x,y,z,r\n1,0,zero,0,0.1\n"), Contains("p.csv:3: column y = zero") && Contains("number"));
  CHECK_THAT(error("id,x,y,z,r\n1,0,nan,0,0.1\n"), Contains("p.csv:2: column y = nan") && Contains("finite"));
  CHECK_THAT(error("id,x,y,z,r\n1.5,0,0,0,0.1\n"), Contains("column id = 1.5") && Contains("whole number"));
  CHECK_THAT(error("id,x,y,z,r\n1,0,0,0,0.1\n2,0,0,1,0.1\n1,1,0,0,0.1\n"),
             Contains("p.csv:4: column id = 1") && Contains("p.csv:2"));
  CHECK_THAT(error("id,x,y,z,r\n1,0,0,0,-0.1\n"), Contains("p.csv:2: column r = -0.1") && Contains("> 0"));
  CHECK_THAT(error("id,x,y,z,r\n1,0,0,0\n"), Contains("p.csv:2") && Contains("4 cells") && Contains("5 columns"));
  CHECK_THAT(error("id,x,x,z,r\n"), Contains("column x twice"));
  CHECK_THAT(error("id,x,y,z,r\n"), Contains("no rows"));
  CHECK_THAT(error("# nothing\n"), Contains("no header"));
  CHECK_THAT(error(""), Contains("p.csv"));
  CHECK_THAT(input_error([] { io::import_csv("none.csv", std::nullopt, std::nullopt); }),
             Contains("none.csv: no such file"));
}

TEST_CASE("a cell and parameters are needed, once") {
  LooseSpheres loose("id,x,y,z,r\n1,0,0,0,0.1\n");
  loose.options.cell = Vector3(1, -1, -1);
  CHECK_THAT(loose.error(), Contains("--cell") && Contains("> 0"));
  loose.options.cell.reset();
  CHECK_THAT(loose.error(), Contains("without a cell") && Contains("--cell Lxx,Lyy,Lzz"));
  loose.options.material_path.reset();
  CHECK_THAT(loose.error(), Contains("without contact parameters") && Contains("--material"));
  io::ImportOptions options;
  options.cell = Vector3(1, 1, 1);
  CHECK_THAT(input_error([&] { imported_packing("dense", options); }), Contains("leave --cell out"));
}

TEST_CASE("a bad META.json is refused with the key and the value") {
  const Folder folder;
  const auto error = [&](const std::string& text) {
    write_bytes(folder / "m.json", text);
    return input_error([&] { io::import_csv(packings + "dense.particles.csv", std::nullopt, folder / "m.json"); });
  };
  const auto changed = [&](const char* key, const nlohmann::json& value) {
    auto json = meta("dense");
    json[key] = value;
    return error(json.dump());
  };
  CHECK(changed("seed", 2).empty());
  CHECK_THAT(error("{\"dim\": 2,"), Contains("m.json") && Contains("not JSON"));
  CHECK_THAT(error("[]"), Contains("not a JSON object"));
  CHECK_THAT(changed("dim", 4), Contains("dim = 4") && Contains("2 (discs), 3 (spheres)"));
  CHECK_THAT(changed("E_Pa", "stiff"), Contains("E_Pa = \"stiff\"") && Contains("number"));
  CHECK_THAT(changed("E_Pa", -1), Contains("m.json") && Contains("young_modulus = -1"));
  CHECK_THAT(changed("E_Pa", nullptr), Contains("E_Pa is missing"));
  CHECK_THAT(changed("phi_deg", nullptr), Contains("mu or phi_deg"));
  CHECK_THAT(changed("nu", 0.25), Contains("both of kt_over_kn and nu"));
  CHECK_THAT(changed("kt_over_kn", nullptr), Contains("neither of kt_over_kn and nu"));
  CHECK_THAT(changed("thickness_m", nullptr), Contains("thickness_m is missing"));
  const char* columns = "hSize_columns_are_cell_vectors";
  CHECK_THAT(changed("hSize", meta("dense")[columns]), Contains("both of hSize"));
  CHECK_THAT(changed(columns, 0.2), Contains("hSize_columns_are_cell_vectors = 0.2") && Contains("matrix"));
  CHECK_THAT(changed(columns, nlohmann::json::array({{0.0, 0.2}, {0.2, 0.0}})), Contains("right-handed"));
  CHECK_THAT(changed("p0_Pa", -1e5), Contains("p0_Pa") && Contains(">= 0"));
}

namespace {

/// Two discs that touch, r = 1, E = 1e6 Pa, overlap 0.1: kn = 2 E r/2 = 1e6 N/m, fn = 1e5 N.
std::string contact_error(const std::string& contacts, const std::string& more_meta = "") {
  const Folder folder;
  write_bytes(folder / "p.csv", "id,x,y,r\n4,1,1,1\n9,2.9,1,1\n");
  write_bytes(folder / "c.csv", contacts);
  write_bytes(folder / "m.json", "{\"dim\":2,\"E_Pa\":1e6,\"kt_over_kn\":0.5,\"mu\":0.5,\"density\":2650," + more_meta +
                                     "\"hSize\":[[10,0],[0,10]],\"thickness_m\":1}");
  return input_error([&] { io::import_csv(folder / "p.csv", folder / "c.csv", folder / "m.json"); });
}

const std::string header = "id1,id2,sx,sy,fn,fsx,fsy,mz,kn,ks,kr\n";

}  // namespace

TEST_CASE("contacts that the parameters do not give are refused, naming the contact") {
  CHECK(contact_error(header + "4,9,0,0,1e5,0,30,0,1e6,5e5,0\n").empty());
  CHECK(contact_error(header + "4,9,0,0,100000.05,0,30,0,1e6,5e5,0\n").empty());
  CHECK_THAT(contact_error(header + "4,9,0,0,100001,0,30,0,1e6,5e5,0\n"),
             Contains("c.csv:2: column fn = 100001") && Contains("4-9") && Contains("100000") && Contains("1e-6"));
  CHECK_THAT(contact_error(header + "4,9,1,0,1e5,0,30,0,1e6,5e5,0\n"), Contains("4-9") && Contains("gives 0 N"));
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0,1.00001e6,5e5,0\n"), Contains("column kn") && Contains("4-9"));
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0,1e6,4e5,0\n"), Contains("column ks") && Contains("500000"));
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0.5,1e6,5e5,0\n"), Contains("4-9") && Contains("rolling moment"));
  const std::string rolling = "\"beta\":2,\"eta\":0.1,";
  CHECK(contact_error(header + "4,9,0,0,1e5,0,30,0.5,1e6,5e5,1e6\n", rolling).empty());  // kr = beta kt ri rj
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0.5,1e6,5e5,2e6\n", rolling), Contains("column kr"));
  CHECK_THAT(contact_error("id1,id2,sx,sy,fn,fsx,fsy\n4,9,0,0,1e5,0,30\n", rolling), Contains("column mz"));
}

TEST_CASE("a bad contact file is refused with file, line, column, value and remedy") {
  CHECK_THAT(contact_error(header + "4,8,0,0,1e5,0,30,0,1e6,5e5,0\n"), Contains("c.csv:2: column id2 = 8"));
  CHECK_THAT(contact_error(header + "4,9,0,half,1e5,0,30,0,1e6,5e5,0\n"), Contains("column sy = half"));
  CHECK_THAT(contact_error(header + "4,9,99999999999,0,1e5,0,30,0,1e6,5e5,0\n"),
             Contains("column sx") && Contains("range"));
  CHECK_THAT(contact_error("id1,id2,sx,sy,fn,fsx\n4,9,0,0,1e5,0\n"), Contains("column fsy is missing"));
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0,1e6,5e5,0\n9,4,0,0,1e5,0,-30,0,1e6,5e5,0\n"),
             Contains("c.csv:3") && Contains("9-4 is there twice") && Contains("c.csv:2"));
  CHECK_THAT(contact_error(header + "4,4,0,0,1e5,0,30,0,1e6,5e5,0\n"), Contains("with itself"));
}

TEST_CASE("a table that ends before the number of rows in META.json is refused with both counts") {
  const Folder folder;
  const std::string stem = packings + "dense";
  const auto cut = [&](const std::string& table) {
    const std::string whole = bytes_of(stem + table);
    write_bytes(folder / "cut.csv", whole.substr(0, whole.find('\n', whole.size() / 2) + 1));
    return folder / "cut.csv";
  };
  CHECK_THAT(input_error([&] { io::import_csv(stem + ".particles.csv", cut(".contacts.csv"), stem + ".json"); }),
             Contains("cut.csv: has ") && Contains(" rows; allowed: 795, which is n_contacts in"));
  CHECK_THAT(input_error([&] { io::import_csv(cut(".particles.csv"), std::nullopt, stem + ".json"); }),
             Contains("cut.csv: has ") && Contains(" rows; allowed: 400, which is n_particles in"));
  CHECK_NOTHROW(io::import_csv(stem + ".particles.csv", std::nullopt, stem + ".json"));
}

TEST_CASE("forces and moments beyond what friction and the rolling cap let stand are refused") {
  const Folder folder;
  const std::string stem = packings + "dense", whole = bytes_of(stem + ".contacts.csv");
  std::istringstream lines(whole);
  std::string head, line;
  while (std::getline(lines, line) && !line.starts_with("id1")) head += line + "\n";
  std::vector<std::string> columns;
  std::istringstream names(line);
  for (std::string name; std::getline(names, name, ',');) columns.push_back(name);
  const auto refusal = [&](const std::string& column, const std::string& value) {
    const std::size_t begin = whole.find('\n', whole.find("\nid1") + 1) + 1, end = whole.find('\n', begin);
    std::istringstream row(whole.substr(begin, end - begin));
    std::string changed;
    std::size_t k = 0;
    for (std::string cell; std::getline(row, cell, ','); ++k) {
      changed += (k == 0 ? "" : ",") + (columns.at(k) == column ? value : cell);
    }
    write_bytes(folder / "c.csv", whole.substr(0, begin) + changed + whole.substr(end));
    return input_error([&] { io::import_csv(stem + ".particles.csv", folder / "c.csv", stem + ".json"); });
  };
  for (const std::string value : {"1e300", "-1e300", "1e6"}) {
    CHECK_THAT(refusal("fsx", value), Contains("c.csv:") && Contains("has a tangential force of") &&
                                          Contains("friction times the normal force"));
    CHECK_THAT(refusal("mz", value), Contains("has a rolling moment of") && Contains("allowed: up to"));
  }
}

TEST_CASE("what is no regular file is refused at once, and lists in lists of any depth by the key") {
  const Folder folder;
  REQUIRE(std::system(("mkfifo '" + (folder / "pipe") + "'").c_str()) == 0);
  for (const std::string& path : {folder / "pipe", std::string("/dev/zero"), folder.path()}) {
    CHECK_THAT(input_error([&] { io::import_csv(path, {}, {}); }), Contains(path + ": is not a regular file"));
  }
  const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
  write_bytes(folder / "m.json", "{\"dim\": 2, \"thickness_m\": 1, \"hSize\": " + deep + "}");
  CHECK_THAT(input_error([&] { io::import_csv(packings + "dense.particles.csv", {}, folder / "m.json"); }),
             Contains("m.json: hSize is no matrix"));
  write_bytes(folder / "m.json", "{\"dim\": " + deep + "}");
  CHECK_THAT(input_error([&] { io::import_csv(packings + "dense.particles.csv", {}, folder / "m.json"); }),
             Contains("dim = a list or an object is not a finite number"));
  write_bytes(folder / "m.json", "{\"dim\": \"" + std::string(70'000, 'x') + "\"}");
  CHECK(input_error([&] { io::import_csv(packings + "dense.particles.csv", {}, folder / "m.json"); }).size() < 500);
}
