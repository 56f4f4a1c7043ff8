// Curves as machines of laboratories export them: each is the same curve as its clean table, and what was joined or
// left out is said.
#include <cmath>
#include <fstream>

#include "rvelab/fit/curve.hpp"
#include "rvelab/fit/numerals.hpp"
#include "tests/catch.hpp"
#include "tests/folder.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;
using rvelab::test::input_error;

namespace {

const std::vector<double> strains{0, 0.1, 0.25, 0.5, 1, 2, 3, 4.5, 6},
    deviators{0, 40, 75, 110, 140, 160, 165, 162, 155};

/// Tells each sentence to itself, in one text.
struct Read {
  std::vector<fit::Curve> curves;
  std::string said;
};
Read curves_of(const std::string& text, const fit::Selection& selection = {}) {
  Read found;
  found.curves =
      fit::parsed_curves(text, "d.csv", selection, [&](const std::string& what) { found.said += what + "\n"; });
  return found;
}

/// The clean triaxial test, to a part of its largest strain and deviator.
Read expect_triaxial(const std::string& text, const fit::Selection& selection = {}, double tolerance = 1e-12) {
  CAPTURE(text);
  Read found = curves_of(text, selection);
  INFO(found.said);
  REQUIRE(found.curves.size() == 1);
  const auto& [x, y] = std::tie(found.curves[0].x, found.curves[0].y);
  REQUIRE(x.size() == strains.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    CHECK(x[k] == Approx(0.01 * strains[k]).margin(0.06 * tolerance));
    CHECK(y[k] == Approx(1e3 * deviators[k]).margin(165e3 * tolerance));
  }
  return found;
}

std::string in_utf16(const std::string& ascii) {
  std::string text = "\xff\xfe";
  for (const char letter : ascii) text += {letter, '\0'};
  return text;
}

std::string refused(const std::string& text, const fit::Selection& selection = {}) {
  return input_error([&] { fit::parsed_curves(text, "d.csv", selection); });
}

const fit::Selection by_name{{"axial_strain_percent=Axial Strain (%)", "deviator_kPa=Deviator Stress (kPa)"}, {}, {}};

}  // namespace

TEST_CASE("A number is read by its marks, and one that could be two says so") {
  for (const char* text :
       {"1234.5", "1234,5", "1,234.5", "1.234,5", "1 234,5", "1'234.5", "+1234.5", "1.2345e3", "1,2345E+03",
        "1\xc2\xa0"
        "234,5"}) {
    CAPTURE(text);
    REQUIRE(fit::numeral(text));
    CHECK(fit::numeral(text)->value == Approx(1234.5));
    CHECK(fit::numeral(text)->certain);
  }
  CHECK(fit::numeral("-1,234,567")->value == -1234567);
  CHECK(fit::numeral("\xe2\x88\x92"
                     "2")
            ->value == -2);
  CHECK(!fit::numeral("1,234")->certain);
  CHECK(fit::numeral("1,234")->value == 1.234);
  CHECK(fit::numeral("1,234")->grouped == 1234);
  CHECK(fit::numeral("0,234")->certain);
  for (const char* text :
       {"", "-", ".", "1,23,456", "1.2.3", "12:30:05", "29.11.2026", "1e999", "2 kPa", "nan", "1,234.5,6"})
    CHECK(!fit::numeral(text));
}

