// The quantities of curves. Declared in test.hpp.
//
// Errors: the estimate e of a record bounds the error of its stress by e p (rvelab/README.md, Accuracy). To first order
// the bound is e p for stresses, e (1 + q/p) for q/p, and (e p/s)(1 + sin phi)/cos phi for the mobilised angle,
// sin phi = t/s.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "rvelab/ensemble/second_order_work.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/report/test.hpp"

namespace rvelab::report {
namespace {

using ensemble::nan;
using records::Record;
using Value = std::function<double(const Record&)>;

constexpr double percent = 100, kilo = 1e-3, degree = std::numbers::pi / 180;

class Columns {
 public:
  explicit Columns(const Test& test) : test_(test) {}

  void add(const std::string& key, const std::string& label, const std::string& unit, const std::string& meaning,
           const Value& value, const Value& error = {}) {
    Column column{key, label, unit, meaning, {}, {}};
    for (const Record& record : test_.records()) {
      column.values.push_back(value(record));
      if (error) column.errors.push_back(record.error_estimate > 0 ? error(record) : nan);
    }
    all.push_back(std::move(column));
  }

  /// A stress in Pa, compression positive.
  void add_stress(const std::string& key, const std::string& label, const std::string& meaning, const Value& stress) {
    add(
        key, label, "kPa", meaning, [&](const Record& record) { return kilo * stress(record); },
        [&](const Record& record) { return kilo * record.error_estimate * std::abs(pressure(record)); });
  }

  double pressure(const Record& record) const { return mean_pressure(record.stress, test_.dimension); }

  std::vector<Column> all;

 private:
  const Test& test_;
};

const char* const axes = "xyz";
const char* const subscripts[] = {"xx", "yy", "zz", "xy", "xz", "yz"};

void add_tensor(Columns& columns, int dimension, const std::string& key, const std::string& label,
                const std::string& unit, const std::string& meaning, const std::function<Matrix3(const Record&)>& of,
                bool stress) {
  for (const char* at : subscripts) {
    const int a = at[0] - 'x', b = at[1] - 'x';
    if (a >= dimension || b >= dimension) continue;
    const Value value = [&](const Record& record) { return of(record)(a, b); };
    const std::string own = key + "_" + at, name = label + at;
    if (stress)
      columns.add_stress(own, name, meaning, value);
    else
      columns.add(own, name, unit, meaning, value);
  }
}

void add_strains(Columns& columns, const Test& test) {
  columns.add("strain", "driving strain", "%", "of the stage: axial (compression positive), or shear",
              [](const Record& record) { return percent * record.strain; });
  columns.add("volumetric_strain", "volumetric strain", "%", "since the start of the stage, compression positive",
              [](const Record& record) { return percent * (1 - record.deformation_gradient.determinant()); });
  const auto row = [&](const Record& record) { return std::size_t(&record - test.records().data()); };
  for (int k = 0; k < test.dimension; ++k)
    columns.add(std::string("total_") + axes[k], std::string("total axial strain ") + axes[k], "%",
                "since the start of the test, compression positive",
                [&, k](const Record& record) { return percent * (1 - test.deformation[row(record)](k, k)); });
  columns.add("total_volumetric", "total volumetric strain", "%", "since the start of the test, compression positive",
              [&](const Record& record) { return percent * (1 - test.deformation[row(record)].determinant()); });
  columns.add("record", "record", "", "number of the record, from 0",
              [&](const Record& record) { return double(row(record)); });
}

void add_stresses(Columns& columns, const Test& test) {
  const int d = test.dimension;
  const auto p = [d](const Record& record) { return mean_pressure(record.stress, d); };
  const auto q = [d](const Record& record) { return deviatoric_stress(record.stress, d); };
  const auto principal = [d](const Record& record) { return calibrate::principal_stresses(record.stress, d); };
  const double first = std::abs(p(test.records().front()));
  const auto carries = [p, first](const Record& record) { return p(record) > 1e-6 * first; };
  columns.add_stress("q", "deviator q", d == 2 ? "(\u03c3\u2081 \u2212 \u03c3\u2083)/2" : "\u221a(3 s:s/2)", q);
  columns.add_stress("p", "mean stress p", "compression positive", p);
  columns.add(
      "q_over_p", "stress ratio q/p", "", "mobilised",
      [&](const Record& record) { return carries(record) ? q(record) / p(record) : nan; },
      [&](const Record& record) {
        return carries(record) ? record.error_estimate * (1 + q(record) / p(record)) : nan;
      });
  columns.add(
      "friction_angle", "mobilised friction angle", "degrees", "asin(t/s), a secant through the origin",
      [&](const Record& record) { return calibrate::friction_angle_deg(principal(record)); },
      [&](const Record& record) {
        const double s = principal(record).s(), sine = principal(record).t() / s;
        return record.error_estimate * p(record) / s * (1 + sine) / std::sqrt(1 - sine * sine) / degree;
      });
  columns.add_stress("sigma_1", "major stress \u03c3\u2081", "principal, compression positive",
                     [&](const Record& record) { return principal(record).major; });
  columns.add_stress("sigma_3", "minor stress \u03c3\u2083", "principal, compression positive",
                     [&](const Record& record) { return principal(record).minor; });
  add_tensor(
      columns, d, "sigma", "\u03c3 ", "kPa", "compression positive",
      [](const Record& record) { return Matrix3(-0.5 * (record.stress + record.stress.transpose())); }, true);
}

/// The measured quantities of the table.
void add_quantities(Columns& columns, const Test& test) {
  const std::uint64_t measured = test.records().back().quantities;
  records::Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t bit) {
    if ((measured & bit) == 0) return;
    const bool pascal = std::string(Quantity::text.unit) == "Pa";
    const std::string unit = pascal ? "kPa" : std::string(Quantity::text.unit) == "1" ? "" : Quantity::text.unit;
    std::string label = Quantity::text.name;
    for (const char* end : {"_Pa", "_J", "_deg"})
      if (label.ends_with(end)) label.erase(label.size() - std::string(end).size());
    std::replace(label.begin(), label.end(), '_', ' ');
    if constexpr (std::is_same_v<records::ValueOf<Quantity>, Matrix3>) {
      add_tensor(
          columns, test.dimension, Quantity::text.name, label + " ", unit, Quantity::text.meaning,
          [pascal](const Record& record) { return Matrix3((pascal ? -kilo : 1) * (record.*Quantity::member)); }, false);
    } else {
      columns.add(Quantity::text.name, label, unit, Quantity::text.meaning,
                  [](const Record& record) { return record.*Quantity::member; });
    }
  });
}

