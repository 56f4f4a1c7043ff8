// Peak and critical friction angle, dilation, and Bolton's relation between them.
//
//   phi_peak = asin((sigma_1 - sigma_3)/(sigma_1 + sigma_3))    at the largest sigma_1 - sigma_3 of a drained test
//   sin psi  = -d eps_v/(2 d eps_1 - d eps_v)                   there, over 1 % of strain (Vermeer and de Borst 1984)
//   phi_cs   = the same angle of the mean stress over the last quarter of the strain, of tests whose void ratio is
//              steady there
//   M_tc     = 6 sin phi_cs/(3 - sin phi_cs)                    q/p of triaxial compression
//   phi_peak - phi_cs = A I_R,  I_R = D (Q - ln p'/1 kPa) - R   (Bolton 1986, Geotechnique 36(1), 65-78), p' at the
//              peak; R = 1, A = 3 degrees of triaxial, 5 of plane strain, Q = 10 of quartz
// Q is fitted with Bolton's A, and A with Bolton's Q: least squares through all densities and pressures.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"
#include "rvelab/sheet/groups.hpp"

namespace rvelab::sheet {
namespace {

constexpr const char* strength_group = "Strength";
constexpr About peak_angle{strength_group,
                           "phi_peak_deg",
                           "peak friction angle \u03c6",
                           "degrees",
                           "asin((\u03c3\u2081 \u2212 \u03c3\u2083)/(\u03c3\u2081 + \u03c3\u2083)) at the largest "
                           "\u03c3\u2081 \u2212 \u03c3\u2083 of drained compression",
                           "Mohr and Coulomb, secant through the origin"};
constexpr About dilation{strength_group,
                         "psi_deg",
                         "dilation angle \u03c8 at the peak",
                         "degrees",
                         "sin \u03c8 = \u2212d\u03b5\u1d65/(2 d\u03b5\u2081 \u2212 d\u03b5\u1d65), over 1 % of strain",
                         "Vermeer and de Borst 1984"};
constexpr About critical_angle{
    strength_group,
    "phi_cs_deg",
    "critical friction angle \u03c6_cs",
    "degrees",
    "of the mean stress over the last quarter of the strain of drained compression, of tests "
    "whose void ratio is steady there",
    "Schofield and Wroth 1968"};
constexpr About critical_ratio{strength_group,
                               "M_tc",
                               "critical stress ratio M",
                               "",
                               "q/p of triaxial compression, 6 sin \u03c6_cs/(3 \u2212 sin \u03c6_cs)",
                               "Schofield and Wroth 1968"};
constexpr About bolton_Q{strength_group,
                         "bolton_Q",
                         "Bolton's Q",
                         "",
                         "\u03c6 \u2212 \u03c6_cs = A [D (Q \u2212 ln p\u2032/kPa) \u2212 1] with A = 3\u00b0 "
                         "(plane 5\u00b0): Q of quartz is 10",
                         "Bolton 1986"};
constexpr About bolton_A{strength_group,
                         "bolton_A_deg",
                         "Bolton's A",
                         "degrees",
                         "the same relation with Q = 10: A is 3\u00b0 of triaxial, 5\u00b0 of plane compression",
                         "Bolton 1986"};
constexpr About bolton_scatter{
    strength_group,
    "bolton_scatter_deg",
    "scatter around Bolton's relation",
    "degrees",
    "root of the mean square of \u03c6 less the relation with the fitted Q, over single tests",
    "Bolton 1986"};

constexpr double bolton_R = 1, quartz_Q = 10;
double bolton_A_of(int dimension) { return dimension == 2 ? 5 : 3; }
/// D (Q - ln p') - R.
double dilatancy_index(double relative_density, double p, double Q) {
  return relative_density * (Q - std::log(p / 1000)) - bolton_R;
}

struct Peaks {
  Readings angles, dilations;  ///< at: p' at the peak
  long rising = 0;             ///< tests without a peak
};

Peaks peaks_of(const std::vector<Test>& tests) {
  Peaks found;
  for (const Test& test : tests) {
    const auto records = last_records(test);
    if (test.purpose != Purpose::drained || records.empty()) continue;
    const calibrate::Peak peak = calibrate::peak(records, test.dimension);
    const records::Record& record = records[peak.record];
    const double p = mean_pressure(record.stress, test.dimension);
    found.angles.push_back({&test, measure_of(test, "friction_angle_deg"), angle_error_deg(test, record), p});
    found.dilations.push_back({&test, measure_of(test, "dilation_angle_deg"), unknown, p});
    found.rising += calibrate::rising_at_end(records, peak) ? 1 : 0;
  }
  return found;
}

void add_critical_angle(const std::vector<Test>& tests, Sheet& sheet) {
  Readings all, steady;
  double doubt = 0;
  for (const EndState& end : end_states(tests)) {
    if (end.test->purpose != Purpose::drained) continue;
    doubt = std::max(doubt, end.doubt);
    all.push_back({end.test, end.friction_angle, end.angle_error});
    if (end.steady) steady.push_back(all.back());
  }
  const Readings& used = steady.empty() ? all : steady;
  if (used.empty()) {
    sheet.remarks.push_back("The critical friction angle is left out: no drained test goes to " +
                            in_words(100 * end_strain) + " % of strain.");
    return;
  }
  add_number(sheet, number_of(critical_angle, used));
  if (used.front().test->dimension == 3)
    add_number(sheet, number_of(critical_ratio, used, [](const Readings& own) {
                 const double sine = std::sin(mean_of(own) * std::numbers::pi / 180);
                 return 6 * sine / (3 - sine);
               }));
  if (steady.empty())
    sheet.remarks.push_back(
        "No drained test has reached a steady void ratio (its means over the last two eighths of the strain differ by "
        "more "
        "than " +
        in_words(steady_void_ratio) + "): the critical friction angle is that of their ends, and may be too large.");
  else if (steady.size() < all.size())
    sheet.remarks.push_back("The critical friction angle is that of " + std::to_string(steady.size()) + " of " +
                            std::to_string(all.size()) + " drained tests: the void ratio of the others still changes.");
  if (doubt > scattering_void_ratio)
    sheet.remarks.push_back("That the void ratio is steady at the ends of drained tests is known to " +
                            in_words(std::round(doubt * 1000) / 1000) +
                            " in e alone: by so much the mean over specimens is off (95 %).");
}

/// The relation as lines over the pressures of the tests, and the measured means.
void add_bolton_figure(const Readings& angles, double critical, double A, double Q, Sheet& sheet) {
  Figure figure{"bolton",
                "Peak friction angle over pressure",
                "mean stress p\u2032 at the peak (kPa)",
                "peak friction angle (\u00b0)",
                std::isfinite(Q)
                    ? "Symbols: means over specimens with 95 % intervals; lines: Bolton's relation with the "
                      "fitted Q."
                    : "Means over specimens with 95 % intervals.",
                true,
                false,
                {},
                strength_group};
  double low = angles.front().at, high = low;
  for (const Reading& each : angles) low = std::min(low, each.at), high = std::max(high, each.at);
  for (const Readings& part : by_density(angles)) {
    const Test& test = *part.front().test;
    figure.series.push_back(mean_series(part, 1e-3, 1, density_label(test)));
    if (!std::isfinite(Q) || !std::isfinite(test.relative_density)) continue;
    Series line{density_label(test), {}, {}, {}, true, false};
    for (int k = 0; k <= 20; ++k) {
      const double p = low / 1.3 * std::pow(1.69 * high / low, k / 20.0);
      line.x.push_back(p / 1000);
      line.y.push_back(critical + A * dilatancy_index(test.relative_density, p, Q));
    }
    figure.series.push_back(std::move(line));
  }
  if (std::isfinite(critical))
    figure.series.push_back({"critical", {low / 1300, 1.3 * high / 1000}, {critical, critical}, {}, true, false});
  sheet.figures.push_back(std::move(figure));
}

/// Adds Q, A and the scatter; the Q that was fitted.
double add_bolton(const Readings& all, double critical, Sheet& sheet) {
  std::set<double> densities;
  Readings angles;
  for (const Reading& each : all) {
    if (!std::isfinite(each.test->relative_density)) continue;
    densities.insert(each.test->relative_density);
    angles.push_back(each);
  }
  if (densities.size() < 2 || !std::isfinite(critical)) {
    sheet.remarks.push_back(
        !std::isfinite(critical) ? "Bolton's relation is left out: it needs the critical friction angle."
        : densities.empty()
            ? "Bolton's relation is left out: the recipe has no e_min and e_max, so no relative density."
            : "Bolton's relation is left out: it needs two densities or more.");
    return unknown;
  }
  const double A = bolton_A_of(angles.front().test->dimension);
  const Number Q = number_of(bolton_Q, angles, [=](const Readings& own) {
    double product = 0, squares = 0;
    for (const Reading& each : own) {
      const double D = each.test->relative_density;
      product += D * ((each.value - critical) / A + bolton_R + D * std::log(each.at / 1000));
      squares += D * D;
    }
    return product / squares;
  });
  add_number(sheet, Q);
  add_number(sheet, number_of(bolton_A, angles, [=](const Readings& own) {
               double product = 0, squares = 0;
               for (const Reading& each : own) {
                 const double index = dilatancy_index(each.test->relative_density, each.at, quartz_Q);
                 product += index * (each.value - critical);
                 squares += index * index;
               }
               return product / squares;
             }));
  Number scatter = number_of(bolton_scatter, angles);
  double squares = 0;
  for (const Reading& each : angles)
    squares += std::pow(each.value - critical - A * dilatancy_index(each.test->relative_density, each.at, Q.mean), 2);
  scatter.mean = std::sqrt(squares / double(angles.size()));
  scatter.standard_error = scatter.low = scatter.high = scatter.calculation_error = unknown;
  add_number(sheet, std::move(scatter));
  return Q.mean;
}

/// An end state without its steadiness, and how e and p change from one half of the window to the other.
struct Window {
  EndState end;
  double e_change, p_change;
};
Window window_of(const Test& test) {
  const auto records = last_records(test);
  const double last = std::abs(records.back().strain), from = 0.75 * last, middle = 0.875 * last;
  Window window{{&test, ensemble::critical_state_of(records, test.dimension, from)}, 0, 0};
  window.end.friction_angle =
      calibrate::friction_angle_deg(calibrate::large_strain_mean(records, test.dimension, from, last));
  double angle = 0, pressure = 0, early = 0, late = 0;
  long count = 0, first = 0;
  for (const records::Record& record : records) {
    if (std::abs(record.strain) < from * (1 - 1e-9)) continue;
    const double p = mean_pressure(record.stress, test.dimension);
    const bool before = std::abs(record.strain) < middle;
    (before ? early : late) += p;
    first += before ? 1 : 0;
    ++count;
    angle += angle_error_deg(test, record);
    pressure += stress_error(test, record);
  }
  window.end.angle_error = angle / double(count);
  window.end.pressure_error = pressure / double(count);
  window.e_change = window.end.state.void_ratio_change;
  window.p_change = first > 0 && first < count
                        ? (late / double(count - first) - early / double(first)) / window.end.state.p
                        : unknown;
  return window;
}

/// Half of the 95 % interval of the mean change of e over `seeds` tests, from their scatter around the means of all
/// groups, all densities and pressures: 0 where each has one specimen. A test of few grains goes up and down at rest by
/// more than it is from it.
double doubt_of_change(const std::vector<std::vector<Window>>& groups, std::size_t seeds) {
  double squares = 0, freedom = 0;
  for (const auto& group : groups) {
    double mean = 0;
    for (const Window& window : group) mean += window.e_change / double(group.size());
    for (const Window& window : group) squares += std::pow(window.e_change - mean, 2);
    freedom += double(group.size()) - 1;
  }
  return freedom > 0 ? ensemble::students_t(freedom) * std::sqrt(squares / freedom / double(seeds)) : 0;
}

}  // namespace

std::vector<EndState> end_states(const std::vector<Test>& tests) {
  std::vector<EndState> ends;
  for (const Purpose purpose : {Purpose::drained, Purpose::undrained}) {
    std::vector<std::vector<Window>> groups;
    for (const TestGroup& own : groups_of(tests, purpose)) {
      groups.emplace_back();
      for (const Test* test : own.tests)
        if (std::abs(last_records(*test).back().strain) >= end_strain * (1 - 1e-6))
          groups.back().push_back(window_of(*test));
      if (groups.back().empty()) groups.pop_back();
    }
    for (auto& group : groups) {
      double e_change = 0, p_change = 0;
      const auto n = double(group.size());
      for (const Window& window : group) e_change += window.e_change / n, p_change += window.p_change / n;
      const double doubt = doubt_of_change(groups, group.size());
      for (Window& window : group) {
        window.end.steady = purpose == Purpose::drained
                                ? std::abs(e_change) <= std::clamp(doubt, steady_void_ratio, scattering_void_ratio)
                                : std::abs(p_change) <= steady_pressure;
        window.end.doubt = doubt;
        ends.push_back(window.end);
      }
    }
  }
  return ends;
}

void add_strength(const std::vector<Test>& tests, Sheet& sheet) {
  const Peaks peaks = peaks_of(tests);
  if (peaks.angles.empty()) {
    sheet.remarks.push_back("Friction and dilation angles are left out: there is no drained test.");
    return;
  }
  add_critical_angle(tests, sheet);
  add_by_pressure(sheet, peak_angle, peaks.angles);
  add_by_pressure(sheet, dilation, peaks.dilations);
  if (peaks.rising > 0)
    sheet.remarks.push_back(std::to_string(peaks.rising) + " of " + std::to_string(peaks.angles.size()) +
                            " drained tests show no peak: their strength is that of their end.");
  const Number* const critical = number_in(sheet, "phi_cs_deg");
  const double angle = critical == nullptr ? unknown : critical->mean;
  const double Q = add_bolton(peaks.angles, angle, sheet);
  add_bolton_figure(peaks.angles, angle, bolton_A_of(peaks.angles.front().test->dimension), Q, sheet);
}

}  // namespace rvelab::sheet