TEST_CASE("Titles above the header, units below it, remarks and time stamps are no rows") {
  const std::string rows =
      "10,0,0\n20,0.1,40\n30,0.25,75\n40,0.5,110\n50,1,140\n60,2,160\n70,3,165\n80,4.5,162\n90,6,155\n";
  const Read gds = expect_triaxial(
      "\"Project\",\"Sand 7 1/2\"\" mould\"\n\"Initial height (mm)\",\"100.0\"\n\nStage,3\n"
      "\"Time (s)\",\"Axial Strain (%)\",\"Deviator Stress (kPa)\"\n" +
          rows,
      by_name);
  CHECK_THAT(gds.said, Contains("d.csv: the header is line 5; what stands above it is left out, lines 1 to 2, 4"));
  const Read units = expect_triaxial("time,eps_a,q\ns,[%],(kPa)\n" + rows + "End of test,,\n",
                                     {{"axial_strain=eps_a", "deviator=q"}, {}, {}});
  CHECK_THAT(units.said, Contains("left out: line 12"));
  CHECK(curves_of("Sample 3,\n,\neps_a,q\n%,kPa\n0,0\n1,50\n").curves[0].x[1] == 0.01);
  CHECK(curves_of("p and e of the sample\np;100\ne;0.65\nEPS_A [%];Q [kPa]\n0;0\n1;50\n").curves[0].y[1] == 50e3);
  CHECK(curves_of("Test\nEPS;Q\n%;kPa\n0;0\n1;50\n", {{"axial_strain=eps", "deviator=q"}, {}, {}}).curves[0].x[1] ==
        0.01);
  CHECK_THAT(refused("Test\nA;B\n%;kPa\n0;0\n1;50\n"), Contains("d.csv:2: the first column is \"A"));
  CHECK_THAT(refused("eps_a,q\nmm,kPa\n0,0\n1,50\n"), Contains("d.csv:1: the first column is \"eps_a [mm]\""));
  CHECK_THAT(refused("A,B\n0,0\n1,50\n", by_name),
             Contains("d.csv:1: the column Axial Strain (%) is missing; the header is A, B"));
}

TEST_CASE("Tables of machines under Windows are read: UTF-16, Latin-1, tabs, decimal commas, carriage returns") {
  std::string tabs = "Axial Strain (%)\tDeviator Stress (kPa)\t\t\r\n",
              semicolons =
                  "Pr\xfc"
                  "fung 3;;\r\nAxial Strain (%);Temperatur [\xb0"
                  "C];Deviator Stress (kPa);\r\n";
  for (std::size_t k = 0; k < strains.size(); ++k) {
    std::string strain = std::to_string(strains[k]), deviator = std::to_string(deviators[k]);
    tabs += strain + "\t" + deviator + "\t\t\r\n";
    for (std::string* each : {&strain, &deviator}) std::replace(each->begin(), each->end(), '.', ',');
    semicolons += strain + ";20,5;" + deviator + ";\r\n";
  }
  expect_triaxial(tabs);
  expect_triaxial(in_utf16(tabs));
  expect_triaxial(semicolons, by_name);
  std::string returns = "\xef\xbb\xbf" + tabs;
  std::erase(returns, '\n');
  expect_triaxial(returns);
  CHECK_THAT(refused(std::string("eps_a\0q\n0,0\n", 12)), Contains("is no text"));
}

TEST_CASE("Groups of digits are read where a cell tells them, and refused where it does not") {
  const auto curve = curves_of("eps_a [%];q [kPa]\n0,5;980,0\n1;1.010,5\n2;1.120\n").curves[0];
  CHECK(curve.y == std::vector<double>{980e3, 1010.5e3, 1120e3});
  CHECK_THAT(refused("eps_a [%];q [kPa]\n0,5;980\n1;1,010\n2;1,120\n"),
             Contains("d.csv:3: column q [kPa] = 1,010 may be 1.01, with a decimal mark, or 1010"));
  CHECK_THAT(refused("eps_a [%];q [kPa]\n0,5;980\n1;1.010\n2;1.120\n"), Contains("q [kPa] = 1.010 may be"));
  CHECK(curves_of("eps_a [%];q [kPa]\n0,5;1,250\n1;1,500\n").curves[0].y[1] == 1500);
}

