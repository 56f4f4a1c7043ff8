#include "rvelab/grains/clump.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "rvelab/cell/cube_root.hpp"
#include "rvelab/error.hpp"

namespace rvelab {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double pi_of_clump = 3.14159265358979323846;

/// Whether every member touches another one, on a way to all of them.
bool hang_together(const std::vector<Ball>& members) {
  std::vector<bool> reached(members.size(), false);
  std::vector<std::size_t> open{0};
  reached[0] = true;
  while (!open.empty()) {
    const Ball from = members[open.back()];
    open.pop_back();
    for (std::size_t k = 0; k < members.size(); ++k)
      if (!reached[k] && (members[k].at - from.at).norm() <= (members[k].radius + from.radius) * (1 + 1e-9)) {
        reached[k] = true;
        open.push_back(k);
      }
  }
  return std::all_of(reached.begin(), reached.end(), [](bool r) { return r; });
}

/// Principal axes as columns, of ascending moments, right-handed. Axes that are principal already stay along x, y, z.
Matrix3d principal_axes(Matrix3d inertia, int dimension) {
  if (dimension == 2) return Matrix3d::Identity();
  const double scale = inertia.trace();
  for (int r = 0; r < 3; ++r)
    for (int k = 0; k < 3; ++k)
      if (r != k && std::abs(inertia(r, k)) < 1e-9 * scale) inertia(r, k) = 0;
  Matrix3d axes = Matrix3d::Zero();
  if (inertia.isDiagonal(0)) {
    int order[3] = {0, 1, 2};
    std::stable_sort(order, order + 3, [&](int a, int b) { return inertia(a, a) < inertia(b, b) - 1e-9 * scale; });
    for (int k = 0; k < 3; ++k) axes(order[k], k) = 1;
  } else {
    axes = Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia).eigenvectors();
  }
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  return axes;
}

}  // namespace

Clump clump_of(const std::string& name, const std::vector<Ball>& members, int dimension) {
  const std::string who = "clump \"" + name + "\": ";
  if (members.empty()) throw InputError(who + "no members; allowed: one or more; add rows of x, y, z, r");
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Ball& m = members[k];
    if (!(m.radius > 0) || !std::isfinite(m.radius) || !m.at.allFinite())
      throw InputError(who + "member " + std::to_string(k + 1) + " has r = " + in_words(m.radius) +
                       "; allowed: r > 0, finite places; correct it");
    if (dimension == 2 && m.at.z() != 0)
      throw InputError(who + "member " + std::to_string(k + 1) + " has z = " + in_words(m.at.z()) +
                       "; allowed: 0 in 2D; take pack.members = \"sphere\", or give a plane shape");
  }
  if (!hang_together(members))
    throw InputError(who + "some members touch none of the others; allowed: members that hang together; move them");
  // About the first member, in units of the largest: numbers of any unit.
  double largest = 0;
  for (const Ball& m : members) largest = std::max(largest, m.radius);
  std::vector<Ball> scaled;
  for (const Ball& m : members) scaled.push_back({(m.at - members.front().at) / largest, m.radius / largest});
  const MassProperties p = dimension == 2 ? union_of_discs(scaled) : union_of_spheres(scaled);
  const double radius =
      dimension == 2 ? std::sqrt(p.volume / pi_of_clump) : cube_root(p.volume / (4.0 / 3.0 * pi_of_clump));
  const Matrix3d axes = principal_axes(p.inertia, dimension);
  Clump clump;
  clump.name = name;
  clump.outer_radius = 0;
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();
  for (const Ball& m : scaled) {
    const Vector3d at = axes.transpose() * (m.at - p.centre) / radius;
    clump.members.push_back({members.size() == 1 ? Vector3d(Vector3d::Zero()) : at, m.radius / radius});
    const Ball& last = clump.members.back();
    clump.outer_radius = std::max(clump.outer_radius, last.at.norm() + last.radius);
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], last.at[k] - last.radius);
      high[k] = std::max(high[k], last.at[k] + last.radius);
    }
  }
  if (members.size() == 1) clump.members.front().radius = 1;
  clump.extents = high - low;
  if (dimension == 2)
    clump.gyration = Vector3d::Constant(p.inertia(2, 2));
  else
    clump.gyration = (axes.transpose() * p.inertia * axes).diagonal();
  clump.gyration /= p.volume * radius * radius;
  return clump;
}

