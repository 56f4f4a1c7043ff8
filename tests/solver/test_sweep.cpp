// One large cell shared among threads: the bits of a single thread. Pairs passed over until they touch: the bits of all
// pairs computed. And the gather table: each pair once on each side, in the order of the pairs.
#include <algorithm>
#include <atomic>
#include <numeric>
#include <random>

#include "rvelab/error.hpp"
#include "rvelab/solver/assembly/gather_table.hpp"
#include "rvelab/solver/loading/inertia.hpp"
#include "rvelab/solver/loading/sweep.hpp"
#include "tests/bodies.hpp"

using namespace rvelab;
using namespace rvelab::test;

TEST_CASE("A large cell has the same bits on any team of threads, of clumps too", "[solver]") {
  std::vector<Specimen> starts;
  for (const Shape shape : {Shape::disc, Shape::sphere, Shape::ellipse})
    starts.push_back(disordered(shape, dimension_of(shape) == 2 ? 175 : 32, linear_material(2e6, 1e6, 0.4),
                                Law::linear_stiffness, 0.52, 9));
  for (const auto& [shape, side] : {std::pair{Shape::disc, 124}, {Shape::sphere, 25}})
    starts.push_back(clumps_in_a_crystal(shape, side, "pair", 0.005, 3));
  for (Specimen& start : starts) {
    const bool clumps = !start.bodies.empty();
    CAPTURE(int(start.shape), clumps);
    REQUIRE(start.grains.size() >= least_shared_grains);
    start.damping.local = clumps ? 0 : 0.1;
    start.solver.fixed_substeps = clumps ? 8 : 12;
    const auto end_state = [&](Workers* team) {
      Rve rve(start);
      rve.share(team);
      rve.apply(gradient(-3e-3, 8e-3, 0, -1e-3), 0);
      const auto saved = rve.save();
      rve.restore(saved);
      rve.apply(gradient(-1e-3, 6e-3, 0, -1e-3), double(start.solver.fixed_substeps) * rve.critical_time_step());
      CHECK((clumps || rve.specimen().state.list.builds >= 3));  // the lists of the way are the team's too
      return rve.save();
    };
    const auto alone = end_state(nullptr);
    for (const unsigned threads : {1u, 3u, 8u}) {
      Workers team(threads);
      CHECK(bool(end_state(&team) == alone));
    }
  }
}

TEST_CASE("Pairs that are passed over come to touch, and to part again, as if they had been computed at every step",
          "[solver]") {
  for (const Shape shape : {Shape::disc, Shape::sphere, Shape::ellipse}) {
    // Loose grains that fly about: contacts open and close among the pairs listed.
    Specimen start = disordered(shape, dimension_of(shape) == 2 ? 12 : 6, linear_material(2e6, 1e6, 0.4),
                                Law::linear_stiffness, 0.47, 4);
    start.solver.skin = 0.4;
    start.damping.local = 0.1;
    std::mt19937_64 generator(8);
    std::uniform_real_distribution<double> speed(-0.3, 0.3);
    for (Vector3& v : start.grains.velocity)
      for (int k = 0; k < start.cell.dimension; ++k) v[k] = speed(generator);
    Model f;
    Assembly passing, computing;
    open_assembly(start, f, passing);
    use_physical_inertia(f, passing);
    computing = passing;
    computing.pairs.near = computing.pairs.padded();
    leave_out_pairs_beyond(force_row_length(dimension_of(shape)), computing.pairs);
    REQUIRE(passing.pairs.near < passing.pairs.listed / 2);
    StepConstants c = base_constants(f, passing);
    c.dt = 2e-5;
    c.map = {1, 0, 0, 1, 0, 1};
    c.velocity_map = {c.dt, 0, 0, c.dt, 0, c.dt};
    for (int k = 0; k < 3; ++k) c.momentum_map[4 * k] = c.force_map[4 * k] = c.spin_map[4 * k] = 1;
    c.local_damping = 0.1;
    std::size_t asleep = 0, awoken = 0, parted = 0;
    std::vector<std::uint8_t> before = passing.pairs.touched, ever = before;
    for (int step = 0; step < 150; ++step) {
      for (Assembly* a : {&passing, &computing}) {
        StepSums sums;
        sweep_grains(f.kernels.at_rate[1], c, arrays_of(f, *a), arrays_of(a->pairs), long(a->mass.size()), nullptr,
                     sums);
        sweep_pairs(f.kernels.pairs, c, arrays_of(a->pairs), a->rows.data(), long(a->pairs.padded()), nullptr);
        gather_pairs_that_touch(a->pairs);
      }
      for (std::size_t unit = passing.pairs.near / 8; unit < before.size(); ++unit) {
        const bool now = passing.pairs.touched[unit] != 0;
        asleep += std::size_t(!now);
        ever[unit] |= std::uint8_t(now);
        awoken += std::size_t(now && before[unit] == 0);
        parted += std::size_t(!now && before[unit] != 0);
      }
      before = passing.pairs.touched;
      REQUIRE(passing.rows == computing.rows);
      // Rows of spheres hold half the overlap too, which is nothing where there is no force.
      if (dimension_of(shape) == 2) REQUIRE(passing.pairs.force == computing.pairs.force);
      for (int k = 0; k < f.tangential_components(); ++k)
        REQUIRE(passing.pairs.tangential[k] == computing.pairs.tangential[k]);
    }
    // The grain loop reads the force rows of the pairs that have touched, and of no others beyond the near ones.
    const std::int32_t row = force_row_length(dimension_of(shape));
    for (std::size_t p = passing.pairs.near; p < passing.pairs.listed; ++p)
      for (std::size_t side = 0; side < 2; ++side) {
        const auto slot = std::size_t(passing.pairs.slots_beyond[2 * (p - passing.pairs.near) + side]);
        REQUIRE(passing.pairs.slots[slot] == row * std::int32_t(p));
        REQUIRE(passing.pairs.gathered[slot] == row * std::int32_t(ever[p / 8] != 0 ? p : passing.pairs.listed));
      }
    CAPTURE(int(shape), asleep, awoken, parted);
    CHECK(asleep > 100);
    CHECK(awoken > 3);
    CHECK(parted > 3);
  }
}

