#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>

#include "rvelab/error.hpp"
#include "rvelab/keys/edit_distance.hpp"
#include "tools/models/comparison.hpp"
#include "tools/models/description.hpp"
#include "tools/models/models.hpp"

namespace rvelab::models {
namespace {

const std::vector<const Description*>& all_models() {
  static const std::vector<const Description*> all{&mohr_coulomb(), &hardening_soil_small(), &norsand(),
                                                   &hypoplasticity()};
  return all;
}

const Description& description_of(const std::string& model) {
  const Description* nearest = nullptr;
  for (const Description* one : all_models()) {
    if (one->key == model) return *one;
    if (!nearest || keys::edit_distance(model, one->key) < keys::edit_distance(model, nearest->key)) nearest = one;
  }
  std::string list;
  for (const std::string& name : names()) list += (list.empty() ? "" : ", ") + name;
  throw InputError("model is '" + model + "'; the nearest is " + nearest->key + "; choose one of " + list);
}

/// Search variables z of the fitted parameters: a value runs from `low` to `high` as z runs over all numbers.
class Search {
 public:
  Search(const Description& model, std::vector<Entry> entries) : model(model), entries(std::move(entries)) {
    for (std::size_t k = 0; k < this->entries.size(); ++k)
      if (this->entries[k].fitted()) fitted.push_back(k);
  }

  Eigen::VectorXd start() const {
    Eigen::VectorXd z(size());
    for (Eigen::Index k = 0; k < size(); ++k) {
      const Entry& entry = entry_of(k);
      const double low = scale(entry, entry.low), high = scale(entry, entry.high);
      const double share = std::clamp((scale(entry, entry.value) - low) / (high - low), 0.02, 0.98);
      z[k] = std::log(share / (1 - share));
    }
    return z;
  }
  std::vector<double> values(const Eigen::VectorXd& z) const {
    std::vector<double> values;
    for (const Entry& entry : entries) values.push_back(entry.value);
    for (Eigen::Index k = 0; k < size(); ++k) {
      const Entry& entry = entry_of(k);
      const double low = scale(entry, entry.low), high = scale(entry, entry.high);
      const double at = low + (high - low) / (1 + std::exp(-z[k]));
      values[fitted[std::size_t(k)]] = entry.logarithmic ? std::exp(at) : at;
    }
    if (model.tie) model.tie(values);
    return values;
  }
  /// Of the value, or of its logarithm.
  double per_z(Eigen::Index k, double z) const {
    const Entry& entry = entry_of(k);
    const double share = 1 / (1 + std::exp(-z));
    return (scale(entry, entry.high) - scale(entry, entry.low)) * share * (1 - share);
  }
  const Entry& entry_of(Eigen::Index k) const { return entries[fitted[std::size_t(k)]]; }
  std::size_t parameter(Eigen::Index k) const { return fitted[std::size_t(k)]; }
  Eigen::Index size() const { return Eigen::Index(fitted.size()); }
  const std::vector<Entry>& parameters() const { return entries; }

 private:
  static double scale(const Entry& entry, double value) { return entry.logarithmic ? std::log(value) : value; }

  const Description& model;
  std::vector<Entry> entries;
  std::vector<std::size_t> fitted;
};

/// Residuals and their derivatives, as Eigen's Levenberg-Marquardt wants them.
struct Residuals {
  const Description& model;
  const Search& search;
  Tests tests;
  std::vector<Curve> curves;  ///< of all tests, one after the other
  Eigen::Index rows = 0;

  Residuals(const Description& model, const Search& search, Tests given)
      : model(model), search(search), tests(std::move(given)) {
    for (const ElementTest& test : tests)
      for (Curve& curve : curves_of(test)) {
        rows += Eigen::Index(curve.values.size());
        curves.push_back(std::move(curve));
      }
  }
  int inputs() const { return int(search.size()); }
  int values() const { return int(rows); }

  int operator()(const Eigen::VectorXd& z, Eigen::VectorXd& residuals) const {
    const auto law = model.law(search.values(z));
    std::size_t curve = 0;
    Eigen::Index row = 0;
    for (const ElementTest& test : tests) {
      for (const Curve& calculated : curves_of(calculate(*law, test).test)) {
        const Curve& measured = curves[curve++];
        const double weight = 1 / std::sqrt(double(measured.values.size()));
        for (std::size_t k = 0; k < measured.values.size(); ++k) {
          const double off = (calculated.values[k] - measured.values[k]) / measured.scale[k];
          residuals[row++] = weight * (std::isfinite(off) ? std::clamp(off, -1e3, 1e3) : 1e3);
        }
      }
    }
    return 0;
  }

