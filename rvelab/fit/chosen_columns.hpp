// Which columns of a measured table are read, and what each is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rvelab/fit/column_kinds.hpp"
#include "rvelab/fit/measured_table.hpp"

namespace rvelab::fit {

/// A column that is read.
struct Chosen {
  std::size_t column = 0;
  ColumnKind kind;
  std::optional<std::size_t> error{};  ///< column of its standard error
};

/// The header is known by the columns that are asked for (Selection::columns), else by an abscissa and a curve.
KnownHeader known_header(const std::vector<std::string>& columns);

/// The abscissa, then the curves, with the columns of their errors; the table keeps these alone. InputError for one
/// that is missing, not known, without a unit or there twice.
std::vector<Chosen> chosen_columns(MeasuredTable& table, const std::vector<std::string>& asked);

}  // namespace rvelab::fit
