// The files of a sheet, what stands beside it, and its tests as elements of a continuum.
#include "rvelab/sheet/write_sheet.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>

#include "rvelab/sheet/beside.hpp"
#include "rvelab/sheet/element_tests.hpp"
#include "rvelab/sheet/fitted_models.hpp"
#include "rvelab/sheet/numbers.hpp"
#include "tests/catch.hpp"
#include "tests/folder.hpp"
#include "tests/refusal.hpp"
#include "tests/sheet/made_tests.hpp"

using namespace rvelab;
using namespace rvelab::test;
using sheet::Figure;
using sheet::Number;
using sheet::Sheet;

namespace {

Number made_number(const std::string& key, double mean, double pressure = sheet::unknown) {
  Number number;
  number.key = key;
  number.label = "a \"label\", <b>";
  number.unit = "degrees";
  number.group = "Strength";
  number.mean = mean;
  number.pressure = pressure;
  number.tests = {"one", "two"};
  return number;
}

Sheet made_sheet() {
  Sheet made;
  made.soil = "sand </script><script>alert(1)</script>";
  made.numbers = {made_number("phi_cs_deg", 31), made_number("phi_peak_deg", 38, 100e3)};
  made.numbers[0].low = 30, made.numbers[0].high = 32, made.numbers[0].standard_error = 0.3;
  made.figures.push_back({"drained_q",
                          "Drained",
                          "x",
                          "y",
                          "",
                          false,
                          false,
                          {{"drained, dense, 100 kPa", {0, 1}, {0, sheet::unknown}, {}, true, false}},
                          "Curves"});
  return made;
}

/// The JSON within a page.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const auto from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

/// Cells of a line of CSV, quotation marks undone.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"')
      cells.back() += line[++k];
    else if (line[k] == '"')
      quoted = !quoted;
    else if (line[k] == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += line[k];
  }
  return cells;
}

Test drained(const char* name, std::size_t density, std::uint64_t seed, double p, double factor) {
  return compression(Purpose::drained, {name, density, 0.3 * double(density + 1), seed, p}, [=](double strain) {
    return Point{factor * p * strain / (0.01 + strain), -0.1 * strain, 0.7 + 0.17 * strain, p};
  });
}

}  // namespace

TEST_CASE("summary.json and summary.csv hold every number in full, undefined values as null and as empty cells") {
  Sheet made = made_sheet();
  made.numbers[0].mean = 31.000000000000004;
  made.numbers[0].published = 31.5;
  const auto json = nlohmann::json::parse(json_of_sheet(made, {}));
  CHECK(json["numbers"][0]["published_within_interval"] == true);
  CHECK(json["numbers"][1]["published_within_interval"].is_null());
  CHECK(json["soil"] == made.soil);
  CHECK(json["numbers"][0]["mean"] == 31.000000000000004);
  CHECK(json["numbers"][1]["low_95"].is_null());
  CHECK(json["numbers"][1]["pressure_Pa"] == 100e3);
  CHECK(json["numbers"][0]["tests"].size() == 2);
  const std::string csv = csv_of_sheet(made);
  std::vector<std::string> lines;
  for (std::size_t from = 0; from < csv.size();) {
    const auto end = csv.find('\n', from);
    lines.push_back(csv.substr(from, end - from));
    from = end + 1;
  }
  REQUIRE(lines.size() == 3);
  const auto head = cells_of(lines[0]), row = cells_of(lines[1]);
  REQUIRE(head.size() == row.size());
  const auto at = [&](const std::string& name) {
    return row[std::size_t(std::find(head.begin(), head.end(), name) - head.begin())];
  };
  CHECK(std::stod(at("mean")) == 31.000000000000004);
  CHECK(at("pressure_Pa").empty());
  CHECK(at("label") == "a \"label\", <b>");
  CHECK(at("tests") == "one two");
}

TEST_CASE("the page has the critical angle first, no tag of a name, and curves with holes") {
  const std::string page = page_of_sheet(made_sheet(), {});
  CHECK(page.find("alert(1)</script>") == std::string::npos);
  const auto data = data_of(page);
  CHECK(data["headline"][0]["value"] == "31.00 \u00b1 0.30\u00b0");
  CHECK(data["headline"][0]["interval"] == "30.0 to 32.0\u00b0");
  CHECK(data["groups"][0]["name"] == "Strength");
  CHECK(data["groups"][0]["list"].size() == 2);                // the head, and the number of all pressures
  CHECK(data["groups"][0]["matrices"][0][0][1] == "100 kPa");  // the other one
  CHECK(data["groups"][1]["figures"][0]["series"][0]["y"][1].is_null());
}

