#include "rvelab/sheet/curves.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"
#include "rvelab/sheet/element_tests.hpp"
#include "rvelab/sheet/groups.hpp"

namespace rvelab::sheet {
namespace {

using models::ElementTest;
using models::Loading;

constexpr const char* curves_group = "Curves";

/// Rows of one test.
struct Rows {
  std::vector<double> strain, q, p, eps_v;
  double void_ratio = unknown;
};

bool is_shear(const Test& test) { return test.result.axis.size() == 2; }

Rows rows_of(const Test& test, std::span<const records::Record> records) {
  Rows rows;
  rows.void_ratio = test.void_ratio;
  if (!records.empty() && (records.front().quantities & records::asked<records::VoidRatio>) != 0)
    rows.void_ratio = records.front().void_ratio;
  // A stage begins at the end of the one before; strains count from the first record.
  Matrix3 before = Matrix3::Identity();
  if (!records.empty()) before = records.front().deformation_gradient.inverse();
  for (std::size_t k = 0; k < records.size(); ++k) {
    const records::Record& record = records[k];
    if (k > 0 && record.stage != records[k - 1].stage) before = records[k - 1].deformation_gradient * before;
    const Matrix3 deformation = record.deformation_gradient * before;
    const int a = axis_of(test);
    rows.eps_v.push_back(1 - deformation.determinant());
    if (is_shear(test)) {
      const int from = test.result.axis[0] - 'x', to = test.result.axis[1] - 'x';
      rows.strain.push_back(deformation(from, to));
      rows.q.push_back(0.5 * (record.stress(from, to) + record.stress(to, from)));
      rows.p.push_back(test.purpose == Purpose::undrained_shear ? -record.stress(to, to)
                                                                : mean_pressure(record.stress, test.dimension));
    } else {
      rows.strain.push_back(1 - deformation(a, a));
      rows.q.push_back(axial_stress(test, record) - lateral_stress(test, record));
      rows.p.push_back(mean_pressure(record.stress, test.dimension));
    }
  }
  return rows;
}

/// Those of the path: of isotropic and oedometer tests all stages from the end of those that bring the specimen to its
/// pressure.
std::span<const records::Record> path_records(const Test& test) {
  if (test.purpose != Purpose::isotropic && test.purpose != Purpose::oedometer) return last_records(test);
  const auto& all = test.result.records;
  std::size_t begin = 0;
  const auto brings_there = [&](const records::Record& record) {
    const std::string& kind = test.protocol.stages.at(std::size_t(record.stage)).kind;
    return kind == "isotropic" || kind == "relax";
  };
  while (begin + 1 < all.size() && brings_there(all[begin]) && brings_there(all[begin + 1])) ++begin;
  return std::span(all).subspan(begin);
}

double interpolated_at(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto above = std::lower_bound(x.begin() + 1, x.end() - 1, at);
  const auto k = std::size_t(above - x.begin());
  return std::lerp(y[k - 1], y[k], (at - x[k - 1]) / (x[k] - x[k - 1]));
}

/// At strains end (k/n)^2, up to the shortest of the tests.
void bring_to_common_strains(std::vector<Rows>& all) {
  constexpr int points = 60;
  double end = 1e300;
  for (const Rows& rows : all) end = std::min(end, rows.strain.back());
  std::vector<double> strains;
  for (int k = 0; k <= points; ++k) strains.push_back(end * std::pow(double(k) / points, 2));
  for (Rows& rows : all) {
    for (auto* column : {&rows.q, &rows.p, &rows.eps_v}) {
      std::vector<double> there;
      for (const double strain : strains) there.push_back(interpolated_at(rows.strain, *column, strain));
      *column = std::move(there);
    }
    rows.strain = strains;
  }
}

bool rises(const Rows& rows) {
  const auto& strain = rows.strain;
  return strain.size() > 2 && std::adjacent_find(strain.begin(), strain.end(), std::greater_equal<>()) == strain.end();
}

Loading loading_of_purpose(Purpose purpose) {
  switch (purpose) {
    case Purpose::isotropic:
      return Loading::isotropic;
    case Purpose::oedometer:
      return Loading::oedometer;
    case Purpose::drained:
      return Loading::drained;
    case Purpose::cyclic_strain:
      return Loading::cyclic_shear;
    default:
      return Loading::undrained;
  }
}

const char* word_of(Purpose purpose) {
  switch (purpose) {
    case Purpose::isotropic:
      return "isotropic";
    case Purpose::oedometer:
      return "oedometer";
    case Purpose::drained:
      return "drained";
    case Purpose::undrained:
      return "undrained";
    case Purpose::undrained_shear:
      return "undrained shear";
    default:
      return "cyclic shear";
  }
}

MeanTest mean_of_tests(const std::vector<const Test*>& tests, double amplitude) {
  const Test& first = *tests.front();
  MeanTest mean{first.purpose, first.density, first.pressure, {}, {}};
  std::vector<Rows> all;
  for (const Test* test : tests) all.push_back(rows_of(*test, path_records(*test)));
  const bool monotonic = first.purpose == Purpose::drained || first.purpose == Purpose::undrained ||
                         first.purpose == Purpose::undrained_shear;
  if (monotonic && std::all_of(all.begin(), all.end(), rises)) bring_to_common_strains(all);
  std::size_t rows = all.front().strain.size();
  for (const Rows& own : all) rows = std::min(rows, own.strain.size());
  ElementTest& curve = mean.curve;
  curve.name = word_of(first.purpose) + (", " + density_label(first));
  if (first.purpose != Purpose::isotropic && first.purpose != Purpose::oedometer)
    curve.name += ", " + pressure_label(first.pressure);
  if (std::isfinite(amplitude)) curve.name += ", " + in_words(amplitude);
  curve.loading = loading_of_purpose(first.purpose);
  const auto n = double(all.size());
  for (std::size_t k = 0; k < rows; ++k) {
    double strain = 0, p = 0, eps_v = 0;
    std::vector<double> q;
    for (const Rows& own : all) strain += own.strain[k] / n, p += own.p[k] / n, eps_v += own.eps_v[k] / n;
    for (const Rows& own : all) q.push_back(own.q[k]);
    const ensemble::Spread spread = ensemble::spread_of(q);
    curve.strain.push_back(strain);
    curve.q.push_back(spread.mean);
    curve.p.push_back(p);
    curve.eps_v.push_back(eps_v);
    if (all.size() > 1) mean.deviation.push_back(0.5 * (spread.high - spread.low));
  }
  curve.p0 = curve.p.empty() ? first.pressure : curve.p.front();
  curve.e0 = 0;
  for (const Rows& own : all) curve.e0 += own.void_ratio / n;
  return mean;
}

void add_curve(Figure& figure, const MeanTest& test, const std::vector<double>& x, double x_factor,
               const std::vector<double>& y, double y_factor) {
  Series series{test.curve.name, {}, {}, {}, true, false};
  for (const double value : x) series.x.push_back(x_factor * value);
  for (const double value : y) series.y.push_back(y_factor * value);
  figure.series.push_back(std::move(series));
}

void add_figure(Sheet& sheet, Figure figure) {
  if (figure.series.empty()) return;
  figure.group = curves_group;
  figure.caption = "Means over specimens.";
  sheet.figures.push_back(std::move(figure));
}

/// The middle of the sorted distinct values from three on; NaN of fewer.
double middle_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(),
                           [](double one, double other) { return std::abs(other - one) <= 0.02 * std::abs(one); }),
               values.end());
  return values.size() < 3 ? unknown : values[values.size() / 2];
}

}  // namespace

