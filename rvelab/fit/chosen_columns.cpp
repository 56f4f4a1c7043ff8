#include "rvelab/fit/chosen_columns.hpp"

#include <algorithm>
#include <map>

#include "rvelab/error.hpp"
#include "rvelab/fit/numerals.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::fit {
namespace {

std::string quoted(const std::string& name) { return "\"" + keys::shortened(io::printable(name)) + "\""; }

/// Each column of the table, as its name says; those of errors are left to their curves, those without a name out.
std::vector<Chosen> all_columns(const MeasuredTable& table) {
  const auto& header = table.names();
  std::vector<Chosen> chosen;
  for (std::size_t k = 0; k < header.size(); ++k) {
    const std::string& name = header[k];
    if (name.empty()) continue;
    const std::string of = name.ends_with("_error") ? name.substr(0, name.size() - 6) : "";
    const std::string shown = quoted(table.unit(k).empty() ? name : name + " [" + table.unit(k) + "]");
    const bool first = chosen.empty();
    if (!of.empty() && std::find(header.begin() + 1, header.end(), of) == header.end())
      throw InputError(table.header_location() + ": the column " + quoted(name) +
                       " is the error of no column; allowed: that of a "
                       "curve beside it; name it as its curve, with _error behind");
    if (!of.empty() && !first) continue;
    const auto kind = column_kind(name, table.unit(k));
    if (first && !(kind && may_be_abscissa(*kind)))
      throw InputError(table.header_location() + ": the first column is " + shown + "; allowed: " +
                       known_columns(true) + "; name the column with its unit, or choose columns (--column)");
    if (!kind || !may_be_curve(*kind))
      if (!first)
        throw InputError(table.header_location() + ": the column " + shown +
                         " is not known; allowed: " + known_columns(false) +
                         ", and each with _error behind it; name it with its unit, or choose the columns to read "
                         "(--column)");
    chosen.push_back({table.column(name), *kind});
  }
  return chosen;
}

/// "KIND=NAME" or "KIND".
struct AskedFor {
  std::string kind, name;
};
AskedFor asked_for(const std::string& text) {
  const auto equals = text.find('=');
  return {text.substr(0, equals), equals == std::string::npos ? text : text.substr(equals + 1)};
}

/// Those that were asked for.
std::vector<Chosen> selected(const MeasuredTable& table, const std::vector<std::string>& columns) {
  std::vector<Chosen> chosen;
  for (const std::string& text : columns) {
    const auto [kind_name, name] = asked_for(text);
    auto kind = column_kind(kind_name);
    const bool first = chosen.empty();
    if (!kind || !(first ? may_be_abscissa(*kind) : may_be_curve(*kind)))
      throw InputError(table.path() + ": the column asked for, " + quoted(text) + ", is no " +
                       (first ? "abscissa; allowed first: " : "curve; allowed: ") + known_columns(first) +
                       "; write KIND, or KIND=NAME for a column of another name");
    const std::size_t column = table.column(name);
    if (const auto below = column_kind(kind_name, table.unit(column))) kind = below;
    chosen.push_back({column, *kind});
  }
  return chosen;
}

/// InputError for a stress without a unit, and for a quantity twice.
void expect_units(const MeasuredTable& table, const std::vector<Chosen>& columns) {
  const auto& header = table.names();
  std::map<std::string, std::string> named;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto& [column, kind, error] = columns[k];
    if (kind.factor == 0)
      throw InputError(table.header_location() + ": the column " + quoted(header[column]) +
                       " has no unit; allowed: _Pa, _kPa or _MPa behind it, or [kPa]; write it, or name the column "
                       "as --column deviator_kPa=q does");
    if (k == 0) continue;
    if (const auto [first, fresh] = named.emplace(kind.quantity, header[column]); !fresh)
      throw InputError(table.header_location() + ": the columns " + first->second + " and " + header[column] +
                       " are one quantity twice; allowed: one column for each; remove one");
  }
}

}  // namespace

KnownHeader known_header(const std::vector<std::string>& columns) {
  KnownHeader header;
  header.allowed = known_columns(true) + " first, then " + known_columns(false);
  if (columns.empty()) {
    header.recognised = [](std::span<const std::string> names) -> std::size_t {
      // "e;0,65" above the header is a value.
      if (std::any_of(names.begin(), names.end(), [](const auto& name) { return numeral(name); })) return 0;
      const auto kinds = std::count_if(names.begin(), names.end(), [](const auto& name) { return column_kind(name); });
      const bool has_abscissa = std::any_of(names.begin(), names.end(), [](const auto& name) {
        const auto kind = column_kind(name);
        return kind && may_be_abscissa(*kind);
      });
      return std::min<std::size_t>(std::size_t(kinds), has_abscissa ? 2 : 1);
    };
    return header;
  }
  header.wanted = columns.size();
  header.recognised = [columns](std::span<const std::string> names) {
    return std::size_t(std::count_if(columns.begin(), columns.end(), [&](const std::string& text) {
      const std::string asked = in_small_letters(asked_for(text).name);
      return std::any_of(names.begin(), names.end(),
                         [&](const std::string& name) { return in_small_letters(name) == asked; });
    }));
  };
  return header;
}

std::vector<Chosen> chosen_columns(MeasuredTable& table, const std::vector<std::string>& asked) {
  std::vector<Chosen> columns = asked.empty() ? all_columns(table) : selected(table, asked);
  expect_units(table, columns);
  if (columns.size() < 2)
    throw InputError(table.header_location() + ": there is no column beside " + table.names()[columns[0].column] +
                     "; allowed: " + known_columns(false));
  std::vector<std::size_t> read;
  for (Chosen& each : columns) {
    const auto& names = table.names();
    const auto error = std::find(names.begin(), names.end(), names[each.column] + "_error");
    if (each.column != columns[0].column && error != names.end()) each.error = table.column(*error);
    read.push_back(each.column);
    if (each.error) read.push_back(*each.error);
  }
  table.choose(read);
  return columns;
}

}  // namespace rvelab::fit
