#include "rvelab/report/mpm_run.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "rvelab/cell/cell.hpp"
#include "rvelab/ensemble/statistics.hpp"
#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/report/packed.hpp"

namespace rvelab::report {
namespace {

namespace fs = std::filesystem;
using ensemble::nan;

struct MpmField {
  const char *dataset, *key, *label, *unit;
  double factor;
  bool about_zero;
};
/// Possible fields of points; vectors are shown by their length.
constexpr MpmField mpm_fields[] = {
    {"eps_q", "eps_q", "deviatoric strain", "%", 100, false},
    {"displacement_m", "displacement", "displacement", "m", 1, false},
    {"velocity_m_s", "velocity", "speed", "m/s", 1, false},
    {"p_Pa", "p", "mean stress p", "kPa", 1e-3, false},
    {"q_Pa", "q", "deviator q", "kPa", 1e-3, false},
    {"eps_v", "eps_v", "volumetric strain, compression positive", "%", 100, true},
    {"void_ratio", "void_ratio", "void ratio", "", 1, false},
    {"fabric_anisotropy", "fabric_anisotropy", "fabric anisotropy", "", 1, false},
    {"coordination_number", "coordination_number", "coordination number", "", 1, false},
    {"rotation_deg", "rotation", "rotation, anticlockwise positive", "degrees", 1, true},
    {"plastic_strain", "plastic_strain", "plastic strain", "%", 100, false},
    {"pore_pressure_Pa", "pore_pressure", "pore pressure", "kPa", 1e-3, false},
    {"excess_pore_pressure_Pa", "excess_pore_pressure", "excess pore pressure", "kPa", 1e-3, true},
    {"pore_pressure_ratio", "pore_pressure_ratio", "excess pore pressure ratio", "", 1, true},
    {"seepage_m_s", "seepage", "seepage", "m/s", 1, false}};

/// Lengths of the rows of a dataset of n rows, or its values.
std::vector<double> values_of(const io::Hdf5File& file, const MpmField& field, std::size_t n) {
  if (!file.has(std::string("/") + field.dataset)) return std::vector<double>(n, nan);
  const std::vector<double> read = file.read<double>(std::string("/") + field.dataset);
  const std::size_t width = read.size() / std::max<std::size_t>(n, 1);
  std::vector<double> values(n);
  for (std::size_t k = 0; k < n; ++k) {
    double square = 0;
    for (std::size_t c = 0; c < width; ++c) square += read[width * k + c] * read[width * k + c];
    values[k] = field.factor * (width == 1 ? read[k] : std::sqrt(square));
  }
  return values;
}

struct Frame {
  double time = 0;
  std::vector<double> position;             ///< m
  std::vector<double> side, across, angle;  ///< sides of a stretched point, m, and the angle of the first
  std::vector<std::vector<double>> fields;
  Json rocks = Json::array();  ///< centre; in the plane half axes of the outline and angle, in space the half axes
};

Json rocks_of(const std::string& path, int dimension) {
  Json rocks = Json::array();
  if (!fs::exists(path)) return rocks;
  const io::Hdf5File file = io::Hdf5File::open(path, io::Seal::if_any);
  const std::vector<double> centres = file.read<double>("/position_m"), axes = file.read<double>("/turned_half_axes_m");
  for (std::size_t k = 0; 3 * k < centres.size(); ++k) {
    Matrix3 A;
    for (int c = 0; c < 9; ++c) A(c / 3, c % 3) = axes[9 * k + std::size_t(c)];
    Json rock{number(centres[3 * k]), number(centres[3 * k + 1]), number(centres[3 * k + 2])};
    if (dimension == 2) {
      // The outline of A u, |u| = 1, is the ellipse of (A A^T) in the plane.
      const Eigen::Matrix2d plane = A.topLeftCorner<2, 2>();
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(plane * plane.transpose());
      rock.push_back(number(std::sqrt(solver.eigenvalues()[1])));
      rock.push_back(number(std::sqrt(std::max(0.0, solver.eigenvalues()[0]))));
      rock.push_back(number(std::atan2(solver.eigenvectors()(1, 1), solver.eigenvectors()(0, 1))));
    } else {
      for (int c = 0; c < 9; ++c) rock.push_back(number(A(c % 3, c / 3)));  // half axes in sequence
    }
    rocks.push_back(std::move(rock));
  }
  return rocks;
}

Frame read_frame(const fs::path& path, int& dimension) {
  const io::Hdf5File file = io::Hdf5File::open(path.string(), io::Seal::if_any);
  Frame frame;
  frame.time = file.read<double>("/time_s").at(0);
  frame.position = file.read<double>("/position_m");
  const std::vector<double> volume = file.read<double>("/volume_m3");
  const std::size_t n = volume.size();
  for (std::size_t k = 0; k < n; ++k)
    if (frame.position[3 * k + 2] != 0) dimension = 3;
  const std::vector<double> F = file.read<double>("/deformation_gradient");
  for (std::size_t k = 0; k < n; ++k) {
    // The rectangle along the principal stretches, at most three to one; in space a ball.
    double stretch = 1, angle = 0;
    if (dimension == 2) {
      const Eigen::Matrix2d A{{F[9 * k], F[9 * k + 1]}, {F[9 * k + 3], F[9 * k + 4]}};
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(A * A.transpose());
      stretch = std::min(3.0, std::sqrt(solver.eigenvalues()[1] / solver.eigenvalues()[0]));
      angle = std::atan2(solver.eigenvectors()(1, 1), solver.eigenvectors()(0, 1));
    }
    const double side = dimension == 2 ? std::sqrt(volume[k]) : std::cbrt(volume[k]);
    frame.side.push_back(side * std::sqrt(stretch));
    frame.across.push_back(side / std::sqrt(stretch));
    frame.angle.push_back(angle);
  }
  for (const MpmField& field : mpm_fields) frame.fields.push_back(values_of(file, field, n));
  std::string rocks = path.filename().string();
  rocks.replace(0, 6, "rocks");
  frame.rocks = rocks_of((path.parent_path() / rocks).string(), dimension);
  return frame;
}

/// history.csv as columns; the unit is the end of the name.
Json history_of(const fs::path& path, std::vector<double>& times) {
  std::ifstream input(path);
  std::string line;
  std::getline(input, line);
  std::vector<std::string> names;
  std::istringstream head(line);
  for (std::string name; std::getline(head, name, ',');) names.push_back(name);
  std::vector<std::vector<double>> columns(names.size());
  while (std::getline(input, line)) {
    std::istringstream cells(line);
    std::size_t k = 0;
    for (std::string cell; std::getline(cells, cell, ',') && k < names.size(); ++k)
      columns[k].push_back(cell.empty() ? nan : std::strtod(cell.c_str(), nullptr));
    for (; k < names.size(); ++k) columns[k].push_back(nan);
  }
  if (names.empty() || names[0] != "time_s" || columns[0].empty())
    throw InputError(path.string() +
                     ": its first column is not time_s, or it has no row; allowed: the history.csv that "
                     "rvelab-mpm wrote; run the scene again");
  times = columns[0];
  Json json = Json::array();
  constexpr std::pair<const char*, const char*> units[] = {{"_N_s", "N s"}, {"_N", "N"}, {"_J", "J"},
                                                           {"_m", "m"},     {"_s", "s"}, {"_Pa", "kPa"}};
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (std::all_of(columns[c].begin(), columns[c].end(), [](double v) { return v == 0 || std::isnan(v); })) continue;
    std::string label = names[c] == "kinetic_J"     ? "kinetic energy_J"
                        : names[c] == "potential_J" ? "potential energy_J"
                                                    : names[c];
    std::string unit;
    for (const auto& [end, of] : units)
      if (unit.empty() && label.ends_with(end)) unit = of, label.erase(label.size() - std::string(end).size());
    std::replace(label.begin(), label.end(), '_', ' ');
    std::replace(label.begin(), label.end(), '.', ' ');
    if (unit == "kPa")
      for (double& value : columns[c]) value *= 1e-3;
    json.push_back({{"key", names[c]},
                    {"label", label},
                    {"unit", unit},
                    {"meaning", "column " + names[c] + " of history.csv"},
                    {"values", numbers(columns[c])}});
  }
  return json;
}

}  // namespace