  int df(const Eigen::VectorXd& z, Eigen::MatrixXd& jacobian) const {
    constexpr double step = 2e-3;
    Eigen::VectorXd here(rows), there(rows), at = z;
    (*this)(z, here);
    for (Eigen::Index k = 0; k < z.size(); ++k) {
      at[k] = z[k] + step, (*this)(at, there);
      at[k] = z[k];
      jacobian.col(k) = (there - here) / step;
    }
    return 0;
  }
};

/// 97.5 % quantile of Student's t (Abramowitz and Stegun 26.7.5; exact for one and two degrees of freedom).
double student(int freedom) {
  if (freedom == 1) return 12.706;
  if (freedom == 2) return 4.303;
  const double z = 1.959964, n = freedom, z3 = z * z * z, z5 = z3 * z * z;
  return z + (z3 + z) / (4 * n) + (5 * z5 + 16 * z3 + 3 * z) / (96 * n * n) +
         (3 * z5 * z * z + 19 * z5 + 17 * z3 - 15 * z) / (384 * n * n * n);
}

/// Deviations along a curve go on from row to row: with a correlation r of neighbours, n rows are worth n (1 - r)/(1 +
/// r) independent ones (Bartlett 1946), at least one.
double independent_rows(const Eigen::Ref<const Eigen::VectorXd>& deviations) {
  const Eigen::Index n = deviations.size();
  const double squares = deviations.squaredNorm();
  if (n < 2 || !(squares > 0)) return 1;
  const double r = std::max(0.0, deviations.head(n - 1).dot(deviations.tail(n - 1)) / squares);
  return std::max(1.0, double(n) * (1 - r) / (1 + r));
}

void set_intervals(const Residuals& residuals, const Eigen::VectorXd& z, Fit& fit) {
  const Search& search = residuals.search;
  Eigen::VectorXd at(residuals.rows);
  Eigen::MatrixXd jacobian(residuals.rows, z.size());
  residuals(z, at);
  residuals.df(z, jacobian);
  double observations = 0;
  Eigen::Index row = 0;
  for (const Curve& curve : residuals.curves) {
    const Eigen::Index rows = Eigen::Index(curve.values.size());
    const double independent = independent_rows(at.segment(row, rows));
    at.segment(row, rows) *= std::sqrt(independent);
    jacobian.middleRows(row, rows) *= std::sqrt(independent);
    observations += independent;
    row += rows;
  }
  for (Eigen::Index k = 0; k < z.size(); ++k) jacobian.col(k) /= std::max(search.per_z(k, z[k]), 1e-300);
  const Eigen::VectorXd size = jacobian.colwise().norm().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = jacobian * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd normal = scaled.transpose() * scaled;
  const Eigen::MatrixXd inverse = (normal + 1e-12 * Eigen::MatrixXd::Identity(z.size(), z.size()))
                                      .ldlt()
                                      .solve(Eigen::MatrixXd::Identity(z.size(), z.size()));
  const int freedom = std::max(1, int(observations) - int(z.size()));
  const double deviation = std::sqrt(at.squaredNorm() / freedom);
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    const Entry& entry = search.entry_of(k);
    Parameter& parameter = fit.parameters[search.parameter(k)];
    const double half = student(freedom) * deviation * std::sqrt(std::max(inverse(k, k), 0.0)) / size[k];
    const double low = entry.logarithmic ? parameter.value * std::exp(-half) : parameter.value - half;
    const double high = entry.logarithmic ? parameter.value * std::exp(half) : parameter.value + half;
    parameter.low = std::max(low, entry.low);
    parameter.high = std::min(high, entry.high);
    const double ends = entry.logarithmic ? 0.02 * parameter.value : 1e-3 * (entry.high - entry.low);
    if (parameter.value < entry.low + ends || parameter.value > entry.high - ends)
      fit.remarks.push_back(parameter.name + " ends at the limit of what is tried, " + in_words(parameter.value) +
                            ": the tests do not determine it, or the model does not describe them");
    else if (low < entry.low && high > entry.high)
      fit.remarks.push_back("the tests do not determine " + parameter.name);
  }
}

std::string with_unit(const Entry& entry, double value) {
  return in_words(value) + (entry.unit.empty() ? "" : " " + entry.unit);
}

/// A number of the sheet that the model cannot take is fitted, from the middle of what it takes: the search does not
/// come away from an end.
std::vector<Entry> within_limits(std::vector<Entry> entries, Fit& fit) {
  for (Entry& entry : entries) {
    if (std::isnan(entry.value)) continue;  // it follows from others
    if (!entry.fitted() && (entry.value < entry.low || entry.value > entry.high)) {
      fit.remarks.push_back(entry.name + " of the sheet, " + with_unit(entry, entry.value) +
                            ", is not among what the model takes, " + in_words(entry.low) + " to " +
                            in_words(entry.high) + ": it is fitted");
      entry.origin = Origin::fitted;
      entry.value = entry.logarithmic ? std::sqrt(entry.low * entry.high) : 0.5 * (entry.low + entry.high);
    }
    entry.value = std::clamp(entry.value, entry.low, entry.high);
  }
  return entries;
}

/// Where other parameters did not leave a number of the sheet as it was.
void remark_changes(const std::vector<Entry>& entries, const std::vector<double>& values, Fit& fit) {
  for (std::size_t k = 0; k < entries.size(); ++k)
    if (entries[k].origin == Origin::sheet &&
        std::abs(values[k] - entries[k].value) > 1e-9 * std::abs(entries[k].value)) {
      fit.parameters[k].origin = Origin::changed;
      fit.remarks.push_back(entries[k].name + " of the sheet, " + with_unit(entries[k], entries[k].value) +
                            ", does not go with the other parameters: " + with_unit(entries[k], values[k]) +
                            " is used");
    }
}

void remark_assumed(Fit& fit) {
  std::string names;
  for (const Parameter& each : fit.parameters)
    if (each.origin == Origin::assumed) names += (names.empty() ? "" : ", ") + each.name;
  if (!names.empty()) fit.remarks.push_back("assumed, since neither tests nor sheet tell: " + names);
}

std::string counted(const Tests& tests) {
  const auto number = [&](Loading loading) { return std::to_string(of_loading(tests, loading).size()); };
  return number(Loading::drained) + " drained, " + number(Loading::undrained) + " undrained, " +
         number(Loading::oedometer) + " oedometer, " + number(Loading::isotropic) + " isotropic and " +
         number(Loading::cyclic_shear) + " cyclic shear tests";
}

/// Of models without void ratio and softening.
void remark_density_and_rise(const Tests& tests, Fit& fit) {
  double low = 1e9, high = 0;
  for (const ElementTest& test : tests) {
    if (!test.fitted || test.strain.empty()) continue;
    low = std::min(low, test.e0), high = std::max(high, test.e0);
    if (test.loading != Loading::drained) continue;
    const double largest = *std::max_element(test.q.begin(), test.q.end());
    if (test.q.back() >= 0.999 * largest)
      fit.remarks.push_back("q of " + test.name + " still rises at its end: the friction angle is a lower bound");
  }
  if (high - low > 0.05)
    fit.remarks.push_back("void ratios of the tests run from " + in_words(low) + " to " + in_words(high) +
                          ", of which this model knows nothing: fit one density at a time");
}

}  // namespace

