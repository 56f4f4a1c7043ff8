// What the columns of a measured curve are, by the names that laboratories give them.
#pragma once

#include <optional>
#include <string>

namespace rvelab::fit {

/// What a column is: its quantity, and the factor that brings it to SI.
struct ColumnKind {
  std::string quantity;  ///< "strain", "axial_stress", "p", "q_over_p", "deviator", "volumetric_strain", "void_ratio"
  double factor = 1;     ///< 0: a stress whose name has no unit
  bool is_stress() const { return quantity == "p" || quantity == "axial_stress" || quantity == "deviator"; }
};

/// By name and unit, "deviator_kPa", "q [kPa]", "eps_a (%)", "axial_strain_percent"; capitals do not matter, and a
/// strain without a unit is a number. `below`: the unit of a name that has none itself, as a row below the header says
/// it. None: not known.
std::optional<ColumnKind> column_kind(const std::string& name, const std::string& below = "");

/// The names that messages offer, for an abscissa or for a curve over it.
std::string known_columns(bool abscissa);

bool may_be_abscissa(const ColumnKind& kind);
bool may_be_curve(const ColumnKind& kind);

}  // namespace rvelab::fit
