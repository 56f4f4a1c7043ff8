// Pore pressure on the nodes of the background grid: bilinear hats N_J, implicit in time.
//
// Volume that the velocities of both phases ask of the pore water at a node, w = v_f - v_s:
//
//   D(v)_J = sum_p V [N_J div v_s - n grad N_J . w]          (div(v_s + n w) = 0, by parts)
//
// and, with the same coefficients, the nodal forces of the pressure: D^T p on both phases (mixture V p grad N, fluid
// -n V N grad p). Velocities change by dt H^-1 D^T dp, H the masses and the drag of a node, so that
//
//   L dp = -D(v*),   L = dt D H^-1 D^T + S/(2 G dt) + C/dt
//
// holds D(v) = -(S/(2 G dt) + C/dt) dp to the round-off of the solver, whatever walls, bodies and free surfaces are
// there. S: what N deviates from its mean in each cell (polynomial pressure projection: Bochev, Dohrmann and
// Gunzburger 2006; White and Borja 2008): pressure that alternates from node to node, which D does not feel, meets the
// compressibility 1/(2 G). C: storage, n/K_f. Why this and not the Laplacian of Liang et al. (2023): README.md.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <memory>
#include <vector>

#include "rvelab/threads/workers.hpp"
#include "tools/mpm/bodies/planes.hpp"
#include "tools/mpm/grid/shape.hpp"

namespace mpm {

/// The two hats along each axis that a point reaches; their slopes are -1 and +1 over a cell.
template <int D>
struct Hat {
  int node[D];
  double weight[D][2];
};

template <int D>
Hat<D> hat_at(const Grid<D>& grid, const Vec<D>& position) {
  Hat<D> hat;
  for (int i = 0; i < D; ++i) {
    const double xi = (position[i] - grid.anchor[i]) / grid.cell[i], base = floor_of(xi);
    hat.node[i] = int(base);
    hat.weight[i][0] = 1 - (xi - base);
    hat.weight[i][1] = xi - base;
  }
  return hat;
}

/// Pressure (Pa, values at the nodes) and its gradient (Pa/m) at a point.
template <int D>
double pressure_and_gradient_at(const Grid<D>& grid, const Hat<D>& hat, const std::vector<double>& values,
                                Vec<D>& gradient) {
  double pressure = 0;
  gradient.setZero();
  for (int c = 0; c < 1 << D; ++c) {
    typename Grid<D>::Index node;
    double weight = 1;
    for (int i = 0; i < D; ++i) {
      node[i] = hat.node[i] + (c >> i & 1);
      weight *= hat.weight[i][c >> i & 1];
    }
    const double value = values[grid.flat(node)];
    pressure += weight * value;
    for (int i = 0; i < D; ++i) {
      double slope = value * ((c >> i & 1) != 0 ? 1 : -1) / grid.cell[i];
      for (int j = 0; j < D; ++j) slope *= j == i ? 1 : hat.weight[j][c >> j & 1];
      gradient[i] += slope;
    }
  }
  return pressure;
}

/// H^-1 of a node along one axis: velocities of solid and fluid for a unit of impulse on each (1/kg). Zero: held.
struct Mobility {
  double solid = 0, both = 0, fluid = 0;
};

template <int D>
class PorePressure {
 public:
  std::vector<double> values;  ///< Pa at nodes of the grid, compression positive; kept from step to step

  /// What a node is to the pressure: outside of the water, to be found, given.
  enum class Role : char { none, unknown, given };
  std::vector<Role> roles;
  std::vector<double> targets;  ///< Pa, of given nodes
  std::vector<double> filled;   ///< m^3, sum V N_J: the soil's part of a hat

  /// Values of a checkpoint, at the nodes of its box.
  void restore(const typename Grid<D>::Index& low, const typename Grid<D>::Index& count,
               const std::vector<double>& at_nodes) {
    low_ = low;
    count_ = count;
    values = at_nodes;
  }
  const typename Grid<D>::Index& low() const { return low_; }
  const typename Grid<D>::Index& count() const { return count_; }
  /// Keeps the values when the box of the grid changed, and makes room.
  void follow(const Grid<D>& grid);
  /// Before the points are added: nothing is known of any node.
  void clear(const Grid<D>& grid);
  /// Nodes from `lowest` on an axis repeat after `cells`: they are one unknown.
  void repeat(int axis, int lowest, int cells) {
    lowest_[axis] = lowest;
    period_[axis] = cells;
  }
  /// What was added at nodes that repeat others goes to those; values go back to them.
  void gather_repeated(const Grid<D>& grid);
  void copy_repeated(const Grid<D>& grid);
  /// Adds a saturated point. `shear`: Pa, G; `storage`: n/K_f, 1/Pa. Points whose supports share nodes must be added
  /// one after the other.
  void add(const Grid<D>& grid, const Support<D>& support, const Hat<D>& hat, double volume, double porosity,
           double shear, double storage);
  /// Mirror nodes' part goes to their images, with the sign of each phase.
  void fold(const Grid<D>& grid, const Planes<D>& solid, const Planes<D>& fluid);
  /// Nodes whose hat is filled by less than a hundredth keep the pressure of the neighbour with the fullest hat.
  void tie(const Grid<D>& grid);

