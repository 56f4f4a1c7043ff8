// What the command line and a CSV file say of a fit.
#include <cmath>
#include <tuple>

#include "rvelab/fit/curve.hpp"
#include "rvelab/fit/parameters.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;
using rvelab::test::input_error;

TEST_CASE("A varied key has a range, steps in its logarithm where asked, and values of a sweep") {
  const fit::Parameter plain = fit::parsed_parameter("material.friction=0.1:0.9");
  CHECK(plain.value(0.5) == Approx(0.5));
  CHECK(plain.grid == 0);
  const fit::Parameter steps = fit::parsed_parameter("material.young_modulus_Pa=1e7:1e9:5:log");
  CHECK(steps.value(0.5) == Approx(1e8));
  CHECK(steps.grid == 5);
  CHECK(plain.assignment(0.1) == "material.friction=0.1");
  for (const std::string wrong :
       {"friction", "a.b=1", "a.b=2:1", "a.b=0:1:log", "a.b=x:1", "a.b=0:1:1.5", "a.b=0:1:2:3"})
    CHECK_THAT(input_error([&] { fit::parsed_parameter(wrong); }), Contains("--vary " + wrong));
}

TEST_CASE("A target has a measure that tests give, a value, and where known its error and its pressure") {
  const fit::ScalarTarget found = fit::parsed_target("friction_angle_deg@50e3=30+-0.5");
  CHECK(found.measure == "friction_angle_deg");
  CHECK(found.pressure == 50e3);
  CHECK(found.value == 30);
  CHECK(found.error == 0.5);
  CHECK(fit::parsed_target("dilation_angle_deg=-2").value == -2);
  CHECK_THAT(input_error([] { fit::parsed_target("friction_angle=30"); }),
             Contains("the nearest is friction_angle_deg"));
  for (const std::string wrong :
       {"friction_angle_deg", "friction_angle_deg=a", "friction_angle_deg=1+--2", "friction_angle_deg@0=1"})
    CHECK_THAT(input_error([&] { fit::parsed_target(wrong); }), Contains("--target " + wrong));
}

TEST_CASE("A measured curve is read with its units and brought to few abscissae") {
  std::string text = "# drained\naxial_strain_percent, deviator_kPa, deviator_kPa_error, volumetric_strain_percent\n";
  for (int k = 0; k <= 40; ++k)
    text += std::to_string(0.25 * k) + "," + std::to_string(10.0 * k) + ",2," + std::to_string(-0.05 * k) + "\n";
  const auto curves = fit::parsed_curves(text, "d.csv");
  REQUIRE(curves.size() == 2);
  CHECK(curves[0].name == "deviator");
  CHECK(curves[0].x.size() == fit::most_points);
  CHECK(curves[0].x.back() == Approx(0.1));
  for (std::size_t k = 0; k < fit::most_points; ++k) {
    CHECK(curves[0].y[k] == Approx(4e6 * curves[0].x[k]));
    CHECK(curves[0].error[k] == Approx(2e3));
    CHECK(curves[1].y[k] == Approx(-0.2 * curves[1].x[k]).margin(1e-15));
    CHECK(curves[1].error[k] == 0);
  }
  const auto refused = [](const std::string& csv) { return input_error([&] { fit::parsed_curves(csv, "d.csv"); }); };
  CHECK_THAT(refused("strain,q_over_p\n0,0\n1,1\n"), Contains("d.csv") && Contains("axial_strain_percent"));
  CHECK_THAT(refused("axial_strain,r\n0,0\n1,1\n"), Contains("\"r\" is not known"));
  CHECK_THAT(refused("axial_strain,q_over_p\n0,0\n0,1\n"), Contains("d.csv: 1 rows are left"));
  CHECK_THAT(refused("axial_strain,q_over_p\n0,0\n1,a\n"),
             Contains("d.csv:3: column q_over_p = a is not a finite number"));
  CHECK_THAT(refused("axial_strain,q_over_p\n0,0\n1\n"), Contains("d.csv:3: the row has 1 cells"));
  CHECK_THAT(refused("axial_strain,q_over_p\n0,0\n"), Contains("at least 2"));
}