std::vector<MeanTest> mean_tests(const std::vector<Test>& tests) {
  std::vector<MeanTest> means;
  for (const Purpose purpose : {Purpose::isotropic, Purpose::oedometer, Purpose::drained, Purpose::undrained,
                                Purpose::undrained_shear, Purpose::cyclic_strain}) {
    for (const TestGroup& own : groups_of(tests, purpose)) {
      std::vector<double> amplitudes;
      for (const Test* test : own.tests) {
        const double amplitude = purpose == Purpose::cyclic_strain ? test->amplitude : unknown;
        if (amplitudes.empty() || (std::isfinite(amplitude) &&
                                   std::find(amplitudes.begin(), amplitudes.end(), amplitude) == amplitudes.end()))
          amplitudes.push_back(amplitude);
      }
      std::sort(amplitudes.begin(), amplitudes.end());
      for (const double amplitude : amplitudes) {
        std::vector<const Test*> same;
        for (const Test* test : own.tests)
          if (!std::isfinite(amplitude) || test->amplitude == amplitude) same.push_back(test);
        means.push_back(mean_of_tests(same, amplitude));
      }
    }
  }
  return means;
}

void add_curves(const std::vector<Test>& tests, Sheet& sheet) {
  const char* const axial = "axial strain (%)";
  Figure drained{"drained_q", "Drained compression", axial, "q (kPa)", {}, false, false, {}, {}};
  Figure volume{"drained_volume",
                "Volume in drained compression",
                axial,
                "volumetric strain (%), compression positive",
                {},
                false,
                false,
                {},
                {}};
  Figure undrained{"undrained_q", "Undrained compression", axial, "q (kPa)", {}, false, false, {}, {}};
  Figure path{
      "undrained_path", "Stress paths of undrained compression", "p\u2032 (kPa)", "q (kPa)", {}, false, false, {}, {}};
  Figure shear{"undrained_shear",
               "Undrained simple shear",
               "normal stress (kPa)",
               "shear stress (kPa)",
               {},
               false,
               false,
               {},
               {}};
  Figure oedometer{"oedometer", "Oedometer", "axial stress (kPa)", axial, {}, true, false, {}, {}};
  Figure isotropic{"isotropic", "Isotropic compression", "p\u2032 (kPa)", "void ratio e", {}, true, false, {}, {}};
  for (const MeanTest& test : mean_tests(tests)) {
    const ElementTest& curve = test.curve;
    std::vector<double> stress, void_ratio;
    const int lateral = tests.front().dimension - 1;
    for (std::size_t k = 0; k < curve.q.size(); ++k) {
      stress.push_back(curve.p[k] + curve.q[k] * lateral / (lateral + 1));
      void_ratio.push_back(curve.e0 - (1 + curve.e0) * curve.eps_v[k]);
    }
    switch (test.purpose) {
      case Purpose::drained:
        add_curve(drained, test, curve.strain, 100, curve.q, 1e-3);
        add_curve(volume, test, curve.strain, 100, curve.eps_v, 100);
        break;
      case Purpose::undrained:
        add_curve(undrained, test, curve.strain, 100, curve.q, 1e-3);
        add_curve(path, test, curve.p, 1e-3, curve.q, 1e-3);
        break;
      case Purpose::undrained_shear:
        add_curve(shear, test, curve.p, 1e-3, curve.q, 1e-3);
        break;
      case Purpose::oedometer:
        add_curve(oedometer, test, stress, 1e-3, curve.strain, 100);
        break;
      case Purpose::isotropic:
        add_curve(isotropic, test, curve.p, 1e-3, void_ratio, 1);
        break;
      default:
        break;
    }
  }
  for (Figure* figure : {&drained, &volume, &undrained, &path, &shear, &oedometer, &isotropic})
    add_figure(sheet, std::move(*figure));
}

std::vector<ElementTest> element_tests(const std::vector<Test>& tests, std::optional<std::size_t> only) {
  if (tests.empty() || tests.front().dimension != 3) return {};
  std::vector<MeanTest> means = mean_tests(tests);
  std::erase_if(means, [&](const MeanTest& test) {
    return test.purpose == Purpose::undrained_shear || (only && test.density != *only);
  });
  std::vector<double> densities, pressures;
  for (const MeanTest& test : means) {
    if (test.purpose != Purpose::drained) continue;
    densities.push_back(double(test.density + 1));
    pressures.push_back(test.pressure);
  }
  const double density = middle_of(densities), pressure = middle_of(pressures);
  std::vector<ElementTest> elements;
  for (MeanTest& test : means) {
    const bool middle = double(test.density + 1) == density ||
                        (test.purpose == Purpose::drained && std::abs(test.pressure - pressure) <= 0.02 * pressure);
    test.curve.fitted = test.purpose != Purpose::undrained && !middle;
    elements.push_back(std::move(test.curve));
  }
  return elements;
}

}  // namespace rvelab::sheet
