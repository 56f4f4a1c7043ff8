// The critical state line, the state of each test against it, and phase transformation.
//
//   e_c = e_G - lambda (p/p_a)^xi, xi = 0.7, p_a = 101.325 kPa     Li and Wang 1998; xi is held
//   e_c = Gamma - lambda_ln ln(p/1 kPa)                            Schofield and Wroth 1968, as NorSand takes it
//   psi = e_0 - e_c(p_0)                                           at the start of a test, Been and Jefferies 1985
//   phase transformation: p of an undrained test is least (Ishihara, Tatsuoka and Yasuda 1975); its angle is that of
//   the stresses there
// States are means over the last quarter of the strain of tests whose void ratio and p are steady there (groups.hpp).
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/sheet/groups.hpp"

namespace rvelab::sheet {
namespace {

using ensemble::LineForm;

constexpr const char* critical_group = "Critical state";
constexpr const char* li_and_wang = "Li and Wang 1998";
constexpr About line_void_ratio{critical_group,
                                "critical_line_e_G",
                                "e_G of the critical state line",
                                "",
                                "e = e_G \u2212 \u03bb (p/p_a)^\u03be, p_a = 101.325 kPa",
                                li_and_wang};
constexpr About line_slope{
    critical_group, "critical_line_lambda", "\u03bb of the critical state line", "", "of the same line", li_and_wang};
constexpr About line_exponent{
    critical_group, "critical_line_xi", "\u03be of the critical state line", "", "held at 0.7, not fitted",
    li_and_wang};
constexpr About line_scatter{critical_group,
                             "critical_line_scatter",
                             "scatter of e around the line",
                             "",
                             "root of the mean square of e less the line, over single tests",
                             li_and_wang};
constexpr About log_void_ratio{critical_group,
                               "critical_line_Gamma",
                               "\u0393, e at 1 kPa",
                               "",
                               "e = \u0393 \u2212 \u03bb ln(p/kPa) through the same states",
                               "Schofield and Wroth 1968"};
constexpr About log_slope{critical_group,
                          "critical_line_lambda_ln",
                          "\u03bb of the logarithmic line",
                          "",
                          "of the logarithmic line",
                          "Schofield and Wroth 1968"};
constexpr About state_about{critical_group,
                            "state_parameter",
                            "state parameter at the start",
                            "",
                            "e\u2080 \u2212 e_c(p\u2080) by the line with \u03be: above 0 contractive",
                            "Been and Jefferies 1985"};
constexpr About transformation{critical_group,
                               "phase_transformation_deg",
                               "phase transformation angle",
                               "degrees",
                               "mobilised angle where p of undrained compression is least",
                               "Ishihara, Tatsuoka and Yasuda 1975"};
constexpr About shear_transformation{
    critical_group, "phase_transformation_shear_deg",     "phase transformation angle, simple shear",
    "degrees",      "the same of undrained simple shear", "Ishihara, Tatsuoka and Yasuda 1975"};

/// The line through the readings of void ratios, `at` p; of NaN where p differs by less than a factor of 1.2, which is
/// what one pressure and the strengths of its specimens leave: its slope would be that of the scatter.
ensemble::CriticalLine line_through(const Readings& readings, LineForm form) {
  const auto [least, most] = std::minmax_element(readings.begin(), readings.end(),
                                                 [](const Reading& a, const Reading& b) { return a.at < b.at; });
  if (readings.empty() || most->at < 1.2 * least->at) return {form, unknown, unknown, unknown};
  std::vector<ensemble::CriticalState> states;
  for (const Reading& each : readings) {
    states.emplace_back();
    states.back().p = each.at;
    states.back().void_ratio = each.value;
  }
  return ensemble::fitted_line(states, form);
}

/// An error of p moves a state along the line, which is one of its void ratio.
double void_ratio_error(const EndState& end, const ensemble::CriticalLine& line) {
  const double p = end.state.p, error = end.pressure_error;
  return std::abs(line.void_ratio(std::max(p - error, 0.01 * p)) - line.void_ratio(p));
}

/// A slope that may be none is no measured one; "": it is not 0.
std::string why_unknown(const Number& slope) {
  if (slope.low > 0) return "";
  return std::isnan(slope.low) ? "not known to be above 0 from one specimen, so not for models"
                               : "not known, the interval has 0 in it, so not for models";
}

/// The line of the means, which the figure and the state parameters take; none without enough states.
ensemble::CriticalLine add_line(const std::vector<Test>& tests, Sheet& sheet) {
  Readings states;
  std::vector<const EndState*> used;
  const std::vector<EndState> ends = end_states(tests);
  const bool any_steady = std::any_of(ends.begin(), ends.end(), [](const EndState& end) { return end.steady; });
  for (const EndState& end : ends) {
    // Where none is steady, p of undrained tests still goes far.
    const bool counts = any_steady ? end.steady : end.test->purpose == Purpose::drained;
    if (!counts || !(end.state.p > 0) || !std::isfinite(end.state.void_ratio)) continue;
    states.push_back({end.test, end.state.void_ratio, unknown, end.state.p});
    used.push_back(&end);
  }
  ensemble::CriticalLine line = line_through(states, LineForm::power);
  for (std::size_t k = 0; k < states.size(); ++k) states[k].error = void_ratio_error(*used[k], line);
  const auto number = [&](const About& about, LineForm form, double ensemble::CriticalLine::*part) {
    return number_of(about, states, [form, part](const Readings& own) { return line_through(own, form).*part; });
  };
  Number slope = number(line_slope, LineForm::power, &ensemble::CriticalLine::lambda);
  const bool rises = std::isnan(slope.high) ? !(slope.mean > 0) : slope.high <= 0;
  if (std::isnan(slope.mean) || rises) {
    sheet.remarks.push_back(
        "The critical state line and state parameters are left out: " +
        (slope.mean <= 0
             ? "void ratios at the ends do not fall with the pressure, \u03bb is " + in_words(slope.mean) + "."
             : std::string("no specimen has end states at two pressures, a factor of 1.2 apart (drained at "
                           "several pressures, or undrained, to 12 % of strain).")));
    return {LineForm::power, unknown, unknown, unknown};
  }
  slope.remark = why_unknown(slope);
  line.lambda = slope.mean;
  add_number(sheet, number(line_void_ratio, LineForm::power, &ensemble::CriticalLine::Gamma));
  line.Gamma = sheet.numbers.back().mean;
  add_number(sheet, std::move(slope));
  Number xi = number_of(line_exponent, states);
  xi.mean = 0.7;
  xi.standard_error = xi.low = xi.high = xi.calculation_error = unknown;
  add_number(sheet, std::move(xi));
  Number scatter = number_of(line_scatter, states);
  double squares = 0;
  for (const Reading& each : states) squares += std::pow(each.value - line.void_ratio(each.at), 2);
  scatter.mean = std::sqrt(squares / double(states.size()));
  scatter.standard_error = scatter.low = scatter.high = scatter.calculation_error = unknown;
  add_number(sheet, std::move(scatter));
  Number log_line = number(log_void_ratio, LineForm::logarithmic, &ensemble::CriticalLine::Gamma);
  Number log_fall = number(log_slope, LineForm::logarithmic, &ensemble::CriticalLine::lambda);
  log_fall.remark = why_unknown(log_fall);
  if (!log_fall.remark.empty()) log_line.remark = "goes with a \u03bb that may be 0, so not for models";
  add_number(sheet, std::move(log_line));
  add_number(sheet, std::move(log_fall));
  if (!any_steady)
    sheet.remarks.push_back(
        "No test is steady at its end: the critical state line is that of the ends of the drained ones.");
  return line;
}

void add_line_figure(const std::vector<Test>& tests, const ensemble::CriticalLine& line, Sheet& sheet) {
  const std::vector<EndState> ends = end_states(tests);
  if (ends.empty()) return;
  Figure figure{"critical_state",
                "Void ratio over pressure: starts and ends of tests",
                "p (kPa)",
                "void ratio e",
                "Each test goes from its open end (start) to its symbol (end); line: the critical state line.",
                true,
                false,
                {},
                critical_group};
  Readings all;
  for (const EndState& end : ends) all.push_back({end.test, end.state.void_ratio, unknown, end.state.p});
  double low = all.front().at, high = low;
  for (const Readings& part : by_density(all)) {
    const std::string name = density_label(*part.front().test);
    Series symbols{name, {}, {}, {}, false, false}, paths{name, {}, {}, {}, true, false};
    for (const Reading& each : part) {
      const auto own =
          std::find_if(ends.begin(), ends.end(), [&](const EndState& end) { return end.test == each.test; });
      low = std::min({low, own->state.p, own->state.start_p}),
      high = std::max({high, own->state.p, own->state.start_p});
      symbols.x.push_back(each.at / 1000);
      symbols.y.push_back(each.value);
      for (const double x : {own->state.start_p / 1000, each.at / 1000, unknown}) paths.x.push_back(x);
      for (const double y : {own->state.start_void_ratio, each.value, unknown}) paths.y.push_back(y);
    }
    figure.series.push_back(std::move(symbols));
    figure.series.push_back(std::move(paths));
  }
  if (std::isfinite(line.Gamma)) {
    Series critical{"critical state line", {}, {}, {}, true, false};
    low = std::max(low, 1e-3 * high);
    for (int k = 0; k <= 40; ++k) {
      const double p = low / 1.2 * std::pow(1.44 * high / low, k / 40.0);
      critical.x.push_back(p / 1000);
      critical.y.push_back(line.void_ratio(p));
    }
    figure.series.push_back(std::move(critical));
  }
  sheet.figures.push_back(std::move(figure));
}

void add_states(const std::vector<Test>& tests, const ensemble::CriticalLine& line, Sheet& sheet) {
  if (!std::isfinite(line.Gamma)) return;
  Readings states;
  for (const Test& test : tests) {
    const auto records = last_records(test);
    if ((test.purpose != Purpose::drained && test.purpose != Purpose::undrained) || records.empty()) continue;
    const auto start = ensemble::critical_state_of(records, test.dimension, 0);
    states.push_back({&test, start.start_void_ratio - line.void_ratio(start.start_p)});
  }
  add_by_pressure(sheet, state_about, states);
}

/// NaN: p does not fall and rise again by 2 % of its start, so that there is no transformation.
Reading transformation_of(const Test& test) {
  const auto records = last_records(test);
  std::vector<double> p;
  for (const records::Record& record : records) p.push_back(mean_pressure(record.stress, test.dimension));
  const auto least = std::min_element(p.begin(), p.end());
  const double room = *least + 0.02 * p.front();
  if (p.front() < room || *std::max_element(least, p.end()) < room) return {&test};
  const records::Record& record = records[std::size_t(least - p.begin())];
  return {&test, calibrate::friction_angle_deg(calibrate::principal_stresses(record.stress, test.dimension)),
          angle_error_deg(test, record)};
}

void add_transformation(const std::vector<Test>& tests, Sheet& sheet) {
  for (const auto& [purpose, about] :
       {std::pair(Purpose::undrained, &transformation), std::pair(Purpose::undrained_shear, &shear_transformation)}) {
    Readings found;
    for (const TestGroup& own : groups_of(tests, purpose))
      for (const Test* test : own.tests) found.push_back(transformation_of(*test));
    const auto without =
        std::count_if(found.begin(), found.end(), [](const Reading& each) { return std::isnan(each.value); });
    const std::string what = purpose == Purpose::undrained ? "undrained compression" : "undrained simple shear";
    if (found.empty())
      sheet.remarks.push_back("The phase transformation of " + what + " is left out: there is no such test.");
    else if (without > 0)
      sheet.remarks.push_back(std::to_string(without) + " of " + std::to_string(found.size()) + " tests of " + what +
                              " show no phase transformation: p does not fall and rise again by 2 % of its start.");
    add_by_pressure(sheet, *about, found);
  }
}

}  // namespace

void add_critical_line(const std::vector<Test>& tests, Sheet& sheet) {
  const ensemble::CriticalLine line = add_line(tests, sheet);
  add_line_figure(tests, line, sheet);
  add_states(tests, line, sheet);
  add_transformation(tests, sheet);
}

}  // namespace rvelab::sheet