TEST_CASE("A measured curve of a spreadsheet is the same curve: semicolons, decimal commas, quotation marks, sep=") {
  const auto expect = [](const std::string& text) {
    CAPTURE(text);
    const auto curves = fit::parsed_curves(text, "d.csv");
    REQUIRE(curves.size() == 1);
    CHECK(curves[0].name == "deviator");
    CHECK(curves[0].x == std::vector<double>{0.1 * 0.01, 1.5 * 0.01, 3 * 0.01});
    CHECK(curves[0].y == std::vector<double>{121.15e3, 252.4e3, 275.77e3});
    CHECK(curves[0].error == std::vector<double>{2e3, 2e3, 2.5e3});
  };
  const std::string names = "axial_strain_percent,deviator_kPa,deviator_kPa_error\n";
  expect(names + "0.1,121.15,2\n1.5,252.4,2\n3,275.77,2.5\n");
  std::string semicolons = "axial_strain_percent;deviator_kPa;deviator_kPa_error\r\n";
  semicolons += "0,1;121,15;2\r\n1,5;252,4;2\r\n3;275,77;2,5\r\n";
  expect(semicolons);
  expect("\xef\xbb\xbfsep=;\r\n" + semicolons + ";;\r\n");
  expect(
      "\"axial_strain_percent\",\"deviator_kPa\",\"deviator_kPa_error\"\n\"0,1\",\"121,15\",2\n\"1,5\",\"252,4\",2\n3,"
      "\"275,77\",\"2,5\"\n");
  expect("axial_strain_percent\tdeviator_kPa\tdeviator_kPa_error\n0,1\t121,15\t2\n1,5\t252,4\t2\n3\t275,77\t2,5");
}

TEST_CASE("A column that is given twice, a quantity in two units, or an error of no column is refused by name") {
  const auto refused = [](const std::string& csv) { return input_error([&] { fit::parsed_curves(csv, "d.csv"); }); };
  CHECK_THAT(refused("axial_strain,deviator_kPa,deviator_kPa\n0,0,0\n1,1,2\n"),
             Contains("the column deviator_kPa twice"));
  CHECK_THAT(refused("axial_strain,deviator_kPa,deviator_Pa\n0,0,0\n1,1,2\n"),
             Contains("deviator_kPa and deviator_Pa are one quantity twice"));
  CHECK_THAT(refused("axial_strain,axial_strain\n0,0\n1,1\n"), Contains("axial_strain twice"));
  CHECK_THAT(refused("axial_strain,q_over_p,deviator_kPa_error\n0,0,0\n1,1,2\n"),
             Contains("\"deviator_kPa_error\" is the error of no column"));
  CHECK_THAT(refused("p_kPa,void_ratio\n5e-324,0.8\n20,0.7\n"), Contains("void_ratio has no finite value"));
  CHECK_THAT(refused("axial_strain;q_over_p\n0,5;0\n1.5;1\n"), Contains("decimal comma") && Contains("decimal point"));
}