  /// D(v), m^3/s, of the velocities that `velocity(node)` gives: solid and fluid.
  template <class Velocity>
  void divergence(const Grid<D>& grid, rvelab::Workers& workers, const Velocity& velocity,
                  std::vector<double>& d) const {
    over_nodes(grid, workers, [&](long at, const Index& node) {
      if (roles[at] == Role::none) return;
      double sum = 0;
      each_near(grid, node, 2, [&](long other, int local) {
        if (!used_[other]) return;
        const auto& c = columns_[other];
        const int mine = reach - 1 - local;  // of this node in the other's window
        const auto [solid, fluid] = velocity(other);
        for (int i = 0; i < D; ++i) sum += c.solid[i][mine] * solid[i] + c.fluid[i][mine] * fluid[i];
      });
      d[at] = sum;
    });
  }
  /// D^T p at a node: N, on the solid and on the fluid. `folded`: with the parts of its mirror nodes.
  void force(const Grid<D>& grid, long node, const std::vector<double>& p, bool folded, double* solid,
             double* fluid) const;
  bool reaches(long node) const { return used_[node] != 0; }

  /// dp (Pa) at the unknown nodes from L dp = right; that of given nodes stays. mobility[node * D + axis]: of nodes
  /// that mirror none. InputError if the pressure has no datum.
  void solve(const Grid<D>& grid, const std::vector<Mobility>& mobility, const std::vector<double>& right, double dt,
             rvelab::Workers& workers, std::vector<double>& dp);
  /// (S/(2 G dt) + C/dt) p, m^3/s.
  void stored(const Grid<D>& grid, const std::vector<double>& p, double dt, rvelab::Workers& workers,
              std::vector<double>& rate) const;
  long unknowns() const { return long(unknown_.size()); }

 private:
  using Index = typename Grid<D>::Index;
  static constexpr int reach = D == 2 ? 25 : 125;    ///< nodes from two below to two above
  static constexpr int pattern = D == 2 ? 81 : 729;  ///< from four below to four above
  static constexpr int corners = D == 2 ? 4 : 8;
  static constexpr long chunk = 256;
  /// D of one velocity node, for the hats around it: m^2.
  struct Columns {
    double solid[D][reach], fluid[D][reach];
  };
  /// Of one cell, by its lowest node: sum V/(2 G), sum n V/K_f; m^3/Pa.
  struct Cell {
    double soft = 0, storage = 0;
  };
  struct Tie {
    long node, to;
    double stiffness = 0;  ///< m^3/Pa
  };

  template <class Work>
  void over_nodes(const Grid<D>& grid, rvelab::Workers& workers, const Work& work) const {
    const long n = long(grid.nodes.size());
    workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
      for (long at = long(piece) * chunk; at < std::min(n, long(piece + 1) * chunk); ++at) work(at, grid.index(at));
    });
  }
  /// visit(flat, place) for the nodes of the box up to `far` away, x fastest; place counts all of them.
  template <class Visit>
  void each_near(const Grid<D>& grid, const Index& node, int far, const Visit& visit) const {
    const int top = D == 3 ? far : 0, width = 2 * far + 1;
    const bool straight = period_[0] == 0;
    const int first = straight ? std::max(-far, grid.low[0] - node[0]) : -far;
    const int last = straight ? std::min(far, grid.low[0] + grid.count[0] - 1 - node[0]) : far;
    int local = far;  // of the middle of a row
    for (int k = -top; k <= top; ++k) {
      for (int j = -far; j <= far; ++j, local += width) {
        Index at = node;
        at[1] += j;
        if constexpr (D == 3) at[2] += k;
        if (straight) {
          wrap(at);
          at[0] = grid.low[0];  // what is left of the row lies in the box
          if (!grid.contains(at)) continue;
          const long middle = grid.flat(at) + node[0] - grid.low[0];
          for (int i = first; i <= last; ++i) visit(middle + i, local + i);
          continue;
        }
        for (int i = first; i <= last; ++i) {
          Index wrapped = at;
          wrapped[0] += i;
          wrap(wrapped);
          if (grid.contains(wrapped)) visit(grid.flat(wrapped), local + i);
        }
      }
    }
  }
  /// Of a place of each_near with far = 2, along an axis.
  static int offset(int local, int axis) { return local / (axis == 0 ? 1 : axis == 1 ? 5 : 25) % 5 - 2; }
  /// The node that this one repeats.
  void wrap(Index& node) const {
    for (int i = 0; i < D; ++i) {
      if (period_[i] == 0) continue;
      node[i] = lowest_[i] + ((node[i] - lowest_[i]) % period_[i] + period_[i]) % period_[i];
    }
  }
  bool repeats() const {
    return std::any_of(period_.begin(), period_.end(), [](int cells) { return cells > 0; });
  }
  const Columns& folded(long node) const {
    return folded_of_[node] < 0 ? columns_[node] : folded_columns_[folded_of_[node]];
  }
  void number_unknowns(const Grid<D>& grid);
  void add_cells(const Grid<D>& grid, const Index& node, double dt, double* row) const;
  void add_ties(const Grid<D>& grid, long at, double* row) const;
  void fill_row(const Grid<D>& grid, const std::vector<Mobility>& mobility, double dt, long at, double* row) const;
  void expect_datum(const Grid<D>& grid, const std::vector<Mobility>& mobility, double dt,
                    rvelab::Workers& workers) const;
  void solve_space(const Eigen::VectorXd& right, Eigen::VectorXd& solution) const;

  std::vector<Columns> columns_, folded_columns_;
  std::vector<int> folded_of_;  ///< by node; -1: as it is
  std::vector<char> used_;      ///< by node: a saturated point reaches it
  std::vector<Cell> cells_;
  std::vector<Tie> ties_;
  Index low_{}, count_{}, lowest_{}, period_{};
  // The matrix, lower triangle by columns; its pattern stays while the unknowns are the same.
  std::vector<long> unknown_;  ///< nodes, in their order
  std::vector<int> number_;    ///< by node; -1: none
  Eigen::SparseMatrix<double> matrix_;
  std::unique_ptr<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> factor_;
};

}  // namespace mpm