TEST_CASE("a model is drawn over the curve of its test, with its misfit by the side of what it was fitted to") {
  models::Fit fit;
  fit.model = "made";
  fit.parameters = {{"phi", "degrees", "friction angle", 33, 32, 34},
                    {"nu", "", "Poisson's ratio", 0.2, models::unknown, models::unknown, models::Origin::sheet}};
  fit.misfits = {{"drained, dense, 100 kPa", false, 0.05, 0.01, ""}};
  models::ElementTest calculated;
  calculated.name = "drained, dense, 100 kPa";
  calculated.strain = {0, 0.01};
  calculated.q = {0, 5e4};
  calculated.p = {1e5, 1.2e5};
  calculated.eps_v = {0, 0};
  fit.calculated = {calculated};
  const auto model = data_of(page_of_sheet(made_sheet(), {fit}))["models"][0];
  CHECK(model["parameters"][1][2] == "32.0 to 34.0\u00b0");
  CHECK(model["parameters"][2][2] == "");
  CHECK(model["parameters"][2][3] == "sheet");
  CHECK(model["misfits"][1][1] == "prediction");
  const auto series = model["figures"][0]["series"];
  REQUIRE(series.size() == 2);
  CHECK(series[0]["line"] == false);
  CHECK(series[0]["kind"] == series[1]["kind"]);
  CHECK(series[1]["y"][1] == 50);  // kPa
}

TEST_CASE("a sheet is written into a new folder, over an older one, and not onto a file") {
  const Folder folder;
  const std::string place = folder / "new/SHEET";
  write_sheet(made_sheet(), {}, place);
  Sheet other = made_sheet();
  other.numbers.pop_back();
  write_sheet(other, {}, place);
  for (const char* name : {"index.html", "summary.json", "summary.csv"})
    CHECK(std::filesystem::is_regular_file(place + "/" + name));
  CHECK(std::distance(std::filesystem::directory_iterator(place), std::filesystem::directory_iterator()) == 3);
  std::ofstream(folder / "file") << "x";
  CHECK(input_error([&] { write_sheet(other, {}, folder / "file"); }).find("cannot be made") != std::string::npos);
}

TEST_CASE("published numbers and measured curves stand beside those of the sheet") {
  const Folder folder;
  std::ofstream(folder / "curve.csv") << "axial_strain_percent,deviator_kPa\n0,0\n1,50\n2,80\n5,100\n";
  std::ofstream(folder / "beside.toml")
      << "[[number]]\nkey = \"phi_cs_deg\"\nvalue = 33\nby = \"Li and Wang 1998\"\n[[number]]\nkey = \"phi_peak_deg\"\n"
         "value = 40\npressure_Pa = 200e3\n[[measured]]\nname = \"TMD\"\ntest = \"drained\"\ncurve = \"curve.csv\"\n"
         "[[points]]\nname = \"P\"\nfigure = \"drained_q\"\nx = [1, 2]\ny = [3, 4]\n[[points]]\nname = \"Q\"\nfigure = "
         "\"drained\"\nx = [1]\ny = [3]\n[[number]]\nkey = \"phi_cs\"\nvalue = 3\n";
  Sheet made = made_sheet();
  add_measured(made, folder / "beside.toml");
  CHECK(made.numbers[0].published == 33);
  CHECK(std::isnan(made.numbers[1].published));
  REQUIRE(made.remarks.size() == 3);
  CHECK(made.remarks[0].find("phi_peak_deg stands beside no number") != std::string::npos);
  CHECK(made.remarks[1].find("none of this name; the nearest is phi_cs_deg") != std::string::npos);
  CHECK(made.remarks[2].find("no figure drained; the nearest is drained_q") != std::string::npos);
  const auto& series = made.figures[0].series;
  REQUIRE(series.size() == 3);
  CHECK(series[1].measured);
  CHECK(series[1].x.back() == Approx(5));  // percent
  CHECK(series[1].y.back() == Approx(100));
  CHECK(series[2].label == "P");
  const auto data = data_of(page_of_sheet(made, {}));
  CHECK(data["headline"][0]["published"] == "33.0\u00b0 (Li and Wang 1998): 2.00\u00b0 below it");
}

