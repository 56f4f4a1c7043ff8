// YADE's recorded packings and paths (tests/data/yade), and the same tests run by an Rve.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "rvelab/solver/rve.hpp"
#include "tests/oracle/reference_table.hpp"
#include "tests/reference_specimen.hpp"

namespace rvelab::test {

/// A packing with its contacts, and YADE's slip convention.
inline Specimen yade_packing(const std::string& name) {
  return reference_specimen(name, {"contact.slip=full_radius_ratcheting"});
}

/// The stress that YADE reports for a packing, Pa, tension positive.
inline Matrix3 yade_stress(const std::string& name) {
  const auto rows = recorded_json("yade/" + name + ".json").at("stress_tension_positive_Pa");
  Matrix3 stress = Matrix3::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows[i].size(); ++j) stress(int(i), int(j)) = rows[i][j].get<double>();
  return stress;
}

/// How a recorded path is followed.
struct Pace {
  enum class Kind { quasi_static, as_recorded } kind = Kind::quasi_static;
  double rate = 0, time_step = 0;  ///< 1/s, s; as_recorded
};

/// YADE's own loading: its rate, time step and damping (alpha = 0.1 per component).
inline Pace as_recorded(const RecordedTable& path) {
  const auto number_after = [&](const std::string& name) {
    const auto at = path.comment().find(name + " = ");
    if (at == std::string::npos) throw std::runtime_error("the path does not state " + name);
    return std::stod(path.comment().substr(at + name.size() + 3));
  };
  const bool shear = path.columns().front() == "gamma";
  return {Pace::Kind::as_recorded, number_after(shear ? "rate g" : "rate"), number_after("dt")};
}

/// A specimen opened for loading at dt = 0 or at the recorded rate.
inline Rve open_for(Specimen specimen, const Pace& pace) {
  if (pace.kind == Pace::Kind::as_recorded) {
    specimen.damping.local = 0.1;
    specimen.damping.local_form = LocalDampingForm::component;
    specimen.solver.fixed_time_step = pace.time_step;
  }
  return Rve(specimen);
}

/// Which lateral stress a biaxial test holds: the constant one that YADE's servo was asked for, or the one that it
/// reached at each record (it wanders by 0.1 to 0.3 %, by 1.5 % at 10 kPa).
enum class Lateral { constant, as_recorded };

/// Largest difference of a stress component from the record, Pa, over the records up to a strain.
struct PathDifference {
  double largest = 0;   ///< Pa
  double pressure = 0;  ///< Pa, mean of the start state as recorded
  int records = 0, not_held = 0;
};

inline void compare_stress(const RecordedTable& path, std::size_t row, const Matrix3& stress, PathDifference& worst) {
  const double recorded[] = {path.at(row, "sxx"), path.at(row, "syy"), path.at(row, "sxy"), path.at(row, "syx")};
  const double found[] = {stress(0, 0), stress(1, 1), stress(0, 1), stress(1, 0)};
  for (int k = 0; k < 4; ++k) worst.largest = std::max(worst.largest, std::abs(found[k] - recorded[k]));
  ++worst.records;
}

inline double mean_pressure_of(const std::string& packing) {
  const Matrix3 stress = yade_stress(packing);
  return -0.5 * (stress(0, 0) + stress(1, 1));
}

/// Constant-volume simple shear of a packing to gamma, record by record.
inline PathDifference follow_shear(const std::string& packing, double to_gamma, bool physical) {
  const RecordedTable path("yade/paths/shear_" + packing + ".csv");
  const Pace pace = physical ? as_recorded(path) : Pace{};
  Rve rve = open_for(yade_packing(packing), pace);
  PathDifference worst;
  worst.pressure = mean_pressure_of(packing);
  double gamma = 0;
  for (std::size_t row = 1; row < path.rows() && path.at(row, "gamma") <= to_gamma; ++row) {
    Matrix3 shear = Matrix3::Zero();
    shear(0, 1) = path.at(row, "gamma") - gamma;  // e_x e_y twice is nothing: increments add up
    gamma = path.at(row, "gamma");
    compare_stress(path, row, rve.apply(shear, physical ? shear(0, 1) / pace.rate : 0).stress, worst);
  }
  return worst;
}

/// Biaxial compression along y of a packing to an axial strain 1 - F_yy, record by record: F_yy as recorded, no shear
/// strain, the lateral stress held.
inline PathDifference follow_biaxial(const std::string& test, const std::string& packing, double to_strain,
                                     Lateral lateral, bool physical) {
  const RecordedTable path("yade/paths/biaxial_" + test + ".csv");
  const Pace pace = physical ? as_recorded(path) : Pace{};
  Specimen specimen = yade_packing(packing);
  // Finer than the default by three: the error of increments and held stress together (up to 0.45 % of P at the
  // default) is no part of the comparison.
  specimen.solver.target_unbalanced = 3e-4;
  Rve rve = open_for(specimen, pace);
  PathDifference worst;
  worst.pressure = mean_pressure_of(packing);
  const double pressure = 1e3 * std::round(1e-3 * worst.pressure);  // whole kPa were asked for
  Matrix3 stress = rve.stress();
  double height = 1;
  for (std::size_t row = 1; row < path.rows() && path.at(row, "eps_axial") <= to_strain; ++row) {
    const double next = 1 - path.at(row, "eps_axial");
    MixedTarget target;
    target.rows.resize(3);
    target.rows[0].strain(1, 1) = 1;
    target.rows[0].value = next / height - 1;
    target.rows[1].strain(0, 1) = target.rows[1].strain(1, 0) = 0.5;
    target.rows[2].stress(0, 0) = 1;
    target.rows[2].value = (lateral == Lateral::constant ? -pressure : path.at(row, "sxx")) - stress(0, 0);
    target.rows[2].scale = pressure;
    const Response response = rve.apply(target, physical ? std::log(height / next) / pace.rate : 0);
    height = next;
    stress = response.stress;
    if (!response.report.target_held) ++worst.not_held;
    compare_stress(path, row, stress, worst);
  }
  return worst;
}

}  // namespace rvelab::test
