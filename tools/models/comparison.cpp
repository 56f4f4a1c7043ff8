#include "tools/models/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"

namespace rvelab::models {
namespace {

constexpr std::size_t fewest_rows = 5, rows_of_a_fit = 40;

/// What drives the test, row by row.
std::vector<double> driven(const ElementTest& test) {
  if (test.loading == Loading::isotropic) return test.p;
  if (test.loading != Loading::oedometer) return test.strain;
  std::vector<double> stress;
  for (std::size_t k = 0; k < test.q.size(); ++k) stress.push_back(axial_stress(test, k));
  return stress;
}

bool turns_at(const std::vector<double>& path, std::size_t k) {
  return k > 0 && k + 1 < path.size() && (path[k] - path[k - 1]) * (path[k + 1] - path[k]) < 0;
}

double largest(const std::vector<double>& values) {
  double found = 0;
  for (const double value : values) found = std::max(found, std::abs(value));
  return found;
}

Curve curve(const std::vector<double>& values, double least) {
  return {values, std::vector<double>(values.size(), std::max(largest(values), least))};
}

double root_mean_square(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / double(a.size()));
}

}  // namespace

std::vector<Curve> curves_of(const ElementTest& test) {
  constexpr double strain = 1e-3;  // the least that a deviation is divided by
  switch (test.loading) {
    case Loading::drained:
      return {curve(test.q, 0.1 * test.p0), curve(test.eps_v, strain)};
    case Loading::undrained: {
      const double size = std::max(largest(test.q), test.p0);
      return {curve(test.q, size), curve(test.p, size)};
    }
    case Loading::oedometer:
      return {curve(test.strain, strain), curve(test.q, 0.1 * test.p0)};
    case Loading::isotropic:
      return {curve(test.eps_v, strain)};
    case Loading::cyclic_shear:
      break;
  }
  Curve shear = curve(test.q, 1);
  bool turns = false;
  for (std::size_t k = 0; k < test.strain.size(); ++k) turns = turns || turns_at(test.strain, k);
  if (!turns)
    for (std::size_t k = 0; k < test.q.size(); ++k)
      shear.scale[k] = std::max(std::abs(test.q[k]), 1e-6 * shear.scale[k]);
  return {shear};
}

ElementTest without_gaps(const ElementTest& test, std::vector<std::string>& remarks) {
  const std::size_t rows = test.strain.size();
  if (test.q.size() != rows || test.p.size() != rows || test.eps_v.size() != rows)
    throw InputError("columns of the test " + test.name + " have " + std::to_string(rows) + ", " +
                     std::to_string(test.q.size()) + ", " + std::to_string(test.p.size()) + " and " +
                     std::to_string(test.eps_v.size()) + " rows; they must have the same number");
  ElementTest clean = test;
  for (std::vector<double>* column : {&clean.strain, &clean.q, &clean.p, &clean.eps_v}) column->clear();
  for (std::size_t k = 0; k < rows; ++k) {
    if (!std::isfinite(test.strain[k] + test.q[k] + test.p[k] + test.eps_v[k])) continue;
    clean.strain.push_back(test.strain[k]);
    clean.q.push_back(test.q[k]);
    clean.p.push_back(test.p[k]);
    clean.eps_v.push_back(test.eps_v[k]);
  }
  const std::size_t left_out = rows - clean.strain.size();
  const bool too_few = clean.strain.size() < fewest_rows;
  if (left_out > 0 || too_few)
    remarks.push_back(
        (too_few ? "the test is left out: " + std::to_string(clean.strain.size()) + " finite rows, 5 are needed"
                 : std::to_string(left_out) + " rows that are not finite are left out") +
        " (" + test.name + ")");
  if (too_few) {
    for (std::vector<double>* column : {&clean.strain, &clean.q, &clean.p, &clean.eps_v}) column->clear();
    return clean;
  }
  if (!std::isfinite(clean.p0)) clean.p0 = clean.p.front();
  if (!(clean.p0 > 0))
    throw InputError("p0 of the test " + test.name + " is " + in_words(clean.p0) + "; it must be > 0");
  if (!(clean.e0 > 0))
    throw InputError("e0 of the test " + test.name + " is " + in_words(clean.e0) + "; it must be > 0");
  return clean;
}

ElementTest thinned(const ElementTest& test) {
  const std::vector<double> path = driven(test);
  const std::size_t rows = path.size(), every = (rows + rows_of_a_fit - 1) / rows_of_a_fit;
  ElementTest thin = test;
  for (std::vector<double>* column : {&thin.strain, &thin.q, &thin.p, &thin.eps_v}) column->clear();
  for (std::size_t k = 0; k < rows; ++k) {
    if (k % every != 0 && k + 1 != rows && !turns_at(path, k)) continue;
    thin.strain.push_back(test.strain[k]);
    thin.q.push_back(test.q[k]);
    thin.p.push_back(test.p[k]);
    thin.eps_v.push_back(test.eps_v[k]);
  }
  return thin;
}

ElementTest around_the_peak(const ElementTest& test) {
  if (test.loading != Loading::drained) return test;
  const std::size_t peak = std::size_t(std::max_element(test.q.begin(), test.q.end()) - test.q.begin());
  std::size_t rows = peak + 1;
  while (rows < test.strain.size() && std::abs(test.strain[rows]) <= 2 * std::abs(test.strain[peak])) ++rows;
  rows = std::min(std::max(rows, fewest_rows), test.strain.size());
  ElementTest beginning = test;
  for (std::vector<double>* column : {&beginning.strain, &beginning.q, &beginning.p, &beginning.eps_v})
    column->resize(rows);
  return beginning;
}

Misfit misfit(const ElementTest& measured, const Calculation& calculated) {
  Misfit result{measured.name, measured.fitted, unknown, unknown, calculated.remark};
  const ElementTest& by_model = calculated.test;
  const double q = largest(measured.q);
  if (measured.strain.empty() || !std::isfinite(largest(by_model.q))) return result;
  if (measured.loading != Loading::isotropic && !(q > 0)) {
    result.remark = "q is zero throughout";
    return result;
  }
  if (measured.loading == Loading::cyclic_shear && !calculated.remark.empty()) return result;
  if (measured.loading != Loading::isotropic) result.stress = root_mean_square(by_model.q, measured.q) / q;
  if (measured.loading == Loading::undrained)
    result.stress = std::hypot(result.stress, root_mean_square(by_model.p, measured.p) / q) / std::sqrt(2.0);
  if (measured.loading == Loading::drained || measured.loading == Loading::isotropic)
    result.strain = root_mean_square(by_model.eps_v, measured.eps_v);
  if (measured.loading == Loading::oedometer) result.strain = root_mean_square(by_model.strain, measured.strain);
  return result;
}

}  // namespace rvelab::models
