#include "rvelab/sheet/write_sheet.hpp"

#include <cmath>
#include <filesystem>

#include "rvelab/error.hpp"
#include "rvelab/io/publish.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/report/json.hpp"

namespace rvelab::sheet {
namespace {

using report::Json;

std::string cell_of(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
  return quoted + '"';
}
std::string cell_of(double value) { return std::isfinite(value) ? io::exact(value) : ""; }

std::string joined_names(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

/// NaN is null.
Json exact_number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json as_json(const Number& number) {
  const bool judged = std::isfinite(number.published) && std::isfinite(number.low) && std::isfinite(number.high);
  return {{"key", number.key},
          {"group", number.group},
          {"label", number.label},
          {"unit", number.unit},
          {"density", number.density_name.empty() ? Json() : Json(number.density_name)},
          {"relative_density", exact_number(number.relative_density)},
          {"pressure_Pa", exact_number(number.pressure)},
          {"mean", exact_number(number.mean)},
          {"standard_error", exact_number(number.standard_error)},
          {"low_95", exact_number(number.low)},
          {"high_95", exact_number(number.high)},
          {"calculation_error", exact_number(number.calculation_error)},
          {"published", exact_number(number.published)},
          {"published_by", number.published_by.empty() ? Json() : Json(number.published_by)},
          {"remark", number.remark},
          {"published_within_interval",
           judged ? Json(number.low <= number.published && number.published <= number.high) : Json()},
          {"tests", number.tests},
          {"definition", number.definition},
          {"source", number.source}};
}

Json as_json(const models::Fit& fit) {
  Json parameters = Json::array(), misfits = Json::array();
  for (const models::Parameter& each : fit.parameters)
    parameters.push_back({{"name", each.name},
                          {"unit", each.unit},
                          {"meaning", each.meaning},
                          {"origin", models::name_of(each.origin)},
                          {"value", exact_number(each.value)},
                          {"low_95", exact_number(each.low)},
                          {"high_95", exact_number(each.high)}});
  for (const models::Misfit& each : fit.misfits)
    misfits.push_back({{"test", each.test},
                       {"fitted", each.fitted},
                       {"stress", exact_number(each.stress)},
                       {"strain", exact_number(each.strain)},
                       {"remark", each.remark}});
  return {{"model", fit.model},
          {"remarks", fit.remarks},
          {"parameters", std::move(parameters)},
          {"misfits", std::move(misfits)}};
}

}  // namespace

std::string json_of_sheet(const Sheet& sheet, const std::vector<models::Fit>& fits) {
  Json whole{{"soil", sheet.soil}, {"version", std::string(io::version)}, {"numbers", Json::array()}};
  for (const Number& number : sheet.numbers) whole["numbers"].push_back(as_json(number));
  whole["remarks"] = sheet.remarks;
  whole["models"] = Json::array();
  for (const models::Fit& fit : fits) whole["models"].push_back(as_json(fit));
  return whole.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string csv_of_sheet(const Sheet& sheet) {
  std::string text =
      "key,unit,density,relative_density,pressure_Pa,mean,standard_error,low_95,high_95,calculation_error,published,"
      "published_by,label,tests,definition,source,remark\n";
  for (const Number& number : sheet.numbers) {
    for (const std::string& cell : {number.key, number.unit, number.density_name}) text += cell_of(cell) + ",";
    for (const double value : {number.relative_density, number.pressure, number.mean, number.standard_error, number.low,
                               number.high, number.calculation_error, number.published})
      text += cell_of(value) + ",";
    for (const std::string& cell : {number.published_by, number.label, joined_names(number.tests), number.definition})
      text += cell_of(cell) + ",";
    text += cell_of(number.source) + "," + cell_of(number.remark) + "\n";
  }
  return text;
}

void write_sheet(const Sheet& sheet, const std::vector<models::Fit>& fits, const std::string& folder) {
  namespace fs = std::filesystem;
  const std::string page = page_of_sheet(sheet, fits), json = json_of_sheet(sheet, fits), csv = csv_of_sheet(sheet);
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed || !fs::is_directory(folder))
    throw InputError(folder + ": cannot be made (" + failed.message() +
                     "); allowed: a folder that can be written; give "
                     "another one with -o");
  const auto place = [&](const char* name) { return (fs::path(folder) / name).string(); };
  io::publish_text(place("summary.json"), json);
  io::publish_text(place("summary.csv"), csv);
  io::publish_text(place("index.html"), page);
}

}  // namespace rvelab::sheet