const char* name_of(Origin origin) {
  static const char* const names[] = {"fitted", "sheet", "sheet (changed)", "assumed"};
  return names[int(origin)];
}

const std::vector<std::string>& names() {
  static const std::vector<std::string> list = [] {
    std::vector<std::string> keys;
    for (const Description* one : all_models()) keys.push_back(one->key);
    return keys;
  }();
  return list;
}

bool of_one_density(std::string_view model) { return !description_of(std::string(model)).softens; }

Fit fit(std::string_view model, const std::vector<ElementTest>& tests, const std::map<std::string, double>& numbers) {
  const Description& description = description_of(std::string(model));
  Fit result;
  result.model = description.title;
  Tests clean, fitted;
  for (const ElementTest& test : tests) {
    clean.push_back(without_gaps(test, result.remarks));
    if (!test.fitted || clean.back().strain.empty()) continue;
    if (test.loading == Loading::cyclic_shear && !description.cyclic_shear) continue;
    fitted.push_back(thinned(description.softens ? clean.back() : around_the_peak(clean.back())));
  }
  if (const std::string missing = description.missing(fitted); !missing.empty())
    throw InputError(description.title + " needs " + missing + "; to be fitted are " + counted(fitted));

  const Search search(description, within_limits(description.parameters(fitted, numbers), result));
  Residuals residuals(description, search, fitted);
  Eigen::VectorXd z = search.start();
  Eigen::LevenbergMarquardt<Residuals> minimiser(residuals);
  minimiser.parameters.ftol = 1e-9;
  minimiser.parameters.xtol = 1e-7;
  minimiser.parameters.maxfev = 100;
  minimiser.parameters.factor = 1;  // of the first step: z of all parameters is of the order of one
  minimiser.minimize(z);

  const std::vector<double> values = search.values(z);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Entry& entry = search.parameters()[k];
    result.parameters.push_back({entry.name, entry.unit, entry.meaning, values[k], unknown, unknown, entry.origin});
  }
  set_intervals(residuals, z, result);
  remark_changes(search.parameters(), values, result);
  remark_assumed(result);
  if (description.warning)
    if (const std::string warning = description.warning(values); !warning.empty()) result.remarks.push_back(warning);
  if (!description.softens) remark_density_and_rise(clean, result);

  const auto law = description.law(values);
  for (const ElementTest& test : clean) {
    const Calculation calculation =
        test.strain.empty() ? Calculation{test, "fewer than 5 rows are finite"} : calculate(*law, test);
    result.misfits.push_back(misfit(test, calculation));
    result.calculated.push_back(calculation.test);
  }
  return result;
}

}  // namespace rvelab::models