TEST_CASE("Coming back to a saved state keeps the stop flag of the Rve", "[solver]") {
  Rve rve(disordered(Shape::disc, 6, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.52, 3));
  const std::atomic<bool> stop{true};
  rve.watch(&stop);
  rve.restore(rve.save());
  CHECK_THROWS_AS(rve.apply(gradient(-1e-4, 0, 0, 0), 0), Interrupted);
}

TEST_CASE("The gather table names each pair once on either side, in the order of the pairs", "[solver]") {
  std::mt19937_64 generator(5);
  for (const std::size_t grains : {1u, 7u, 63u, 64u, 200u}) {
    const std::size_t padded = (grains / 8 + 1) * 8;
    constexpr std::int32_t row = 4;
    PairTable pairs;
    // A hub with many partners, grains with none, a grain with its own image.
    for (std::size_t i = 0; i < grains; ++i)
      for (std::size_t j = i; j < grains; ++j)
        if ((i == 0 && j % 3 == 0) || (i > 0 && generator() % grains < 3)) {
          pairs.i.push_back(std::int32_t(i));
          pairs.j.push_back(std::int32_t(j));
        }
    pairs.listed = pairs.i.size();
    // The order of the pairs is not that of their places.
    pairs.order.resize(pairs.listed);
    std::iota(pairs.order.begin(), pairs.order.end(), 0);
    std::shuffle(pairs.order.begin(), pairs.order.end(), generator);
    fill_gather_table(padded, row, pairs);
    REQUIRE(pairs.slot_begin.size() == padded / 2 + 1);
    REQUIRE(pairs.tasks.size() == 2 * padded);
    std::vector<std::vector<std::int32_t>> as_j(padded), as_i(padded);
    std::vector<int> seen(2 * padded, 0);
    for (std::size_t block = 0; block < padded / 2; ++block) {
      const std::size_t chunk = 2 * block / std::size_t(chunk_grains) * std::size_t(chunk_grains);
      for (std::size_t lane = 0; lane < 4; ++lane) {
        const std::size_t task = pairs.tasks[4 * block + lane] / 4;
        const bool is_i = task >= std::size_t(chunk_grains);
        const std::size_t grain = chunk + (is_i ? task - std::size_t(chunk_grains) : task);
        REQUIRE(grain < padded);
        ++seen[2 * grain + std::size_t(is_i)];
        for (auto slot = pairs.slot_begin[block]; slot < pairs.slot_begin[block + 1]; ++slot) {
          const std::int32_t start = pairs.slots[4 * std::size_t(slot) + lane];
          REQUIRE(start % row == 0);
          if (std::size_t(start / row) < pairs.listed) (is_i ? as_i : as_j)[grain].push_back(start / row);
        }
      }
    }
    for (const int times : seen) REQUIRE(times == 1);
    std::vector<std::vector<std::int32_t>> want_j(padded), want_i(padded);
    for (const std::int32_t q : pairs.order) {
      want_j[std::size_t(pairs.j[std::size_t(q)])].push_back(q);
      want_i[std::size_t(pairs.i[std::size_t(q)])].push_back(q);
    }
    CHECK(as_j == want_j);
    CHECK(as_i == want_i);
    // Read back grain by grain: those in which it is j before those in which it is i, each side in order.
    std::vector<std::vector<std::int32_t>> read_j(padded), read_i(padded);
    bool j_first = true;
    each_pair_of_grains<2>(pairs, 0, padded, [&](std::size_t grain, std::size_t place, bool is_j) {
      j_first = j_first && (!is_j || read_i[grain].empty());
      (is_j ? read_j : read_i)[grain].push_back(std::int32_t(place));
    });
    CHECK(j_first);
    CHECK(read_j == want_j);
    CHECK(read_i == want_i);
  }
}
