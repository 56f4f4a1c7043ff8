#include "rvelab/sheet/beside.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "rvelab/error.hpp"
#include "rvelab/fit/curve.hpp"
#include "rvelab/keys/table_reader.hpp"

namespace rvelab::sheet {
namespace {

using keys::TableReader;

struct PublishedNumber {
  std::string key, by, density;
  double value = unknown;
  std::optional<double> pressure;
};

struct MeasuredCurve {
  std::string name, test, curve;
  fit::Selection selection;
};

struct PublishedPoints {
  std::string name, figure;
  std::vector<double> x, y;
  bool line = false;
};

PublishedNumber read_number(TableReader& reader) {
  PublishedNumber number;
  number.key = reader.required_text("key", "of the number, as summary.csv has it");
  reader.required_number("value", number.value, "", keys::every, "published value, in the unit that summary.csv names");
  reader.text("by", number.by, "who published it", "none");
  reader.text("density", number.density, "name of the density, where a number is of one", "all");
  number.pressure = reader.optional_number("pressure_Pa", "Pa", keys::pressures, "where a number is of one", "all");
  return number;
}

MeasuredCurve read_curve(TableReader& reader) {
  MeasuredCurve measured;
  measured.name = reader.required_text("name", "of the test, for the legend");
  measured.test = reader.required_choice("test", {"drained", "undrained", "oedometer", "isotropic"},
                                         "kind of the test: the figures in which its curves are drawn");
  measured.curve = reader.required_text("curve", "measured curve, CSV; relative to the folder of the file");
  measured.selection.columns =
      reader.texts("columns", "columns of it to read, the abscissa first, as in a fit; else all");
  measured.selection.from =
      reader.optional_number("from", "", keys::every, "first abscissa, in the unit of its column");
  measured.selection.to = reader.optional_number("to", "", keys::every, "last abscissa, in the unit of its column");
  return measured;
}

PublishedPoints read_points(TableReader& reader) {
  PublishedPoints points;
  points.name = reader.required_text("name", "for the legend");
  points.figure = reader.required_text("figure", "key of the figure");
  points.x = reader.numbers("x", "", keys::every, "in the unit of the axis", "numbers", true);
  points.y = reader.numbers("y", "", keys::every, "in the unit of the axis", "numbers", true);
  reader.boolean("line", points.line, "a line through them, instead of symbols");
  if (points.x.size() != points.y.size())
    reader.mistake("y", "has " + std::to_string(points.y.size()) + " numbers, and x " +
                            std::to_string(points.x.size()) + "; allowed: as many; correct one");
  return points;
}

template <class Read>
auto read_tables(const toml::table& file, const char* name, std::vector<keys::KeyError>& errors, Read read) {
  std::vector<std::invoke_result_t<Read, TableReader&>> found;
  const toml::node* const node = file.get(name);
  if (node == nullptr) return found;
  if (!node->is_array_of_tables()) {
    errors.push_back(keys::key_error(
        node->source(), std::string(name) + " is no list of tables; allowed: [[" + name + "]] for each; write it so"));
    return found;
  }
  for (const toml::node& item : *node->as_array()) {
    const toml::table& table = *item.as_table();
    const std::string number = table["name"].value_or(table["key"].value_or(std::to_string(found.size() + 1)));
    TableReader reader(table, name, std::string(name) + "." + number, keys::line_of(table), errors);
    found.push_back(read(reader));
    reader.finish();
  }
  return found;
}

Figure* figure_in(Sheet& sheet, const std::string& key) {
  const auto found =
      std::find_if(sheet.figures.begin(), sheet.figures.end(), [&](const Figure& figure) { return figure.key == key; });
  return found == sheet.figures.end() ? nullptr : &*found;
}

void place_number(Sheet& sheet, const PublishedNumber& published) {
  bool placed = false, known = false;
  std::vector<std::string> names;
  for (Number& number : sheet.numbers) {
    names.push_back(number.key);
    if (number.key != published.key) continue;
    known = true;
    const bool same_density = published.density.empty() || number.density_name == published.density;
    const bool same_pressure =
        !published.pressure || std::abs(number.pressure - *published.pressure) <= 0.02 * *published.pressure;
    if (!same_density || !same_pressure) continue;
    number.published = published.value;
    number.published_by = published.by;
    placed = true;
  }
  if (!placed)
    sheet.remarks.push_back("The published " + published.key + " stands beside no number: the sheet has none of this " +
                            (known ? "density and pressure" : "name" + keys::nearest_in_words(published.key, names)) +
                            ".");
}

/// Figure of a curve, and the factors to the units of its axes; "": no figure shows it.
struct Axes {
  const char* figure;
  double x_factor, y_factor;
};
Axes axes_of(const std::string& test, const fit::Curve& curve) {
  const bool strain = curve.abscissa == "strain";
  if (test == "drained" && strain && curve.name == "deviator") return {"drained_q", 100, 1e-3};
  if (test == "drained" && strain && curve.name == "volumetric_strain") return {"drained_volume", 100, 100};
  if (test == "undrained" && strain && curve.name == "deviator") return {"undrained_q", 100, 1e-3};
  if (test == "oedometer" && curve.abscissa == "axial_stress" && curve.name == "strain")
    return {"oedometer", 1e-3, 100};
  if (test == "isotropic" && curve.abscissa == "p" && curve.name == "void_ratio") return {"isotropic", 1e-3, 1};
  return {"", 0, 0};
}

Series symbols_of(const std::string& label, const std::vector<double>& x, double x_factor, const std::vector<double>& y,
                  double y_factor) {
  Series series{label, {}, {}, {}, false, true};
  for (const double value : x) series.x.push_back(x_factor * value);
  for (const double value : y) series.y.push_back(y_factor * value);
  return series;
}

/// By the deviator that is largest in size: a compression that liquefies may end a little below 0.
bool extends(const fit::Curve& deviator) {
  const auto [least, most] = std::minmax_element(deviator.all_y.begin(), deviator.all_y.end());
  return least != deviator.all_y.end() && *least + *most < 0;
}

void place_curve(Sheet& sheet, const MeasuredCurve& measured, const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / measured.curve).string();
  const auto curves = fit::read_curves(path, measured.selection, [&](std::string note) {
    if (note.starts_with(path)) note.replace(0, path.size(), measured.name);  // a page names no folder of a machine
    sheet.remarks.push_back(note + ".");
  });
  bool placed = false;
  const auto put = [&](const char* key, const Series& series) {
    if (Figure* const figure = figure_in(sheet, key)) {
      figure->series.push_back(series);
      placed = true;
    }
  };
  const fit::Curve *deviator = nullptr, *pressure = nullptr;
  for (const fit::Curve& curve : curves) {
    if (curve.name == "deviator") deviator = &curve;
    if (curve.name == "p") pressure = &curve;
  }
  if (deviator != nullptr && measured.test.ends_with("drained") && extends(*deviator)) {
    sheet.remarks.push_back("The measured test " + measured.name +
                            " is not drawn: its deviator goes further below 0 than above, so that it is an extension, "
                            "and the figures are of compressions.");
    return;
  }
  for (const fit::Curve& curve : curves) {
    const Axes axes = axes_of(measured.test, curve);
    if (axes.x_factor == 0) continue;
    Series series = symbols_of(measured.name, curve.all_x, axes.x_factor, curve.all_y, axes.y_factor);
    const Series unloading =
        symbols_of(measured.name, curve.unloaded_x, axes.x_factor, curve.unloaded_y, axes.y_factor);
    series.x.insert(series.x.end(), unloading.x.begin(), unloading.x.end());
    series.y.insert(series.y.end(), unloading.y.begin(), unloading.y.end());
    put(axes.figure, series);
  }
  if (measured.test == "undrained" && deviator != nullptr && pressure != nullptr)
    put("undrained_path", symbols_of(measured.name, pressure->all_y, 1e-3, deviator->all_y, 1e-3));
  if (!placed)
    sheet.remarks.push_back("The measured test " + measured.name + " is not drawn: the sheet has no figure of " +
                            measured.test + " tests for the columns of its curve.");
}

void place_points(Sheet& sheet, const PublishedPoints& points) {
  Figure* const figure = figure_in(sheet, points.figure);
  if (figure == nullptr) {
    std::vector<std::string> names;
    for (const Figure& each : sheet.figures) names.push_back(each.key);
    sheet.remarks.push_back("The points " + points.name + " are not drawn: the sheet has no figure " + points.figure +
                            keys::nearest_in_words(points.figure, names) + ".");
    return;
  }
  figure->series.push_back({points.name, points.x, points.y, {}, points.line, true});
}

}  // namespace

void add_measured(Sheet& sheet, const std::string& toml_path) {
  const toml::table file = keys::parse_toml_file(toml_path);
  std::vector<keys::KeyError> errors;
  keys::expect_top_tables(file, errors, {"number", "measured", "points"});
  const auto numbers = read_tables(file, "number", errors, read_number);
  const auto curves = read_tables(file, "measured", errors, read_curve);
  const auto points = read_tables(file, "points", errors, read_points);
  if (errors.empty() && numbers.empty() && curves.empty() && points.empty())
    errors.push_back(
        {1, "has neither [[number]] nor [[measured]] nor [[points]]; allowed: one of them at least; give one"});
  keys::raise(toml_path, errors);
  for (const PublishedNumber& each : numbers) place_number(sheet, each);
  const std::string folder = std::filesystem::path(toml_path).parent_path().string();
  for (const MeasuredCurve& each : curves) place_curve(sheet, each, folder);
  for (const PublishedPoints& each : points) place_points(sheet, each);
}

}  // namespace rvelab::sheet