void add_solver(Columns& columns, const Test& test) {
  const std::vector<double> work = ensemble::normalised_second_order_work(test.records());
  columns.add("second_order_work", "second-order work", "", "d\u03c3:d\u03b5 over its lengths, \u22121 to 1",
              [&](const Record& record) { return work[std::size_t(&record - test.records().data())]; });
  columns.add("error_estimate", "error estimate over p", "%", "of the stress, against infinitely slow loading",
              [](const Record& record) { return record.error_estimate > 0 ? percent * record.error_estimate : nan; });
  columns.add("unbalanced", "unbalanced force ratio", "", "mean resultant over mean contact force",
              [](const Record& record) { return record.unbalanced_force_ratio; });
  columns.add("held_error", "error of the held stress", "%", "over its scale",
              [](const Record& record) { return percent * record.held_error; });
  columns.add("inertial_number", "inertial number", "", "at a rate",
              [](const Record& record) { return record.inertial_number; });
  columns.add("substeps", "sub-steps", "", "since the record before",
              [](const Record& record) { return double(record.substeps); });
}

}  // namespace

std::vector<Column> columns_of(const Test& test) {
  Columns columns(test);
  add_strains(columns, test);
  add_stresses(columns, test);
  add_quantities(columns, test);
  add_solver(columns, test);
  // A column that is zero or undefined in all records is omitted.
  std::erase_if(columns.all, [](const Column& column) {
    return std::all_of(column.values.begin(), column.values.end(),
                       [](double value) { return value == 0 || std::isnan(value); });
  });
  return std::move(columns.all);
}

}  // namespace rvelab::report
