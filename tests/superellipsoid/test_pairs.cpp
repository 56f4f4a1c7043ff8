// Overlaps of superellipsoids against answers by other ways: a table (tests/data/superellipsoid/pairs.csv, by brute
// force with another code), spheres, pairs whose answer is known, and what the definition says of forces.
#include <fstream>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/superellipsoid/random_pairs.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// The rows below the line of names.
std::vector<std::vector<double>> rows_of(const std::string& path) {
  std::ifstream input(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(input, line);
  while (std::getline(input, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return rows;
}

double overlap_along(const OverlapPair& pair, const Vector& n) { return overlap_at(pair, n).overlap; }

/// The second grain moved and turned about its centre.
OverlapPair moved(OverlapPair pair, const Vector& by, const Axes& turn) {
  pair.branch = plus(pair.branch, 1.0, by);
  pair.axes_j = rotated(turn, pair.axes_j);
  return pair;
}

}  // namespace

TEST_CASE("overlaps and normals are those of the table by brute force") {
  const auto rows = rows_of(std::string(RVELAB_TEST_DATA) + "/superellipsoid/pairs.csv");
  REQUIRE(rows.size() == 150);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CAPTURE(k);
    const auto& r = rows[k];
    REQUIRE(r.size() == 26);
    const OverlapPair pair = {form_of({r[0], r[1], r[2], r[3], r[4]}),
                              form_of({r[9], r[10], r[11], r[12], r[13]}),
                              axes_of({r[5], r[6], r[7], r[8]}),
                              axes_of({r[14], r[15], r[16], r[17]}),
                              {r[18], r[19], r[20]}};
    const SuperellipsoidContact contact = contact_of(pair);
    CHECK(std::abs(contact.overlap + r[21]) < 1e-10);
    CHECK(length_of(difference(contact.n, {r[22], r[23], r[24]})) < 2e-7);  // its search ends there
  }
}

TEST_CASE("with exponents of 2 and equal half axes two spheres touch") {
  Draw draw;
  for (int k = 0; k < 200; ++k) {
    const double ri = draw.between(0.2, 1), rj = draw.between(0.2, 1), apart = draw.between(0.3, 1.2) * (ri + rj);
    const Vector line = draw.direction();
    const OverlapPair pair = {form_of({ri, ri, ri, 2, 2}), form_of({rj, rj, rj, 2, 2}), draw.axes(), draw.axes(),
                              times(apart, line)};
    const SuperellipsoidContact contact = contact_of(pair);
    CHECK(contact.overlap == Approx(ri + rj - apart).margin(1e-14));
    CHECK(length_of(difference(contact.n, line)) < 1e-14);
    CHECK(length_of(difference(contact.point, times(0.5 * (apart + ri - rj), line))) < 1e-14);
  }
}

TEST_CASE("pairs laid in contact have that contact: any direction, faces, edges, tips, aspects to 1:10") {
  Draw draw;
  for (int k = 0; k < 12000; ++k) {
    CAPTURE(k);
    const double exponent = k % 4 == 0 ? 20 : 8;
    const KnownPair known = known_pair(draw, draw.shape(exponent, 10), draw.shape(exponent, 10), k % 3, 0.05);
    const SuperellipsoidContact contact = contact_of(known.pair);
    const double off = contact.overlap - known.depth;
    if (!(off < 1e-12)) CHECK(off < 1e-12);
    if (known.depth <= known.rolling && !(off > -1e-12)) CHECK(off > -1e-12);
  }
}

TEST_CASE("deep overlaps are the least over all directions, one body inside the other too") {
  Draw draw;
  std::vector<Vector> grid;
  for (int k = 0; k < 3000; ++k) grid.push_back(draw.direction());
  for (int k = 0; k < 150; ++k) {
    CAPTURE(k);
    const KnownPair known = known_pair(draw, draw.shape(8, 5), draw.shape(8, 5), k % 3, 3);
    OverlapPair pair = known.pair;
    if (k % 10 == 0) pair.branch = times(1e-3, pair.branch);
    if (k == 50) pair.branch = {0, 0, 0};
    const double overlap = contact_of(pair).overlap;
    double least = k % 10 == 0 ? 1e300 : known.depth;
    for (const Vector& n : grid) least = std::min(least, overlap_along(pair, n));
    CHECK(overlap <= least + 1e-9);
    CHECK(overlap > 0);
  }
}

TEST_CASE("boxes on boxes touch along their common axis, however little they are tilted") {
  Draw draw;
  for (const double tilt : {0.0, 1e-15, 1e-12, 1e-9, 1e-5, 1e-2}) {
    for (const double exponent : {2.0, 4.0, 8.0, 20.0}) {
      CAPTURE(tilt, exponent);
      const OverlapPair pair = {form_of({1, 0.5, 0.5, exponent, exponent}),
                                form_of({0.5, 0.7, 0.3, exponent, exponent}),
                                own_axes,
                                rotation(of_length_1(Vector{1, 2, 0}), tilt),
                                {0, 0, 0.79}};
      const SuperellipsoidContact contact = contact_of(pair);
      double least = overlap_along(pair, {0, 0, 1});
      for (int k = 0; k < 2000; ++k) {
        const Vector near = plus(Vector{0, 0, 1}, std::pow(10, -draw.between(0, 14)), draw.direction());
        least = std::min(least, overlap_along(pair, of_length_1(near)));
      }
      CHECK(contact.overlap <= least + 1e-14);
      CHECK(contact.overlap > 0.5 * (0.8 - 0.79));
      CHECK(contact.n.z > std::cos(2e-2));
      CHECK(length_of(contact.point) < 1.2);
    }
  }
}

TEST_CASE("a force along n has an energy: the overlap falls with the second grain along n, and turns by its arm") {
  Draw draw;
  for (int k = 0; k < 60; ++k) {
    CAPTURE(k);
    const KnownPair known = known_pair(draw, draw.shape(5, 3), draw.shape(5, 3), 0, 0.05);
    const SuperellipsoidContact contact = contact_of(known.pair);
    constexpr double step = 1e-6;
    const Vector way = draw.direction(), axis = draw.direction();
    const auto slope = [&](const auto& forth, const auto& back) {
      return (contact_of(forth).overlap - contact_of(back).overlap) / (2 * step);
    };
    CHECK(slope(moved(known.pair, times(step, way), own_axes), moved(known.pair, times(-step, way), own_axes)) ==
          Approx(-dot(contact.n, way)).margin(1e-7));
    const Vector arm = difference(contact.point, known.pair.branch);
    CHECK(slope(moved(known.pair, {0, 0, 0}, rotation(axis, step)),
                moved(known.pair, {0, 0, 0}, rotation(axis, -step))) ==
          Approx(-dot(axis, cross(arm, contact.n))).margin(1e-7));
  }
}

TEST_CASE("a rotation of both grains turns the normal and the point and leaves the overlap") {
  Draw draw;
  for (int k = 0; k < 60; ++k) {
    const KnownPair known = known_pair(draw, draw.shape(6, 4), draw.shape(6, 4), k % 2, 0.05);
    const Axes turn = draw.axes();
    const OverlapPair turned = {known.pair.form_i, known.pair.form_j, rotated(turn, known.pair.axes_i),
                                rotated(turn, known.pair.axes_j), rotated(turn, known.pair.branch)};
    const SuperellipsoidContact before = contact_of(known.pair), after = contact_of(turned);
    CHECK(after.overlap == Approx(before.overlap).margin(1e-14));
    CHECK(length_of(difference(after.n, rotated(turn, before.n))) < 1e-7);
    CHECK(length_of(difference(after.point, rotated(turn, before.point))) < 1e-6);
  }
}