TEST_CASE("a measured extension is not drawn among compressions") {
  const Folder folder;
  std::ofstream(folder / "curve.csv") << "axial_strain_percent,deviator_kPa\n0,0\n1,-50\n2,-80\n5,-90\n";
  std::ofstream(folder / "beside.toml") << "[[measured]]\nname = \"TE\"\ntest = \"drained\"\ncurve = \"curve.csv\"\n";
  Sheet made = made_sheet();
  add_measured(made, folder / "beside.toml");
  CHECK(made.figures[0].series.size() == 1);
  REQUIRE(made.remarks.size() == 1);
  CHECK_THAT(made.remarks[0], Catch::Matchers::Contains("TE is not drawn") && Catch::Matchers::Contains("extension"));
  // Nor what stands before its deviator; a compression that liquefies may end a little below 0.
  const auto drawn = [&](const char* rows) {
    std::ofstream(folder / "curve.csv") << "axial_strain_percent,volumetric_strain_percent,deviator_kPa\n" << rows;
    Sheet own = made_sheet();
    own.figures.push_back(own.figures[0]);
    own.figures.back().key = "drained_volume";
    const std::size_t before = own.figures.back().series.size();
    add_measured(own, folder / "beside.toml");
    CHECK(own.figures[0].series.size() == own.figures.back().series.size());
    return own.figures.back().series.size() > before;
  };
  CHECK(!drawn("0,0,0\n1,-1,-50\n2,-2,-80\n5,-3,-90\n"));
  CHECK(!drawn("0,0,5\n1,-1,-50\n2,-2,-80\n5,-3,0.1\n"));
  CHECK(drawn("0,0,0\n1,1,50\n2,2,20\n5,3,-0.1\n"));
}

TEST_CASE("a wrong file beside a sheet is refused with its line and the remedy") {
  const Folder folder;
  const auto message = [&](const std::string& text) {
    std::ofstream(folder / "b.toml") << text;
    Sheet made = made_sheet();
    return input_error([&] { add_measured(made, folder / "b.toml"); });
  };
  CHECK(message("[[number]]\nkey = \"phi_cs_deg\"\nvalu = 3\n").find("b.toml:3") != std::string::npos);
  CHECK(message("[[points]]\nname = \"P\"\nfigure = \"G0\"\nx = [1, 2]\ny = [1]\n").find("has 1 numbers, and x 2") !=
        std::string::npos);
  CHECK(message("[[measured]]\nname = \"P\"\ntest = \"draind\"\ncurve = \"c.csv\"\n").find("drained") !=
        std::string::npos);
  CHECK(message("").find("neither [[number]]") != std::string::npos);
  CHECK(message("[number]\nkey = \"a\"\n").find("[[number]]") != std::string::npos);
  CHECK(message("[[measured]]\nname = \"P\"\ntest = \"drained\"\ncurve = \"c.csv\"\n").find("c.csv") !=
        std::string::npos);
  CHECK(input_error([&] {
          Sheet made = made_sheet();
          add_measured(made, folder / "missing.toml");
        }).find("missing.toml") != std::string::npos);
}

TEST_CASE("element tests are means over seeds at common strains, with middle pressure and density kept back") {
  std::vector<Test> tests;
  const char* const names[] = {"loose", "medium", "dense"};
  for (std::size_t density = 0; density < 3; ++density)
    for (const double p : {50e3, 100e3, 200e3})
      for (std::uint64_t seed : {1, 2})
        tests.push_back(drained(names[density], density, seed, p, seed == 1 ? 2.0 : 3.0));
  tests[1].result.records.resize(201);  // the second seed of the first ends at 10 %
  const auto elements = sheet::element_tests(tests);
  REQUIRE(elements.size() == 9);
  const auto& first = elements.front();
  CHECK(first.name == "drained, loose, 50 kPa");
  CHECK(first.p0 == Approx(50e3));
  CHECK(first.e0 == Approx(0.7));
  CHECK(first.strain.back() == Approx(0.1));
  CHECK(first.q.back() == Approx(2.5 * 50e3 * 0.1 / 0.11).epsilon(1e-6));
  CHECK(first.p.back() == Approx(50e3 + first.q.back() / 3));
  CHECK(first.eps_v.back() == Approx(-0.01));
  for (const auto& element : elements) {
    const bool middle =
        element.name.find("medium") != std::string::npos || element.name.find("100 kPa") != std::string::npos;
    CHECK(element.fitted == !middle);
  }
  const auto one = sheet::element_tests(tests, 1);
  REQUIRE(one.size() == 3);
  CHECK(one[0].fitted);
  CHECK(!one[1].fitted);
  for (Test& test : tests) test.dimension = 2;
  CHECK(sheet::element_tests(tests).empty());
}