TEST_CASE("The curve of a test is that of its last stage, between its records and not beyond them") {
  records::TestResult test;
  for (int k = 0; k <= 10; ++k) {
    records::Record record;
    record.stage = 1;
    record.strain = 0.01 * k;
    record.stress(0, 0) = -1e4;
    record.stress(1, 1) = -1e4 - 2e5 * record.strain;
    record.deformation_gradient(1, 1) = 1 - record.strain;
    record.void_ratio = 0.2 - record.strain;
    test.records.push_back(record);
  }
  const fit::Curve like{"deviator", "strain", {0.005, 0.095, 0.2}, {0, 0, 0}, {0, 0, 0}};
  const auto found = fit::curve_of(test, 2, like).y;
  CHECK(found[0] == Approx(1e3));
  CHECK(found[1] == Approx(19e3));
  CHECK(std::isnan(found[2]));
  // e over log p: p = 1e4 + 1e5 strain; straight in the logarithm between two records.
  const double p = std::sqrt(12e3 * 13e3);
  const auto e = fit::curve_of(test, 2, {"void_ratio", "p", {p}, {0}, {0}}).y;
  CHECK(e[0] == Approx(0.2 - 0.025));
  // Strain over the axial stress counts from the first measured stress: sigma_1 = 1e4 + 2e5 strain.
  const double first = std::sqrt(12e3 * 14e3), second = std::sqrt(14e3 * 16e3);
  const auto strains = fit::curve_of(test, 2, {"strain", "axial_stress", {first, second}, {0, 0.01}, {0, 0}}).y;
  CHECK(strains[0] == 0);
  CHECK(strains[1] == Approx(0.01));
  // A stage before the last that rises to it counts too, its strain before that: sigma_1 = 8e3 + 4e4 strain, to 1e4.
  std::vector<records::Record> before(2);
  for (int k : {0, 1}) {
    before[k].strain = 0.05 * k;
    before[k].stress(1, 1) = -8e3 - 4e4 * before[k].strain;
  }
  test.records.insert(test.records.begin(), before.begin(), before.end());
  const auto longer = fit::curve_of(test, 2, {"strain", "axial_stress", {8e3, 12e3}, {0, 0}, {0, 0}}).y;
  CHECK(longer[1] == Approx(0.05 + 0.01));
  CHECK(fit::targets_of(like, 3)[1].curve == 3);
}

TEST_CASE("What is read off a curve of a test is the same as of a measured one, up to where that ends") {
  records::TestResult test;
  for (int k = 0; k <= 100; ++k) {
    records::Record record;
    record.strain = 0.001 * k;
    // sigma_1 - sigma_3 = 3e5 sin(pi strain/0.1), largest at 0.05.
    record.stress = -1e4 * Matrix3::Identity();
    record.stress(1, 1) -= 3e5 * std::sin(3.14159265358979 * record.strain / 0.1);
    test.records.push_back(record);
  }
  const auto found = fit::curve_of(test, 2, {"deviator", "strain", {0.01, 0.08}, {0, 0}, {0, 0}}).features;
  CHECK(found.largest == Approx(3e5));
  CHECK(found.at_largest == Approx(0.05));
  CHECK(found.early == Approx(3e5 * std::sin(3.14159265358979 * 0.01)));
  CHECK(found.last == Approx(3e5 * std::sin(3.14159265358979 * 0.8)));
  const auto before = fit::curve_of(test, 2, {"deviator", "strain", {0.01, 0.03}, {0, 0}, {0, 0}}).features;
  CHECK(before.at_largest == Approx(0.03));
}

TEST_CASE("Columns are known by the names that laboratories give them, with their unit") {
  const std::string rows = "\n0,0,0,100\n1,50,0.1,110\n2,80,-0.1,120\n";
  const auto curves = fit::parsed_curves("eps_a [%],q [kPa],Eps_v (%),p' [kPa]" + rows, "d.csv");
  REQUIRE(curves.size() == 3);
  CHECK(curves[0].name == "deviator");
  CHECK(curves[0].x[1] == Approx(0.01));
  CHECK(curves[0].y[2] == Approx(80e3));
  CHECK(curves[1].y[1] == Approx(0.001));
  CHECK(curves[2].name == "p");
  CHECK(curves[2].y[2] == Approx(120e3));
  const auto refused = [&](const std::string& header, const fit::Selection& selection = {}) {
    return input_error([&] { fit::parsed_curves(header + rows, "d.csv", selection); });
  };
  CHECK_THAT(refused("eps_a,q,eps_v,p_kPa"), Contains("\"q\" has no unit") && Contains("deviator_kPa=q"));
  CHECK_THAT(refused("eps_a,q_percent,eps_v,p_kPa"), Contains("\"q_percent\" is not known"));
  CHECK_THAT(refused("eps_a [kPa],q_kPa,eps_v,p_kPa"), Contains("the first column"));
  CHECK_THAT(refused("time,q_kPa,eps_v,u"), Contains("the first column is \"time\""));
}

