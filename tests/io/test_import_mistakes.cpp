// Import: files that do not belong together, or are no good, are refused with place, value and remedy.
#include <sstream>

#include "tests/io/imported.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("a bad particle file is refused with file, line, column, value and remedy") {
  const auto error = [](const std::string& text) { return LooseSpheres(text).error(); };
  CHECK_THAT(error("id,x,y,z\n1,0,0,0\n"), Contains("r or radius"));
  CHECK_THAT(error("# c\nid,x,y,z,r\n1,0,zero,0,0.1\n"), Contains("p.csv:3: column y = zero"));
  CHECK_THAT(error("id,x,y,z,r\n1,0,nan,0,0.1\n"), Contains("p.csv:2: column y = nan"));
  CHECK_THAT(error("id,x,y,z,r\n1.5,0,0,0,0.1\n"), Contains("column id = 1.5"));
  CHECK_THAT(error("id,x,y,z,r\n1,0,0,0,0.1\n2,0,0,1,0.1\n1,1,0,0,0.1\n"), Contains("p.csv:4: column id = 1"));
  CHECK_THAT(error("id,x,y,z,r\n1,0,0,0,-0.1\n"), Contains("p.csv:2: column r = -0.1"));
  CHECK_THAT(error("id,x,y,z,r\n1,0,0,0\n"), Contains("4 cells"));
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
  CHECK_THAT(loose.error(), Contains("--cell"));
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
  CHECK_THAT(changed("dim", 4), Contains("dim = 4"));
  CHECK_THAT(changed("E_Pa", "stiff"), Contains("E_Pa = \"stiff\""));
  CHECK_THAT(changed("E_Pa", -1), Contains("young_modulus = -1"));
  CHECK_THAT(changed("E_Pa", nullptr), Contains("E_Pa is missing"));
  CHECK_THAT(changed("phi_deg", nullptr), Contains("mu or phi_deg"));
  CHECK_THAT(changed("nu", 0.25), Contains("both of kt_over_kn and nu"));
  CHECK_THAT(changed("kt_over_kn", nullptr), Contains("neither of kt_over_kn and nu"));
  CHECK_THAT(changed("thickness_m", nullptr), Contains("thickness_m is missing"));
  const char* columns = "hSize_columns_are_cell_vectors";
  CHECK_THAT(changed("hSize", meta("dense")[columns]), Contains("both of hSize"));
  CHECK_THAT(changed(columns, 0.2), Contains("hSize_columns_are_cell_vectors = 0.2"));
  CHECK_THAT(changed(columns, nlohmann::json::array({{0.0, 0.2}, {0.2, 0.0}})), Contains("right-handed"));
  CHECK_THAT(changed("p0_Pa", -1e5), Contains("p0_Pa"));
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
  CHECK_THAT(contact_error(header + "4,9,0,0,100001,0,30,0,1e6,5e5,0\n"), Contains("c.csv:2: column fn = 100001"));
  CHECK_THAT(contact_error(header + "4,9,1,0,1e5,0,30,0,1e6,5e5,0\n"), Contains("4-9"));
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0,1.00001e6,5e5,0\n"), Contains("column kn"));
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0,1e6,4e5,0\n"), Contains("column ks"));
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0.5,1e6,5e5,0\n"), Contains("rolling moment"));
  const std::string rolling = "\"beta\":2,\"eta\":0.1,";
  CHECK(contact_error(header + "4,9,0,0,1e5,0,30,0.5,1e6,5e5,1e6\n", rolling).empty());  // kr = beta kt ri rj
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0.5,1e6,5e5,2e6\n", rolling), Contains("column kr"));
  CHECK_THAT(contact_error("id1,id2,sx,sy,fn,fsx,fsy\n4,9,0,0,1e5,0,30\n", rolling), Contains("column mz"));
}

TEST_CASE("a bad contact file is refused with file, line, column, value and remedy") {
  CHECK_THAT(contact_error(header + "4,8,0,0,1e5,0,30,0,1e6,5e5,0\n"), Contains("c.csv:2: column id2 = 8"));
  CHECK_THAT(contact_error(header + "4,9,0,half,1e5,0,30,0,1e6,5e5,0\n"), Contains("column sy = half"));
  CHECK_THAT(contact_error(header + "4,9,99999999999,0,1e5,0,30,0,1e6,5e5,0\n"), Contains("column sx"));
  CHECK_THAT(contact_error("id1,id2,sx,sy,fn,fsx\n4,9,0,0,1e5,0\n"), Contains("column fsy is missing"));
  CHECK_THAT(contact_error(header + "4,9,0,0,1e5,0,30,0,1e6,5e5,0\n9,4,0,0,1e5,0,-30,0,1e6,5e5,0\n"),
             Contains("9-4 is there twice"));
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
             Contains(" rows; allowed: 795, which is n_contacts in"));
  CHECK_THAT(input_error([&] { io::import_csv(cut(".particles.csv"), std::nullopt, stem + ".json"); }),
             Contains(" rows; allowed: 400, which is n_particles in"));
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
    CHECK_THAT(refusal("fsx", value), Contains("has a tangential force of"));
    CHECK_THAT(refusal("mz", value), Contains("has a rolling moment of"));
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