TEST_CASE("Readings within a sensor's step are joined, and their lines are said") {
  const Read noise = expect_triaxial(
      "eps_a [%];q "
      "[kPa]\n0;0\n0.1;40\n0.25;75\n0.5;110\n1.001;139.5\n0.999;140.5\n2;160\n3;165\n3;165\n4.5;162\n6;155\n",
      {}, 1e-9);
  CHECK_THAT(noise.said, Contains("4 rows in which eps_a [%] changes by no more than a sensor's step are joined to 2, "
                                  "lines 6 to 7, 9 to 10"));
  const Read equal = curves_of("eps_a [%];q [kPa]\n0.01;3\n0.01;6\n0.02;9\n0.05;25\n");
  CHECK(equal.curves[0].y == std::vector<double>{4500, 9000, 25000});
  CHECK(curves_of("eps_a [%];q [kPa]\n0;0\n0.1;40\n").said.empty());
  // Readings of a noisy sensor, ten a second: the curve is found to a hundredth.
  std::string text = "eps_a [%],q [kPa]\n";
  for (int k = 0; k < 600; ++k) {
    const double strain = 0.01 * k, noise_of_sensor = 0.013 * std::sin(12.9898 * k) * std::cos(78.233 * k);
    text += std::to_string(strain + noise_of_sensor) + "," + std::to_string(165 * (1 - std::exp(-strain))) + "\n";
  }
  const fit::Curve many = curves_of(text).curves[0];
  REQUIRE(many.x.size() == fit::most_points);
  for (std::size_t k = 0; k < many.x.size(); ++k)
    CHECK(many.y[k] == Approx(165e3 * (1 - std::exp(-100 * many.x[k]))).margin(1.65e3));
  // A load cell that falls by a step as the oedometer goes on, and holds a load with noise: the last strain counts.
  const Read oedometer = curves_of(
      "sigma_v [kPa],eps_a [%]\n0,0\n5,0\n8,0.05\n11,0.08\n10.7,0.11\n20,0.2\n40,0.3\n40.2,0.34\n39.9,0.36\n40.1,0.37\n"
      "80,0.5\n");
  CHECK_THAT(oedometer.said, Contains("d.csv: left out before contact or load, line 2") && Contains("5 to 6, 8 to 11"));
  const fit::Curve& settled = oedometer.curves[0];
  REQUIRE(settled.x.size() == 6);
  CHECK(settled.x[2] == Approx(10.85e3));
  CHECK(settled.x[4] == Approx(40.05e3));
  CHECK(settled.y[4] == Approx(0.0037));
}

TEST_CASE("Seating readings are left out, and strain counts from contact") {
  const Read seated = expect_triaxial(
      "eps_a [%],q "
      "[kPa]\n0.1,-0.4\n0.2,0.3\n0.3,0\n0.4,40\n0.55,75\n0.8,110\n1.3,140\n2.3,160\n3.3,165\n4.8,162\n6.3,155\n");
  CHECK_THAT(seated.said, Contains("left out before contact or load, lines 2 to 3") &&
                              Contains("strain counts from d.csv:4: column eps_a [%] = 0.3"));
  const std::string offset = "eps_a [%],q [kPa],eps_v [%]\n0.3,0,0.02\n0.4,40,0.03\n1.3,140,0.05\n";
  CHECK(curves_of(offset).curves[1].y[2] == Approx(0.0003));
  CHECK(curves_of(offset, {{}, 0.3, {}}).curves[0].x[0] == Approx(0.003));  // who names the begin counts himself
}

TEST_CASE("Stops, unloading in between and the end of the machine are left out, and noise is told from them") {
  const Read stopped = expect_triaxial(
      "eps_a [%],q [kPa]\n0,0\n0.1,40\n0.25,75\n0.5,110\n0.5,104\n0.5,101\n1,140\n2,160\n1.99,80\n1.98,5\n1.985,60\n"
      "1.995,150\n3,165\n4.5,162\n6,155\n6.01,90\n6.02,2\n4,0\n0,0\n");
  CHECK_THAT(stopped.said, Contains("since the machine stood still or unloaded, lines 6 to 7, 10 to 13") &&
                               Contains("as the end of the test, after the largest eps_a [%], lines 17 to 20"));
  // A reversal of two per cent of strain with the deviator going on is a sensor that was set back.
  CHECK_THAT(refused("eps_a [%],q [kPa]\n0,0\n1,50\n2,80\n3,90\n1,95\n2,99\n4,100\n"),
             Contains("d.csv:6: column eps_a [%] = 1 does not rise") && Contains("set back"));
  const fit::Curve loop =
      curves_of("sigma_v [kPa],eps_a [%]\n10,0\n20,0.2\n40,0.4\n20,0.38\n10,0.3\n40,0.42\n80,0.6\n").curves[0];
  CHECK(loop.x == std::vector<double>{10e3, 20e3, 40e3, 80e3});
  CHECK_THAT(refused("eps_a [%],q [kPa]\n0,0\n-1,50\n-2,80\n"), Contains("change the sign"));
}

