// The page of a data sheet: what tools/report/src/sheet.ts shows, in words and digits. Declared in write_sheet.hpp.
#include <algorithm>
#include <cmath>
#include <map>

#include "rvelab/error.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/report/json.hpp"
#include "rvelab/report/template.hpp"
#include "rvelab/report/words.hpp"
#include "rvelab/sheet/readings.hpp"
#include "rvelab/sheet/write_sheet.hpp"

namespace rvelab::sheet {
namespace {

using report::Json;
using report::Table;

/// Keys of the numbers that stand first, most wanted first.
constexpr const char* headline_keys[] = {
    "phi_cs_deg", "phi_peak_deg", "psi_deg",           "bearing_capacity_Nq",  "E50_ref_Pa", "Eoed_ref_Pa",  "K0nc",
    "G0_ref_Pa",  "gamma_07",     "critical_line_e_G", "critical_line_lambda", "CSR_15_ru",  "CSR_15_strain"};

std::string with_unit(const std::string& text, const std::string& unit) {
  if (unit.empty() || text == "-") return text;
  return unit == "degrees" ? text + "\u00b0" : text + " " + unit;
}

/// "31.1 \u00b1 0.4\u00b0"
std::string value_in_words(const Number& number) {
  const report::InUnit unit = report::fitting_unit(number.mean, number.unit);
  // An error of round-off would ask for all digits.
  const bool scatters = number.standard_error > 1e-6 * std::abs(number.mean);
  const double error = scatters ? unit.factor * number.standard_error : unknown;
  return with_unit(report::with_its_error(unit.factor * number.mean, error), unit.unit);
}
std::string in_its_unit(const Number& number, double value) {
  const report::InUnit unit = report::fitting_unit(number.mean, number.unit);
  return std::isfinite(value) ? with_unit(report::in_three_digits(unit.factor * value), unit.unit) : "";
}
/// "30.2 to 31.9"; both ends with three digits where they are of different sizes, or the same but for round-off.
std::string interval_of(const Number& number) {
  if (!std::isfinite(number.low) || !std::isfinite(number.high)) return "";
  const report::InUnit unit = report::fitting_unit(number.mean, number.unit);
  const double low = unit.factor * number.low, high = unit.factor * number.high;
  const double size = std::abs(unit.factor * number.mean);
  const bool wide = high - low > size || high - low < 1e-6 * size;
  return with_unit(wide ? report::in_three_digits(low) + " to " + report::in_three_digits(high)
                        : report::interval_in_words(low, high),
                   unit.unit);
}
std::string interval_with_remark(const Number& number) {
  return interval_of(number) + (number.remark.empty() ? "" : ": " + number.remark);
}
std::string published_of(const Number& number) {
  if (!std::isfinite(number.published)) return "";
  const std::string by = number.published_by.empty() ? "" : " (" + number.published_by + ")";
  const double off = std::abs(number.mean - number.published);
  std::string where = in_its_unit(number, off) + (number.mean < number.published ? " below it" : " above it");
  if (off <= number.calculation_error) where = "within the error of calculation";
  if (number.low <= number.published && number.published <= number.high) where = "within the interval";
  return in_its_unit(number, number.published) + by + ": " + where;
}

std::string density_in_words(const Number& number) {
  if (number.density_name.empty()) return std::isfinite(number.pressure) ? "" : "all";
  return number.density_name +
         (std::isfinite(number.relative_density) ? ", D " + in_words(number.relative_density) : "");
}

/// The number of a key that stands first: of the densest specimens, at the pressure that is nearest to 100 kPa.
const Number* headline_number(const Sheet& sheet, const std::string& key) {
  const Number* best = nullptr;
  const auto place = [](const Number& number) {
    const double density = std::isfinite(number.relative_density) ? number.relative_density : -1;
    const double off = std::isfinite(number.pressure) ? std::abs(std::log(number.pressure / reference_pressure)) : 0;
    return std::pair(-density, off);
  };
  for (const Number& number : sheet.numbers)
    if (number.key == key && (best == nullptr || place(number) < place(*best))) best = &number;
  return best;
}

Json headline_of(const Sheet& sheet) {
  Json list = Json::array();
  for (const char* key : headline_keys) {
    const Number* const number = headline_number(sheet, key);
    if (number == nullptr) continue;
    std::string where = number->density_name;
    if (std::isfinite(number->pressure)) where += (where.empty() ? "" : ", ") + pressure_label(number->pressure);
    list.push_back({{"label", number->label},
                    {"where", where},
                    {"value", value_in_words(*number)},
                    {"interval", interval_with_remark(*number)},
                    {"published", published_of(*number)},
                    {"definition", number->definition}});
  }
  return list;
}

bool by_pressures(const std::vector<const Number*>& own) { return std::isfinite(own.front()->pressure); }

/// Densities down, pressures across.
Table matrix_of(const std::vector<const Number*>& own) {
  std::vector<double> pressures;
  for (const Number* number : own) pressures.push_back(number->pressure);
  std::sort(pressures.begin(), pressures.end());
  pressures.erase(std::unique(pressures.begin(), pressures.end()), pressures.end());
  Table rows{{own.front()->label}};
  for (const double pressure : pressures) rows[0].push_back(pressure_label(pressure));
  for (const Number* number : own) {
    const std::string density = density_in_words(*number);
    auto row = std::find_if(rows.begin() + 1, rows.end(), [&](const auto& each) { return each[0] == density; });
    if (row == rows.end()) {
      rows.emplace_back(pressures.size() + 1);
      row = rows.end() - 1;
      row->front() = density;
    }
    (*row)[1 + std::size_t(std::find(pressures.begin(), pressures.end(), number->pressure) - pressures.begin())] =
        value_in_words(*number);
  }
  return rows;
}

Json figure_json(const Figure& figure) {
  std::map<std::string, std::size_t> kinds;  // curves of one name have one colour
  Json list = Json::array();
  for (const Series& series : figure.series) {
    const std::size_t kind = kinds.emplace(series.label, kinds.size()).first->second;
    list.push_back({{"label", series.label},
                    {"kind", kind},
                    {"line", series.line},
                    {"measured", series.measured},
                    {"x", report::numbers(series.x)},
                    {"y", report::numbers(series.y)},
                    {"error", report::numbers(series.error)}});
  }
  return {{"key", figure.key},
          {"title", figure.title},
          {"x_label", figure.x_label},
          {"y_label", figure.y_label},
          {"caption", figure.caption},
          {"x_log", figure.x_logarithmic},
          {"y_log", figure.y_logarithmic},
          {"series", std::move(list)}};
}

Json group_json(const Sheet& sheet, const std::string& name) {
  std::vector<std::pair<std::string, std::vector<const Number*>>> keys;  // in their order
  for (const Number& number : sheet.numbers) {
    if (number.group != name) continue;
    const auto at = std::find_if(keys.begin(), keys.end(), [&](const auto& each) { return each.first == number.key; });
    if (at == keys.end())
      keys.push_back({number.key, {&number}});
    else
      at->second.push_back(&number);
  }
  Table list{{"number", "density", "value", "95 % interval", "error of calculation", "published"}};
  Table about{{"number", "key", "definition", "source", "tests"}};
  Json matrices = Json::array();
  for (const auto& [key, own] : keys) {
    std::vector<std::string> names;
    for (const Number* number : own) names.insert(names.end(), number->tests.begin(), number->tests.end());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    std::string tests = report::counted(names.size(), "test");
    constexpr std::size_t named = 9;  // of long lists the first; summary.json has all
    for (std::size_t k = 0; k < std::min(named, names.size()); ++k) tests += (k == 0 ? ": " : ", ") + names[k];
    if (names.size() > named) tests += ", ...";
    about.push_back({own.front()->label, key, own.front()->definition, own.front()->source, tests});
    if (by_pressures(own)) matrices.push_back(matrix_of(own));
    for (const Number* number : own) {
      if (by_pressures(own) && !std::isfinite(number->published)) continue;
      const bool again = number != own.front() && number->label == own.front()->label && !by_pressures(own);
      list.push_back(
          {again ? "" : number->label,
           density_in_words(*number) + (by_pressures(own) ? ", " + pressure_label(number->pressure) : std::string()),
           value_in_words(*number), interval_with_remark(*number), in_its_unit(*number, number->calculation_error),
           published_of(*number)});
    }
  }
  Json figures = Json::array();
  for (const Figure& figure : sheet.figures)
    if (figure.group == name) figures.push_back(figure_json(figure));
  return {{"name", name}, {"list", list}, {"matrices", std::move(matrices)}, {"about", about}, {"figures", figures}};
}

Json groups_json(const Sheet& sheet) {
  std::vector<std::string> names;
  const auto take = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const Number& number : sheet.numbers) take(number.group);
  for (const Figure& figure : sheet.figures) take(figure.group);
  Json list = Json::array();
  for (const std::string& name : names) list.push_back(group_json(sheet, name));
  return list;
}

/// The curves of a model over those of the sheet with the names of their tests, in figures like the sheet's.
Json figures_of(const models::Fit& fit, const Sheet& sheet) {
  struct Drawn {
    const char* figure;
    models::Loading loading;
    std::pair<double, double> (*point)(const models::ElementTest&, std::size_t);
  };
  using models::ElementTest, models::Loading;
  static const Drawn all[] = {
      {"drained_q", Loading::drained,
       [](const ElementTest& test, std::size_t k) { return std::pair(100 * test.strain[k], test.q[k] / 1000); }},
      {"drained_volume", Loading::drained,
       [](const ElementTest& test, std::size_t k) { return std::pair(100 * test.strain[k], 100 * test.eps_v[k]); }},
      {"undrained_q", Loading::undrained,
       [](const ElementTest& test, std::size_t k) { return std::pair(100 * test.strain[k], test.q[k] / 1000); }},
      {"undrained_path", Loading::undrained,
       [](const ElementTest& test, std::size_t k) { return std::pair(test.p[k] / 1000, test.q[k] / 1000); }},
      {"oedometer", Loading::oedometer,
       [](const ElementTest& test, std::size_t k) {
         return std::pair((test.p[k] + 2 * test.q[k] / 3) / 1000, 100 * test.strain[k]);
       }},
      {"isotropic", Loading::isotropic, [](const ElementTest& test, std::size_t k) {
         return std::pair(test.p[k] / 1000, test.e0 - (1 + test.e0) * test.eps_v[k]);
       }}};
  Json list = Json::array();
  for (const Drawn& drawn : all) {
    const auto own = std::find_if(sheet.figures.begin(), sheet.figures.end(),
                                  [&](const Figure& figure) { return figure.key == drawn.figure; });
    if (own == sheet.figures.end()) continue;
    Figure figure = *own;
    figure.series.clear();
    figure.caption = "Symbols: specimens; lines: the model. Tests that it was not fitted to: see the table.";
    for (const ElementTest& test : fit.calculated) {
      if (test.loading != drawn.loading || test.strain.empty()) continue;
      Series line{test.name, {}, {}, {}, true, false};
      for (std::size_t k = 0; k < test.strain.size(); ++k) {
        const auto [x, y] = drawn.point(test, k);
        line.x.push_back(x);
        line.y.push_back(y);
      }
      for (Series series : own->series) {
        if (series.label != test.name) continue;
        series.line = false;
        figure.series.push_back(std::move(series));
      }
      figure.series.push_back(std::move(line));
    }
    if (!figure.series.empty()) list.push_back(figure_json(figure));
  }
  return list;
}

Json model_json(const models::Fit& fit, const Sheet& sheet) {
  Table parameters{{"parameter", "value", "95 % interval", "origin", "meaning"}};
  for (const models::Parameter& each : fit.parameters) {
    const report::InUnit unit = report::fitting_unit(each.value, each.unit);
    const bool fitted = std::isfinite(each.low) && std::isfinite(each.high);
    parameters.push_back(
        {each.name, with_unit(report::in_three_digits(unit.factor * each.value), unit.unit),
         fitted ? with_unit(report::interval_in_words(unit.factor * each.low, unit.factor * each.high), unit.unit) : "",
         models::name_of(each.origin), each.meaning});
  }
  Table misfits{{"test", "used for", "misfit of q (% of the largest)", "misfit of strain (%)", "remark"}};
  for (const models::Misfit& each : fit.misfits) {
    const auto percent = [](double value) { return std::isfinite(value) ? report::in_three_digits(100 * value) : "-"; };
    misfits.push_back(
        {each.test, each.fitted ? "fit" : "prediction", percent(each.stress), percent(each.strain), each.remark});
  }
  return {{"name", fit.model},
          {"remarks", fit.remarks},
          {"parameters", parameters},
          {"misfits", misfits},
          {"figures", figures_of(fit, sheet)}};
}

}  // namespace

std::string page_of_sheet(const Sheet& sheet, const std::vector<models::Fit>& fits) {
  const std::string title = "Data sheet: " + sheet.soil;
  Json data{{"version", std::string(io::version)}, {"title", title},           {"headline", headline_of(sheet)},
            {"groups", groups_json(sheet)},        {"remarks", sheet.remarks}, {"models", Json::array()}};
  for (const models::Fit& fit : fits) data["models"].push_back(model_json(fit, sheet));
  return report::filled(report::sheet_template(), title, data);
}

}  // namespace rvelab::sheet