const std::vector<PublishedClump>& published_clumps() {
  static const std::vector<PublishedClump> all = [] {
    const double root3 = std::sqrt(3.0);
    std::vector<PublishedClump> list{
        {"single", true, true, "one disc or sphere, for mixtures", {{0, 0, 0, 1}}},
        {"pair",
         true,
         true,
         "two equal members half a diameter apart, 1.5 times as long as wide (Favier et al. 1999)",
         {{-0.5, 0, 0, 1}, {0.5, 0, 0, 1}}},
        {"triangle",
         true,
         true,
         "three equal members at the corners of a triangle of one radius (Saint-Cyr et al. 2011, Szarf et al. 2011)",
         {{-0.5, -root3 / 6, 0, 1}, {0.5, -root3 / 6, 0, 1}, {0, root3 / 3, 0, 1}}},
        {"square",
         true,
         true,
         "four equal members at the corners of a square of one radius; in 3D flat",
         {{-0.5, -0.5, 0, 1}, {0.5, -0.5, 0, 1}, {-0.5, 0.5, 0, 1}, {0.5, 0.5, 0, 1}}},
        {"elongated",
         true,
         true,
         "four equal members in a row, one radius apart, 2.5 times as long as wide",
         {{-1.5, 0, 0, 1}, {-0.5, 0, 0, 1}, {0.5, 0, 0, 1}, {1.5, 0, 0, 1}}},
        {"soybean",
         false,
         true,
         "four spheres in a row, as ellipsoids of 1.3 : 1 were made (after Vu-Quoc et al. 2000)",
         {{-0.35, 0, 0, 0.93}, {-0.12, 0, 0, 1}, {0.12, 0, 0, 1}, {0.35, 0, 0, 0.93}}},
        {"tetrapod",
         false,
         true,
         "four equal spheres at the corners of a tetrahedron, 1.41 radii apart "
         "(aggregates of Azema et al. 2013)",
         {{0.5, 0.5, 0.5, 1}, {0.5, -0.5, -0.5, 1}, {-0.5, 0.5, -0.5, 1}, {-0.5, -0.5, 0.5, 1}}},
        {"flat",
         false,
         true,
         "seven equal spheres in a hexagon, one radius apart, twice as wide as thick",
         {{0, 0, 0, 1},
          {1, 0, 0, 1},
          {0.5, root3 / 2, 0, 1},
          {-0.5, root3 / 2, 0, 1},
          {-1, 0, 0, 1},
          {-0.5, -root3 / 2, 0, 1},
          {0.5, -root3 / 2, 0, 1}}}};
    return list;
  }();
  return all;
}

std::string names_of_clumps(int dimension) {
  std::string names;
  for (const PublishedClump& each : published_clumps())
    if (dimension == 2 ? each.plane : each.space) names += (names.empty() ? "" : ", ") + std::string(each.name);
  return names;
}

Clump published_clump(const std::string& name, int dimension) {
  for (const PublishedClump& each : published_clumps()) {
    if (name != each.name || !(dimension == 2 ? each.plane : each.space)) continue;
    std::vector<Ball> members;
    for (const auto& [x, y, z, r] : each.members) members.push_back({{x, y, z}, r});
    return clump_of(name, members, dimension);
  }
  throw InputError("clump \"" + name + "\" is not known; allowed: " + names_of_clumps(dimension) +
                   ", or a file of members NAME.csv with columns x, y, z, r; choose one of these");
}

std::vector<Ball> read_members(const std::string& text, const std::string& where) {
  std::istringstream lines(text);
  std::string line;
  std::vector<int> columns;  // 0 to 3 for x, y, z, r
  std::vector<Ball> members;
  const char* names[4] = {"x", "y", "z", "r"};
  for (long number = 1; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos || line.front() == '#') continue;
    const std::string at = where + ", line " + std::to_string(number) + ": ";
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) {
      const auto from = cell.find_first_not_of(" \t"), to = cell.find_last_not_of(" \t");
      cells.push_back(from == std::string::npos ? "" : cell.substr(from, to - from + 1));
    }
    if (columns.empty()) {
      int found[4] = {};
      for (const std::string& cell : cells) {
        const auto* name = std::find(names, names + 4, cell);
        if (name == names + 4 || found[name - names]++ > 0)
          throw InputError(at + "column \"" + cell + "\"; allowed: a heading of x, y, z, r, each once; correct it");
        columns.push_back(int(name - names));
      }
      if (found[0] == 0 || found[1] == 0 || found[3] == 0)
        throw InputError(at +
                         "a column is missing; allowed: a heading of x, y, z, r (z may be left out in 2D); add it");
      continue;
    }
    if (cells.size() != columns.size())
      throw InputError(at + std::to_string(cells.size()) + " values; allowed: " + std::to_string(columns.size()) +
                       ", one for each column; correct it");
    Ball ball;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      double value = 0;
      const char* end = cells[k].data() + cells[k].size();
      const auto read = std::from_chars(cells[k].data(), end, value);
      if (read.ec != std::errc() || read.ptr != end || !std::isfinite(value))
        throw InputError(at + "\"" + cells[k] + "\" is no number; allowed: numbers; correct it");
      if (columns[k] == 3)
        ball.radius = value;
      else
        ball.at[columns[k]] = value;
    }
    members.push_back(ball);
  }
  if (members.empty())
    throw InputError(where + ": no members; allowed: a heading x, y, z, r and a row for each; add them");
  return members;
}

}  // namespace rvelab