TEST_CASE("undrained tests are kept back, and of two densities and pressures nothing else") {
  std::vector<Test> tests;
  for (const double p : {50e3, 100e3}) tests.push_back(drained("dense", 0, 1, p, 2));
  tests.push_back(compression(Purpose::undrained, {"dense", 0, 0.8, 1, 100e3}, [](double strain) {
    return Point{1e6 * strain, 0, 0.7, 100e3};
  }));
  const auto elements = sheet::element_tests(tests);
  REQUIRE(elements.size() == 3);
  CHECK(elements[0].fitted);
  CHECK(elements[1].fitted);
  CHECK(!elements[2].fitted);
}

TEST_CASE("the manual defines every number and names every figure") {
  const std::filesystem::path root = RVELAB_SOURCE_DIR;
  const std::string page = bytes_of(root / "tools/manual/pages/sheet_numbers.md");
  const std::regex number("_group,\\s*\"([A-Za-z0-9_]+)\""), figure("Figure [a-z_]+\\{\\s*\"([A-Za-z0-9_]+)\"");
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(root / "rvelab/sheet")) {
    const std::string code = bytes_of(entry.path());
    for (const std::regex& each : {number, figure})
      for (std::sregex_iterator match(code.begin(), code.end(), each), end; match != end; ++match, ++found) {
        CAPTURE((*match)[1].str());
        CHECK(page.find("`" + (*match)[1].str() + "`") != std::string::npos);
      }
  }
  CHECK(found > 60);
}

TEST_CASE("numbers go by their keys; one of several densities is also their mean") {
  Sheet made = made_sheet();
  for (const char* name : {"loose", "dense"}) {
    made.numbers.push_back(made_number("R_f", name[0] == 'l' ? 0.8 : 0.9));
    made.numbers.back().density_name = name;
  }
  const auto numbers = numbers_by_key(made);
  CHECK(numbers.at("phi_cs_deg") == 31);
  CHECK(numbers.at("phi_peak_deg.100kPa") == 38);
  CHECK(numbers.at("R_f") == Approx(0.85));
  CHECK(numbers.at("R_f.dense") == 0.9);
  CHECK(numbers_by_key(made, "dense").at("R_f") == 0.9);
  CHECK(numbers_by_key(made, "dense").at("phi_cs_deg") == 31);
}

TEST_CASE("models are fitted once, or once a density; files of models that a sheet does not have are removed") {
  std::vector<Test> tests = bolton_tests(3, 9.2, 1);
  std::erase_if(tests, [](const Test& test) { return test.density == 1 || test.pressure == 50e3; });
  const Sheet sheet = sheet::numbers_of(tests, "sand");
  Workers workers(1);
  const sheet::FittedModels found =
      sheet::fitted_models({"mohr_coulomb", "hardening_soil_small", "norsand"}, tests, sheet, workers);
  std::vector<std::string> models, files;
  for (const models::Fit& fit : found.fits) models.push_back(fit.model);
  CHECK(models == std::vector<std::string>{"Mohr-Coulomb, loose", "Mohr-Coulomb, dense", "NorSand"});
  for (const sheet::ModelFile& file : found.files) files.push_back(file.name + ": " + file.text.substr(0, 16));
  CHECK(files == std::vector<std::string>{"mohr_coulomb_loose_abaqus.inp: ** Mohr-Coulomb ",
                                          "mohr_coulomb_loose_calculix.inp: ** Mohr-Coulomb ",
                                          "mohr_coulomb_loose.txt: # Mohr-Coulomb; ",
                                          "mohr_coulomb_dense_abaqus.inp: ** Mohr-Coulomb ",
                                          "mohr_coulomb_dense_calculix.inp: ** Mohr-Coulomb ",
                                          "mohr_coulomb_dense.txt: # Mohr-Coulomb; ", "norsand.txt: # NorSand; low a"});
  REQUIRE(found.remarks.size() == 2);  // Hardening Soil of both densities
  CHECK_THAT(found.remarks[0], Catch::Matchers::Contains("hardening_soil_small_loose is left out: "));

  const Folder folder;
  std::filesystem::create_directories(folder / "models");
  for (const char* name : {"models/norsand.txt", "models/hypoplasticity.txt", "models/notes.txt"})
    write_bytes(folder / name, "old");
  sheet::write_models(found, folder.path());
  CHECK(bytes_of(folder / "models/norsand.txt").starts_with("# NorSand"));
  CHECK(!std::filesystem::exists(folder / "models/hypoplasticity.txt"));
  CHECK(bytes_of(folder / "models/notes.txt") == "old");
}
