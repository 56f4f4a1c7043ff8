// The overlap of two ellipses against looking everywhere, and against what is known of it.
#include <cstdlib>
#include <string>

#include "rvelab/error.hpp"
#include "rvelab/solver/kernels/configuration.hpp"
#include "tests/catch.hpp"
#include "tests/oracle/ellipse_pairs.hpp"
#include "tests/solver/instruction_set.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// Rows of the grains of some pairs, and the pairs as the kernels have them, in a cell of 4 m: every other one across
/// its sides.
struct ManyPairs {
  std::vector<double> rows, image_x, image_y;
  std::vector<std::int32_t> i, j;
  std::vector<std::uint8_t> shifted;

  explicit ManyPairs(const std::vector<EllipsePair<double>>& pairs) : shifted(pairs.size() / 8, 1) {
    const auto add = [this](double x, double y, const EllipseMatrix<double>& m) {
      const auto at = std::int32_t(rows.size());
      rows.insert(rows.end(), {x, y, 0, 0, 0, 0, 0, 0, m.xx, m.xy, m.yy, m.sharpest});
      return at;
    };
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      i.push_back(add(0, 0, pairs[k].i));
      j.push_back(add(pairs[k].x, pairs[k].y, pairs[k].j));
      image_x.push_back(double(k % 2));
      image_y.push_back(-double(k % 2));
    }
  }
  /// By the kernels of one instruction set; none if it cannot run here.
  std::vector<double> places(const std::string& instruction_set) const {
    const InstructionSet in_use(instruction_set);
    KernelConfiguration key;
    key.shape = Shape::ellipse;
    PlaceKernel find = nullptr;
    try {
      find = kernels_for(key).places;
    } catch (const InputError&) {
      return {};
    }
    PairArrays arrays;
    arrays.row_i = i.data();
    arrays.row_j = j.data();
    arrays.image[0] = image_x.data();
    arrays.image[1] = image_y.data();
    arrays.shifted = shifted.data();
    StepConstants constants;
    constants.lattice.xx = constants.lattice.yy = 4;
    std::vector<double> found(std::size_t(place_row_length) * i.size());
    find(constants, arrays, rows.data(), 0, long(i.size()), found.data());
    return found;
  }
};

struct Found {
  Direction<double> normal;
  EllipsePlace<double> gap;
};

Found found(const EllipsePair<double>& p) {
  const EllipsePlace<double> place = closest_place(p);
  return {place.n, place};
}

/// How far an overlap is from the true one, over the shorter long axis (1 m or more); where the two are apart only
/// that is asked for.
double error_of(double overlap, double truth) {
  if (truth < -2e-11) return overlap < 0 ? 0 : 1;
  return std::abs(overlap - truth);
}

}  // namespace

TEST_CASE("The overlap of two ellipses is the least of all directions", "[solver]") {
  EllipsePairs pairs(1);
  for (const Meeting meeting : meetings) {
    CAPTURE(int(meeting));
    double worst = 0;
    for (int k = 0; k < 300; ++k) {
      const EllipsePair<double> p = pairs.draw(meeting);
      worst = std::max(worst, error_of(found(p).gap.overlap, double(overlap_by_all_directions(p))));
    }
    CHECK(worst < 1e-13);
  }
}

TEST_CASE("The overlap of 24,000 pairs of ellipses is the least of 4096 directions refined", "[solver][slow]") {
  EllipsePairs pairs(2);
  for (const Meeting meeting : meetings) {
    CAPTURE(int(meeting));
    double worst = 0;
    for (int k = 0; k < 4000; ++k) {
      const EllipsePair<double> p = pairs.draw(meeting);
      worst = std::max(worst, error_of(found(p).gap.overlap, double(overlap_by_all_directions(p))));
    }
    CHECK(worst < 1e-10);
  }
}

