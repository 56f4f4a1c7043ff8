// Cells thinner than the reach of a contact: several images of one pair, a grain's own included, must be listed. A
// supercell, in which no pair needs more than one image, is the judge.
#include "tests/catch.hpp"
#include "tests/extreme/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// The same state in a cell of `copies` x `copies` (x `copies`) of the given one.
Specimen supercell(const Specimen& s, int copies) {
  const int d = s.cell.dimension, n = int(s.grains.size()), depth = d == 3 ? copies : 1;
  Specimen big = s;
  big.grains = {};
  big.contacts.clear();
  big.state = {};
  for (int k = 0; k < d; ++k) big.cell.lattice.col(k) *= copies;
  const auto index = [&](int g, const Image& at) { return ((at[2] * copies + at[1]) * copies + at[0]) * n + g; };
  const auto folded = [&](const Image& image, Image& period) {
    Image at{};
    for (int k = 0; k < d; ++k) {
      at[k] = ((image[k] % copies) + copies) % copies;
      period[k] = (image[k] - at[k]) / copies;
    }
    return at;
  };
  // Centre of the big cell over that of the copies, so that most grains need no wrapping; the solver does the rest.
  const Vector3 centre = 0.5 * (copies - 1) * s.cell.lattice * Vector3(1, 1, d == 3 ? 1 : 0);
  for (int c = 0; c < depth; ++c)
    for (int b = 0; b < copies; ++b)
      for (int a = 0; a < copies; ++a)
        for (int g = 0; g < n; ++g) {
          big.grains.id.push_back(std::int64_t(big.grains.id.size()));
          big.grains.radius.push_back(s.grains.radius[g]);
          big.grains.material.push_back(s.grains.material[g]);
          big.grains.position.push_back(s.grains.position[g] + translation(s.cell, {a, b, c}) - centre);
          big.grains.velocity.push_back(s.grains.velocity[g]);
          big.grains.spin.push_back(s.grains.spin[g]);
          for (const Contact& contact : s.contacts) {
            if (contact.i != g) continue;
            Contact copy = contact;
            copy.image = {};
            copy.i = index(g, {a, b, c});
            const Image to = {a + contact.image[0], b + contact.image[1], c + contact.image[2]};
            copy.j = index(contact.j, folded(to, copy.image));
            if (copy.j < copy.i) {
              std::swap(copy.i, copy.j);
              for (int& k : copy.image) k = -k;
              if (d == 3) copy.tangential_force = -copy.tangential_force;  // 2D: the component along t keeps its sign
            }
            big.contacts.push_back(copy);
          }
        }
  return big;
}

/// Pairs that touch in the cell with more than one image, or with their own.
int multiple_images(const Network& network) {
  int count = 0;
  for (std::size_t c = 0; c < network.contacts.size(); ++c) {
    const ContactState& contact = network.contacts[c];
    const bool again = c > 0 && network.contacts[c - 1].i == contact.i && network.contacts[c - 1].j == contact.j;
    if (again || contact.i == contact.j) ++count;
  }
  return count;
}

/// A jammed frictional specimen of few grains, with forces in its tangential springs, at rest.
Specimen thin(int dimension, int count) {
  const Material rough = material(stiffness, 0.5 * stiffness, 0.5);
  Specimen loose = gas(dimension, spread_radii(count, 0.2), dimension == 2 ? 0.4 : 0.25, 5, rough);
  loose.solver.min_height = 0.5;
  Rve rve(packed(loose, 2e4));
  rve.apply(entry(0, dimension - 1, 1e-3), 0);
  rve.relax(1e-13, 200'000);
  rve.zero_velocities();
  Specimen s = rve.specimen();
  s.state = {};
  s.solver.fixed_substeps = 100;
  return s;
}

}  // namespace

TEST_CASE("A cell two grains thin has the stress of its supercell", "[extreme]") {
  for (const int d : {2, 3}) {
    const Specimen small = thin(d, d == 2 ? 4 : 8), big = supercell(small, d == 2 ? 4 : 3);
    Rve few(small), many(big);
    CHECK(multiple_images(few.network()) > 0);
    CHECK(multiple_images(many.network()) == 0);
    CHECK(many.size() == few.size() * (d == 2 ? 16 : 27));
    const double p = mean_pressure(few.stress(), d);
    REQUIRE(p > 1e4);
    CHECK(largest(few.stress() - many.stress()) <= 1e-12 * p);
    // The first 0.02 % strain from rest (solver/README.md): 1e-10 of p.
    double worst = 0;
    for (int k = 0; k < 10; ++k) {
      const Matrix3 gradient = entry(0, d - 1, 1e-5) + entry(0, 0, 5e-6) + entry(d - 1, d - 1, -1e-5);
      const Response a = few.apply(gradient, 0), b = many.apply(gradient, 0);
      worst = std::max(worst, largest(a.stress - b.stress) / p);
      CHECK(a.report.cell_thin);
    }
    CHECK(worst <= 1e-10);
  }
}

TEST_CASE("A cell sheared far beyond its height, thin in every direction, has the stress of its grains", "[extreme]") {
  // Frictionless grains: the sum over images, from positions alone, is exact in whatever basis the solver has chosen.
  for (const int d : {2, 3}) {
    Specimen loose = gas(d, {1.0, 0.9}, 0.3, 9);
    loose.solver.min_height = 0.5;
    loose.solver.max_overlap_ratio = 0.9;  // so few grains cannot dodge one another
    Rve rve(packed(loose, 1e4));
    const double volume = rve.cell().volume();
    const Matrix3 gradient = entry(0, d - 1, 0.05) + entry(d - 1, 0, 0.02);
    for (int k = 0; k < 100; ++k) {
      rve.apply(gradient, 0);
      const Matrix3 expected = stress_by_hand(rve.specimen());
      REQUIRE(largest(rve.stress() - expected) <= 1e-10 * largest(expected));
    }
    const double expansion = std::pow((Matrix3::Identity() + gradient).determinant(), 100);
    CHECK(rve.cell().volume() == Approx(volume * expansion).epsilon(1e-11));
  }
}