TEST_CASE("Columns that are named are read, under the names of the file, and further ones left out") {
  const std::string text = "time,F,q,u\n0,0,0,7\n60,1,50,7\n120,2,80,7\n";
  const auto curves = fit::parsed_curves(text, "d.csv", {{"axial_strain_percent=F", "deviator_kPa=q"}, {}, {}});
  REQUIRE(curves.size() == 1);
  CHECK(curves[0].x[2] == Approx(0.02));
  CHECK(curves[0].y[2] == Approx(80e3));
  const auto refused = [&](const std::vector<std::string>& columns) {
    return input_error([&] { fit::parsed_curves(text, "d.csv", {columns, {}, {}}); });
  };
  CHECK_THAT(refused({"axial_strain=F", "deviator_kPa=Q2"}), Contains("Q2"));
  CHECK_THAT(refused({"deviator_kPa=q", "axial_strain=F"}), Contains("no abscissa"));
  CHECK_THAT(refused({"axial_strain=F", "time"}), Contains("no curve"));
  CHECK_THAT(refused({"axial_strain=F"}), Contains("no column beside"));
}

TEST_CASE("Unloading is left out, of a held stress the last row counts, and from and to bound the rows") {
  const std::string text =
      "vertical_stress_kPa,vertical_strain_percent\n1,0.1\n10,0.5\n20,0.8\n20,0.9\n40,1.3\n40,1.4\n10,1.2\n30,1.35\n";
  const auto curves = fit::parsed_curves(text, "d.csv");
  REQUIRE(curves.size() == 1);
  CHECK(curves[0].name == "strain");
  CHECK(curves[0].abscissa == "axial_stress");
  CHECK(curves[0].x == std::vector<double>{1e3, 10e3, 20e3, 40e3});
  CHECK(curves[0].y[2] == Approx(0.008));  // counts from the first row
  CHECK(curves[0].y[3] == Approx(0.013));
  const auto part = fit::parsed_curves(text, "d.csv", {{}, 10.0, 20.0});
  CHECK(part[0].x == std::vector<double>{10e3, 20e3});
  CHECK(part[0].y[1] == Approx(0.004));
  CHECK_THAT(input_error([&] { fit::parsed_curves(text, "d.csv", {{}, 15.0, 20.0}); }), Contains("1 rows are left"));
  const auto strain = fit::parsed_curves("axial_strain,q_over_p\n0,0\n1,1\n2,1.2\n1.5,0.4\n", "d.csv");
  CHECK(strain[0].x.size() == 3);
}

TEST_CASE("Points of a curve lie where it bends") {
  // q = 1 - exp(-x/0.01): with points at even distances straight lines miss it by up to 0.5 near the beginning.
  std::string text = "axial_strain,q_over_p\n";
  const auto q = [](double x) { return 1 - std::exp(-x / 0.01); };
  for (int k = 0; k <= 200; ++k) text += std::to_string(0.001 * k) + "," + std::to_string(q(0.001 * k)) + "\n";
  const auto curves = fit::parsed_curves(text, "d.csv");
  const auto& [x, y] = std::tie(curves[0].x, curves[0].y);
  REQUIRE(x.size() == fit::most_points);
  double worst = 0;
  for (std::size_t k = 1; k < x.size(); ++k)
    for (double part = 0; part <= 1; part += 0.05)
      worst = std::max(worst, std::abs(std::lerp(y[k - 1], y[k], part) - q(std::lerp(x[k - 1], x[k], part))));
  CHECK(worst < 0.05);
}

TEST_CASE("The scatter of laboratories grows with the value, and is at least a part of the largest") {
  fit::Curve curve{"deviator", "strain", {0, 0.01, 0.02}, {0, 50e3, 100e3}, {0, 0, 0}};
  fit::assume_scatter(curve);
  CHECK(curve.error[0] == Approx(1e3));
  CHECK(curve.error[2] == Approx(std::hypot(4e3, 1e3)));
  CHECK(fit::laboratory_scatter("deviator") == "4 % of each value and 1 % of the largest");
}