// RVELAB_ELLIPSE_PAIRS asks for another number of pairs.
TEST_CASE("No pair of ellipses overlaps less in a direction that was not found", "[solver][slow]") {
  const char* asked = std::getenv("RVELAB_ELLIPSE_PAIRS");
  const long count = asked ? std::stol(asked) : 300000;
  EllipsePairs pairs(3);
  double worst = 0, longest = 0;
  for (long k = 0; k < count; ++k) {
    const EllipsePair<double> p = pairs.draw(meetings[std::size_t(k) % meetings.size()]);
    const Found f = found(p);
    // One direction with f < 0 shows that two are apart; what overlaps must be the least.
    if (f.gap.overlap >= 0) worst = std::max(worst, f.gap.overlap - overlap_by_few_directions(p));
    longest = std::max(longest, std::abs(f.normal.x * f.normal.x + f.normal.y * f.normal.y - 1));
    worst = std::max(worst, std::abs(f.gap.overlap - gap_by_definition(p, f.normal.x, f.normal.y)));
  }
  CHECK(worst < 1e-10);
  CHECK(longest < 1e-14);
}

TEST_CASE("Two ellipses see each other alike", "[solver]") {
  EllipsePairs pairs(4);
  for (int k = 0; k < 2000; ++k) {
    const EllipsePair<double> p = pairs.draw(meetings[std::size_t(k) % 2]);
    const EllipsePair<double> q = {-p.x, -p.y, p.j, p.i};
    const Found of_i = found(p), of_j = found(q);
    REQUIRE(of_i.gap.overlap == of_j.gap.overlap);
    REQUIRE(of_i.normal.x == -of_j.normal.x);
    REQUIRE(of_i.normal.y == -of_j.normal.y);
  }
}

TEST_CASE("Circles overlap by their radii less their distance, along the branch", "[solver]") {
  for (double angle = 0; angle < 6; angle += 0.37) {
    const TestEllipse i = {2, 2, angle}, j = {3, 3, 1};
    const EllipsePair<double> p = {4.5 * std::cos(angle), 4.5 * std::sin(angle), i.matrix(), j.matrix()};
    const Found f = found(p);
    CHECK(f.gap.overlap == Approx(0.5).margin(1e-14));
    CHECK(f.normal.x == Approx(std::cos(angle)).margin(1e-14));
    CHECK(f.normal.y == Approx(std::sin(angle)).margin(1e-14));
    CHECK(std::abs(f.gap.turned_i) < 1e-14);
    CHECK(f.gap.support_j == Approx(3).margin(1e-14));
  }
}

TEST_CASE("Tips that overlap by more than their curvatures slide off sideways", "[solver]") {
  const TestEllipse e = {3, 1, 0};
  const double flip = 2 * e.b * e.b / e.a;
  for (const double part : {0.1, 0.9, 0.999}) {
    const Found f = found(pair_at(e, e, 0, part * flip));
    CHECK(f.normal.x == Approx(1).margin(1e-9));
    CHECK(f.gap.overlap == Approx(part * flip));
  }
  for (const double part : {1.01, 1.5}) {
    const Found f = found(pair_at(e, e, 0, part * flip));
    CHECK(f.normal.x < 0.999);
    CHECK(f.gap.overlap < part * flip * 0.99999);
  }
}

TEST_CASE("The derivatives of the gap are those of the gap", "[solver]") {
  EllipsePairs pairs(5);
  for (int k = 0; k < 200; ++k) {
    const EllipsePair<double> p = pairs.draw(Meeting::anywhere);
    const double angle = 0.1 * k, step = 1e-5;
    const auto at = [&](double a) { return ellipse_gap(p, Direction<double>{std::cos(a), std::sin(a)}); };
    const EllipseGap<double> low = at(angle - step), here = at(angle), high = at(angle + step);
    CHECK(here.slope == Approx((high.overlap - low.overlap) / (2 * step)).margin(1e-6));
    CHECK(here.curvature == Approx((high.slope - low.slope) / (2 * step)).epsilon(1e-5).margin(1e-6));
    CHECK(here.third == Approx((high.curvature - low.curvature) / (2 * step)).epsilon(1e-4).margin(1e-3));
  }
}

