// Ellipses are listed by their outlines, which move where grains turn. Held here against all pairs and images.
#include "rvelab/solver/assembly/oriented_bounds.hpp"

#include <set>

#include "rvelab/solver/assembly/outline.hpp"
#include "rvelab/solver/loading/stepping.hpp"
#include "tests/solver/brute_force.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

double support(double a, double b, double angle) { return std::hypot(a * std::cos(angle), b * std::sin(angle)); }

/// Needles of aspect 10, all but along x and clear of each other, that spin either way and drift slowly.
Specimen spinning_needles() {
  const int columns = 4, rows = 10;
  const double a = 1, across = 2.1 * a, along = 0.9 * a;
  Specimen s = empty_specimen(Shape::ellipse, columns * across, linear_material(1e4, 5e3, 0.5));
  s.cell.lattice(1, 1) = rows * along;
  s.materials[0].density = 1;
  s.solver.min_height = 0.1;
  s.solver.max_overlap_ratio = 10;
  std::mt19937_64 generator(5);
  const auto uniform = [&] { return 2 * double(generator() >> 11) / 9007199254740992.0 - 1; };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double shift = j % 2 == 0 ? 0 : 0.5 * across;
      add_ellipse(s, {i * across + shift, j * along, 0}, a, 0.1 * a, 0.1 * uniform());
      s.grains.velocity.back() = 0.02 * Vector3(uniform(), uniform(), 0);
      s.grains.spin.back() = Vector3(0, 0, 3 * uniform());
    }
  s.state.last_step.loading = Loading::at_rate;
  return s;
}

struct Opened {
  Model model;
  Assembly now;
  explicit Opened(const Specimen& s) { open_assembly(s, model, now); }

  std::set<ListedPair> listed() const {
    std::set<ListedPair> pairs;
    for (const std::int32_t p : now.pairs.order)
      pairs.insert({now.pairs.i[std::size_t(p)], now.pairs.j[std::size_t(p)], now.pairs.image[std::size_t(p)]});
    return pairs;
  }
  /// All pairs, images included, whose circles are nearer than `within`.
  std::vector<ListedPair> candidates(double within) const {
    std::vector<Vector3> positions;
    for (std::size_t g = 0; g < model.size(); ++g) positions.push_back(now.position(model, g));
    return brute_force_pairs(now.cell, positions, model.reach(), within);
  }
  /// Overlap of a pair; where it is apart, less the distance.
  double overlap(const ListedPair& pair) const {
    const auto i = std::size_t(pair.i), j = std::size_t(pair.j);
    const Vector3 b = now.position(model, j) - now.position(model, i) +
                      now.cell.lattice * Vector3(pair.image[0], pair.image[1], pair.image[2]);
    const double *row_i = now.rows.data() + i * std::size_t(model.row_length()),
                 *row_j = now.rows.data() + j * std::size_t(model.row_length());
    using Ellipses = Outline<Shape::ellipse>;
    OutlinePlace place = Ellipses::place(Branch{b[0], b[1], 0}, row_i, row_j);
    if (place.overlap < 0) place = Ellipses::nearest_place(place, row_i, row_j);
    return place.overlap;
  }
};

}  // namespace

TEST_CASE("The outline of an ellipse moves by (a - b) |sin theta| where it turns by theta, and no more") {
  for (const double aspect : {0.1, 1. / 3, 0.743, 0.99})
    for (const double turn : {1e-3, 0.1, 0.7, 1.5, 2.5, 3.1, -0.4, -2.0}) {
      const double a = 2, b = a * aspect, bound = (a - b) * std::abs(std::sin(turn));
      double most = 0;
      for (int k = 0; k < 20'000; ++k) {
        const double at = 2 * pi * k / 20'000;
        most = std::max(most, std::abs(support(a, b, at - turn) - support(a, b, at)));
      }
      CAPTURE(aspect, turn);
      CHECK(most <= bound * (1 + 1e-12) + 1e-14);
      CHECK(most >= 0.6 * bound);
      if (turn == 1e-3) CHECK(most >= 0.999 * bound);
      for (const double before : {0.0, 1.0, pi / 2, 2.0, -1.2, 3.0}) {
        double row[12] = {};
        row[5] = std::cos(before + turn);
        row[6] = std::sin(before + turn);
        row[7] = a - b;
        const double noted = noted_axis({std::cos(before), std::sin(before), 0});
        CHECK(outline_moved_by_turn(noted, row) == Approx(bound).margin(1e-14));
        CHECK(outline_moved_by_turn(0, row) == a - b);  // not noted: as far as any turn could
      }
    }
}

TEST_CASE("No overlapping pair of needles is missing from the list while they are sheared, pressed and spin") {
  const Matrix3 flow = GENERATE(gradient(0, 0, 0, 0), gradient(0, 0.5, 0, 0), gradient(-0.15, 0.5, 0, -0.15));
  Opened opened(spinning_needles());
  const Model& f = opened.model;
  Assembly& a = opened.now;
  set_loading(f, a, Loading::at_rate);
  const double step = 2e-3;
  std::size_t touching = 0, missing = 0, turned = 0;
  for (int k = 0; k < 1000; ++k) {
    make_substeps(f, a, {split_increment(a.cell, step * flow), 1, step, Loading::at_rate});
    const std::set<ListedPair> listed = opened.listed();
    for (const ListedPair& pair : opened.candidates(0)) {
      if (!(opened.overlap(pair) > 0)) continue;
      ++touching;
      missing += listed.count(pair) == 0;
    }
  }
  for (std::size_t g = 0; g < f.size(); ++g) turned += std::abs(a.orientation(f, g)[1]) > 0.5;
  CAPTURE(flow, touching, turned, a.state.list.builds);
  CHECK(missing == 0);
  CHECK(touching > 300);
  CHECK(turned > f.size() / 4);     // what would not turn would need no care
  CHECK(a.state.list.builds > 10);  // and a list made at every step would be whole anyway
  CHECK(a.state.list.builds < 400);
}

TEST_CASE("Needles are listed where they are nearer than the skin, and seldom where they are not") {
  Opened opened(spinning_needles());
  const Model& f = opened.model;
  Assembly& a = opened.now;
  set_loading(f, a, Loading::at_rate);
  for (int k = 0; k < 5; ++k) {
    const Matrix3 flow = gradient(-0.15, 0.5, 0, -0.15);
    make_substeps(f, a, {split_increment(a.cell, 0.4 * flow), 200, 2e-3, Loading::at_rate});
    rebuild(f, a);
    const std::set<ListedPair> listed = opened.listed();
    std::size_t by_circles = 0, near = 0, missing = 0;
    for (const ListedPair& pair : opened.candidates(a.state.list.skin)) {
      const bool is_near = opened.overlap(pair) > -a.state.list.skin;
      ++by_circles;
      near += is_near;
      missing += is_near && listed.count(pair) == 0;
    }
    CAPTURE(k, by_circles, near, listed.size());
    CHECK(missing == 0);
    CHECK(double(listed.size()) < 1.5 * double(near) + 5);
    CHECK(2 * listed.size() < by_circles);
  }
}