bool is_mpm_run(const std::string& folder) {
  return fs::is_regular_file(fs::path(folder) / "history.csv") &&
         fs::is_regular_file(fs::path(folder) / "points_0000.h5");
}

MpmRun read_mpm_run(const std::string& folder, double largest) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file.starts_with("points_") && file.ends_with(".h5")) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  int dimension = 2;
  const double points = double(read_frame(paths.back(), dimension).side.size());
  const auto every =
      std::max<std::size_t>(1, std::size_t(std::ceil(double(paths.size()) * points * 2 *
                                                     (dimension + 1 + double(std::size(mpm_fields))) / largest)));
  std::vector<Frame> frames;
  for (std::size_t k = 0; k < paths.size(); ++k)
    if (k % every == 0 || k + 1 == paths.size()) frames.push_back(read_frame(paths[k], dimension));

  MpmRun run;
  std::vector<double> times;
  Json& json = run.json;
  json["file"] = fs::path(folder).lexically_normal().filename().string();
  if (json["file"] == "") json["file"] = fs::path(folder).lexically_normal().parent_path().filename().string();
  json["columns"] = history_of(fs::path(folder) / "history.csv", times);
  json["found"] = paths.size();
  json["dimension"] = dimension;

  // One box around all frames; positions are fractions of it.
  Vector3 low = Vector3::Constant(1e300), high = Vector3::Constant(-1e300);
  double smallest = 1e300, widest = 0;
  std::vector<double> all[std::size(mpm_fields)];
  for (const Frame& frame : frames) {
    for (std::size_t k = 0; k < frame.position.size(); ++k) {
      low[long(k % 3)] = std::min(low[long(k % 3)], frame.position[k]);
      high[long(k % 3)] = std::max(high[long(k % 3)], frame.position[k]);
    }
    for (std::size_t k = 0; k < frame.side.size(); ++k)
      smallest = std::min(smallest, frame.across[k]), widest = std::max(widest, frame.side[k]);
    for (std::size_t f = 0; f < std::size(mpm_fields); ++f)
      std::copy_if(frame.fields[f].begin(), frame.fields[f].end(), std::back_inserter(all[f]),
                   [](double v) { return std::isfinite(v); });
  }
  low -= Vector3::Constant(widest), high += Vector3::Constant(widest);
  const Vector3 size = high - low;
  Json states;
  states["shape"] = "point";
  states["grains"] = frames.back().side.size();
  states["centre"] = {number(0.5 * (low + high)[0]), number(0.5 * (low + high)[1]), number(0.5 * (low + high)[2])};
  states["side"] = {number(smallest), number(widest)};
  states["fields"] = Json::array();
  std::vector<std::size_t> shown;
  for (std::size_t f = 0; f < std::size(mpm_fields); ++f) {
    std::sort(all[f].begin(), all[f].end());
    if (all[f].empty() || all[f].front() == all[f].back()) continue;
    shown.push_back(f);
    states["fields"].push_back(described_field(mpm_fields[f], all[f]));
  }
  states["states"] = Json::array();
  for (const Frame& frame : frames) {
    const std::size_t n = frame.side.size();
    Packed packed;
    for (int k = 0; k < 9; ++k) packed.add(float(k % 4 == 0 ? size[k / 3] : 0));
    for (int k = 0; k < dimension; ++k)
      for (std::size_t g = 0; g < n; ++g) packed.add_part((frame.position[3 * g + std::size_t(k)] - low[k]) / size[k]);
    for (const auto* sides : {&frame.side, &frame.across})
      for (const double side : *sides) packed.add_within(side, smallest, widest);
    for (const double angle : frame.angle) packed.add_part(angle / std::numbers::pi);
    for (const std::size_t f : shown)
      for (const double value : frame.fields[f]) packed.add_within(value, all[f].front(), all[f].back());
    const auto nearest = std::min_element(times.begin(), times.end(), [&](double one, double other) {
      return std::abs(one - frame.time) < std::abs(other - frame.time);
    });
    Json state{{"record", nearest - times.begin()}, {"grains", n}, {"contacts", 0}, {"packed", packed.text()}};
    if (!frame.rocks.empty()) state["rocks"] = frame.rocks;
    states["states"].push_back(std::move(state));
  }
  json["states"] = std::move(states);
  run.states = frames.size();
  return run;
}

}  // namespace rvelab::report