TEST_CASE("Ellipses with one centre are told apart by the shortest way out", "[solver]") {
  const TestEllipse i = {2, 1, 0.3}, j = {1.5, 0.5, 0.3};
  const Found f = found({0, 0, i.matrix(), j.matrix()});
  CHECK(f.gap.overlap == Approx(1.5));
  CHECK(std::abs(-f.normal.x * std::sin(0.3) + f.normal.y * std::cos(0.3)) == Approx(1));
}

TEST_CASE("Places of many pairs of ellipses are those of each alone, whoever its neighbours", "[solver]") {
  EllipsePairs draws(7);
  std::vector<EllipsePair<double>> pairs;
  for (std::size_t k = 0; k < 1200; ++k) {
    pairs.push_back(draws.draw(meetings[(k + k / 8) % meetings.size()]));
    if (k % 100 == 37) pairs.back().x = std::nan("");
  }
  const ManyPairs many(pairs);
  std::size_t sets = 0;
  for (const std::string set : {"scalar", "baseline", "v3", "v4"}) {
    const std::vector<double> places = many.places(set);
    if (places.empty()) continue;
    ++sets;
    CAPTURE(set);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const double* const place = places.data() + place_row_length * k;
      if (std::isnan(pairs[k].x)) {
        REQUIRE(!(place[2] <= 0));
        continue;
      }
      EllipsePair<double> across = pairs[k];
      if (k % 2 == 1) across.x += 4, across.y -= 4;
      const Found alone = found(across);
      const double half_slope = 0.5 * alone.gap.slope;
      const double expected[] = {alone.normal.x,
                                 alone.normal.y,
                                 alone.gap.overlap,
                                 alone.gap.support_i,
                                 alone.gap.support_j,
                                 alone.gap.turned_i - half_slope,
                                 alone.gap.turned_j - half_slope};
      for (std::size_t c = 0; c < std::size(expected); ++c) REQUIRE(place[c] == expected[c]);
    }
  }
  CHECK(sets >= 2);
}

TEST_CASE("f has no slope at the normal of a shallow contact, at tips too", "[solver]") {
  EllipsePairs pairs(8);
  for (const Meeting meeting : meetings) {
    CAPTURE(int(meeting));
    double worst = 0;
    for (int k = 0; k < 20000; ++k) {
      const EllipsePair<double> p = pairs.draw(meeting);
      const Found f = found(p);
      if (f.gap.overlap < 0 || !is_shallow(p, f.gap.overlap)) continue;  // deep ones: f to 1e-13, f' to its root
      const EllipseGap<double> there = ellipse_gap(p, f.normal);
      worst = std::max(worst, std::abs(there.slope) / (there.support_i + there.support_j));
    }
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("Lanes of ellipses are those of one alone, bit for bit", "[solver]") {
  EllipsePairs pairs(6);
  for (int k = 0; k < 3000; ++k) {
    const EllipsePair<double> a = pairs.draw(meetings[std::size_t(k) % meetings.size()]);
    const EllipsePair<double> b = pairs.draw(meetings[std::size_t(k / 6) % meetings.size()]);
    const auto both = [](double x, double y) { return V2{x, y}; };
    const auto of = [&](const EllipseMatrix<double>& x, const EllipseMatrix<double>& y) {
      return EllipseMatrix<V2>{both(x.xx, y.xx), both(x.xy, y.xy), both(x.yy, y.yy), both(x.sharpest, y.sharpest)};
    };
    const EllipsePair<V2> p = {both(a.x, b.x), both(a.y, b.y), of(a.i, b.i), of(a.j, b.j)};
    const EllipsePlace<V2> g = closest_place(p);
    const Found alone[2] = {found(a), found(b)};
    for (int lane = 0; lane < 2; ++lane) {
      REQUIRE(g.n.x[lane] == alone[lane].normal.x);
      REQUIRE(g.n.y[lane] == alone[lane].normal.y);
      REQUIRE(g.overlap[lane] == alone[lane].gap.overlap);
      REQUIRE(g.turned_i[lane] == alone[lane].gap.turned_i);
    }
  }
}
