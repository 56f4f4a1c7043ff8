// One step of the explicit material point method, in the plane (plane strain) and in space.
//
//   USF  points -> nodal mass, momentum; v = p/m; velocity gradient -> stress; nodal force; v' = v + f dt/m; -> points
//   MUSL points -> nodal mass, momentum, force; v' -> points; the points' new momentum -> nodes -> gradient -> stress
//
// v_p = a PIC + (1 - a) FLIP; points move with the nodal velocity (Liang and Zhao 2019, eq. 2 to 19).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "tools/mpm/materials/material.hpp"
#include "tools/mpm/rocks/rocks.hpp"
#include "tools/mpm/step/contact.hpp"
#include "tools/mpm/step/loads.hpp"
#include "tools/mpm/step/options.hpp"
#include "tools/mpm/water/fluid.hpp"

namespace mpm {

/// Points first .. first + count - 1 are of one material.
template <int D>
struct MaterialGroup {
  long first = 0, count = 0;
  std::string name;
  std::shared_ptr<Material<D>> material;
};

/// What solid and pore water have each for itself.
template <int D>
struct Phase {
  Grid<D>& grid;
  Planes<D>& planes;
  Bodies<D>& bodies;
  Rocks<D>* rocks;  ///< null: none
  SurfaceContact<D>& contact;
  double& nodal_energy;
};

template <int D>
class Solver {
 public:
  mutable rvelab::Workers workers;  ///< first, so that it outlives what works with it
  std::vector<Point<D>> points;
  std::vector<MaterialGroup<D>> groups;
  Grid<D> grid;
  Planes<D> planes;
  Bodies<D> bodies;
  Options<D> options;
  /// J, change of energy at the nodes over all steps since the start; what the points have less was lost in mapping. It
  /// is kinetic energy, and the half step by which stress and height lag velocity: 1/2 V sigma:(grad w - grad v) dt, of
  /// the velocities w that one step ends with and v that mapping makes of them for the next, and (USF) 1/2 m g.(w - v)
  /// dt, of v and w at the start and end of one step.
  double nodal_energy = 0;
  Loads loads;
  double load_work = 0;  ///< J, of `loads` on the soil and its water
  double time = 0;
  long steps = 0;
  double grid_seconds = 0, material_seconds = 0;
  /// Axis along which the cells shrink or grow so that a moving plane stays on its nodes, and that plane; -1: none.
  int follow_axis = -1, followed = -1;
  Vec<D> first_cell = Vec<D>::Ones();
  /// Body force of position and time, m/s^2, beside gravity; empty: none.
  std::function<Vec<D>(const Vec<D>&, double)> body_force;

  std::unique_ptr<Fluid<D>> fluid;  ///< null: dry soil
  std::unique_ptr<Rocks<D>> rocks;  ///< null: none

  /// threads: 0: as many as the processor runs at once.
  explicit Solver(int threads)
      : workers(threads > 0 ? unsigned(threads) : std::max(1u, std::thread::hardware_concurrency())) {}
  const MaterialGroup<D>& group_of(long point) const;
  /// s, from the fastest wave and the fastest point, or from a body or plane that is faster than both.
  double stable_step() const;
  void step(double dt);
  /// visit(x) for each boundary, then each body: what has a name, a velocity and a reaction.
  template <class Visit>
  void each_driven(const Visit& visit) const {
    for (const auto& plane : planes.all) visit(plane);
    for (const auto& body : bodies.all) visit(body);
  }
  template <class Visit>
  void each_driven(const Visit& visit) {
    for (auto& plane : planes.all) visit(plane);
    for (auto& body : bodies.all) visit(body);
  }
  std::size_t count_driven() const { return planes.all.size() + bodies.all.size(); }

 private:
  // step.cpp
  void rocks_alone(double dt);
  void saturated_step(double dt);
  void start_velocities(Phase<D> phase);
  void end_velocities(double dt);
  void second_map(double dt);
  void advance_free(double dt);
  void advance_rocks(double dt);
  Phase<D> solid() { return {grid, planes, bodies, rocks.get(), contact_, nodal_energy}; }
  Phase<D> water() { return {fluid->grid, fluid->planes, fluid->bodies, nullptr, water_contact_, fluid->nodal_energy}; }
  // places.cpp
  void begin_step();
  void place_grid();
  void find_supports();
  void sort_into_slabs();
  void clear(Grid<D>& of);
  // mapping.cpp
  void map_momentum();
  void map_force();
  void gradients(double dt);
  void stresses(double dt);
  void take_changes(Phase<D> phase, double dt);
  void add_load_work(double dt);
  void move_points(double dt);
  /// m/s^2, of the frame that the scene is seen from.
  Vec<D> frame_acceleration() const { return loads.shaking.acceleration(time) * Vec<D>::Unit(loads.shaking.axis); }
  // dashpots.cpp, of absorbing planes
  struct Dashpot {
    int plane;
    long node, inside;  ///< on the plane, and the next one
    Vec<D> force;       ///< N, on the soil
  };
  std::vector<double> areas_on(const Plane<D>& plane) const;
  void add_dashpots(double dt);
  void book_dashpots(double dt);
  // saturated.cpp
  void map_water_momentum();
  void map_saturated_force();
  void assemble_water();
  void predict_velocities(double dt);
  void add_slip(double sign);
  void hold_velocities(double dt);
  void project(double dt);
  void correct_velocities(const std::vector<double>& dp, double dt);
  void balance_water(double dt);
  void move_water(double dt);

  /// work(point) in parallel, in an order of sums that no number of threads changes: even slabs, then odd ones.
  template <class Work>
  void over_slabs(const Work& work) {
    const long slabs = long(slab_begin_.size()) - 1;
    for (const long parity : {0L, 1L}) {
      workers.for_each((slabs - parity + 1) / 2, [&](std::int64_t piece) {
        const long slab = 2 * piece + parity;
        for (long k = slab_begin_[slab]; k < slab_begin_[slab + 1]; ++k) work(order_[k]);
      });
    }
  }
  /// work(k) for k < n in parallel.
  template <class Work>
  void over(long n, const Work& work) {
    workers.for_each((n + chunk - 1) / chunk, [&](std::int64_t piece) {
      for (long k = piece * chunk; k < std::min(n, long(piece + 1) * chunk); ++k) work(k);
    });
  }
  /// work(node) for each node with mass.
  template <class Work>
  void over_nodes(Grid<D>& of, const Work& work) {
    over(long(of.nodes.size()), [&](long k) {
      if (of.nodes[k].mass > 0) work(of.nodes[k]);
    });
  }

  static constexpr long chunk = 1024;  ///< points of one piece of work; sums over pieces are made in their order
  std::vector<Support<D>> supports_;
  std::vector<long> order_, slab_begin_, slab_next_;
  std::vector<Dashpot> dashpots_;
  SurfaceContact<D> contact_, water_contact_;
  std::vector<double> sums_;  ///< J, of each piece of nodes or points
};

}  // namespace mpm