TEST_CASE("A test beside a longer one ends where its cells end, and a hole in it is told by line and column") {
  const std::string two = "A eps;A q;B eps;B q\n0,02;9;0,03;11\n0,05;25;0,06;27\n0,1;40;0,12;46\n1,0;95;;\n1,5;90;;\n";
  const fit::Selection second{{"axial_strain_percent=B eps", "deviator_kPa=B q"}, {}, {}};
  CHECK(curves_of(two, second).curves[0].x.size() == 3);
  CHECK(curves_of(two, {{"axial_strain_percent=A eps", "deviator_kPa=B q"}, {}, {}}).curves[0].x.size() == 3);
  CHECK(curves_of(two, {{"axial_strain_percent=A eps", "deviator_kPa=A q"}, {}, {}}).curves[0].x.size() == 5);
  CHECK_THAT(refused("A eps;A q;B eps;B q\n1;9;1;11\n2;25;2;\n3;40;3;46\n", second),
             Contains("d.csv:3: column B q = ") && Contains("is empty"));
  CHECK_THAT(refused("A eps;A q;B eps;B q\n1;9;1;11\n2;25;;\n3;40;3;46\n", second), Contains("d.csv:3: column B eps"));
  CHECK_THAT(refused("eps_a,q_kPa,eps_v\n1,9,1\n2,25,2\n3,40,\n"), Contains("d.csv:4: column eps_v"));
}

TEST_CASE("Rows outside the range are not judged") {
  const std::string text =
      "eps_a [%],q "
      "[kPa]\n-5,x\n3,1\nbad,1\n0,0\n0.1,40\n0.25,75\n0.5,110\n1,140\n2,160\n3,165\n4.5,162\n6,155\n7,?\n6.5,1\n"
      "9999,oops\n??,3\n1,2,3,4\n";
  expect_triaxial(
      "eps_a [%],q [kPa]\n-5,x\nbad,1\n0,0\n0.1,40\n0.25,75\n0.5,110\n1,140\n2,160\n3,165\n4.5,162\n6,155\n7,?\n"
      "6.5,1\n9999,oops\n??,3\n1,2,3,4\n",
      {{}, 0.0, 6.0});
  CHECK_THAT(refused(text, {{}, -6.0, 6.0}), Contains("d.csv:4: column eps_a [%] = bad") || Contains("q [kPa] = x"));
  const Read glitch = curves_of("eps_a [%],q [kPa]\n0,0\n1,40\n999,75\n2,75\n3,110\n");
  CHECK(glitch.curves[0].x.size() == 4);
  CHECK_THAT(glitch.said, Contains("stands out for one row, line 4"));
}

TEST_CASE("A table without names is refused with those that are allowed, a workbook with what to do") {
  CHECK_THAT(refused("\xef\xbb\xbf"
                     "0,0\n0.1,20\n0.3,40\n"),
             Contains("d.csv:1: has no header line before its numbers") && Contains("axial_strain_percent") &&
                 Contains("deviator_kPa"));
  const test::Folder folder;
  for (const auto& [bytes, kind] :
       {std::pair<std::string, std::string>{std::string("PK\x03\x04") + std::string(26, '\0') + "[Content_Types].xml",
                                            "(.xlsx)"},
        {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + std::string(8, '\0'), "(.xls)"}}) {
    const std::string path = folder / "book.csv";
    std::ofstream(path, std::ios::binary) << bytes;
    CHECK_THAT(input_error([&] { fit::read_curves(path); }), Contains(kind) && Contains("save the sheet as CSV"));
  }
}
