// A clump for the surface of a grain: what an STL file says, and how near spheres come to it. Volumes, centres and
// moments of polyhedra are those of the formulas.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

#include "rvelab/grains/clump.hpp"
#include "rvelab/grains/filling.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Eigen::Vector3d;

namespace {

using Triangles = std::vector<std::array<Vector3d, 3>>;

/// A box from 0 to these sides, two triangles a face.
Triangles box(const Vector3d& sides) {
  Triangles all;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto at = [&](bool a, bool b) {
        Vector3d x = Vector3d::Zero();
        x[axis] = upper ? sides[axis] : 0;
        x[u] = a ? sides[u] : 0;
        x[v] = b ? sides[v] : 0;
        return x;
      };
      std::array<Vector3d, 3> one{at(false, false), at(true, false), at(true, true)},
          two{at(false, false), at(true, true), at(false, true)};
      if (!upper) std::swap(one[1], one[2]), std::swap(two[1], two[2]);
      all.push_back(one);
      all.push_back(two);
    }
  return all;
}

/// A sphere of radius 1 from an octahedron whose triangles were quartered `times` times, then stretched.
Triangles ellipsoid(int times, const Vector3d& axes) {
  Triangles all;
  for (int signs = 0; signs < 8; ++signs) {
    const Vector3d x(signs & 1 ? -1 : 1, 0, 0), y(0, signs & 2 ? -1 : 1, 0), z(0, 0, signs & 4 ? -1 : 1);
    const bool mirrored = x[0] * y[1] * z[2] < 0;
    all.push_back(mirrored ? std::array{x, z, y} : std::array{x, y, z});
  }
  for (int k = 0; k < times; ++k) {
    Triangles finer;
    for (const auto& [a, b, c] : all) {
      const Vector3d ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      for (const auto& t :
           {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
        finer.push_back(t);
    }
    all = finer;
  }
  for (auto& t : all)
    for (Vector3d& x : t) x = x.cwiseProduct(axes);
  return all;
}

std::string as_text(const Triangles& triangles) {
  std::ostringstream out;
  out.precision(17);
  out << "solid a facet of a grain\n";
  for (const auto& t : triangles) {
    out << "facet normal 0 0 0\n outer loop\n";
    for (const Vector3d& x : t) out << "  vertex " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
    out << " endloop\nendfacet\n";
  }
  out << "endsolid grain\n";
  return out.str();
}

std::string as_binary(const Triangles& triangles) {
  std::string bytes(84, '\0');
  bytes.replace(0, 5, "solid");  // some programs write this into the head of binary files
  const auto count = std::uint32_t(triangles.size());
  std::memcpy(bytes.data() + 80, &count, 4);
  for (const auto& t : triangles) {
    float values[12] = {};
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 3; ++k) values[3 + 3 * c + k] = float(t[std::size_t(c)][k]);
    char record[50] = {};
    std::memcpy(record, values, sizeof values);
    bytes.append(record, sizeof record);
  }
  return bytes;
}

std::string refusal_of_stl(const std::string& bytes) {
  return test::input_error([&] { read_stl(bytes, "grain.stl"); });
}

/// How far the spheres reach out of a box, at most.
double out_of_box(const Filling& filling, const Vector3d& sides) {
  double most = -1e300;
  for (const Ball& ball : filling.spheres)
    for (int k = 0; k < 3; ++k) most = std::max({most, ball.radius - ball.at[k], ball.at[k] + ball.radius - sides[k]});
  return most;
}

}  // namespace

TEST_CASE("A surface from STL has the volume, the centre and the moments of its body", "[grains]") {
  const Vector3d sides(3, 2, 1);
  for (const bool inside_out : {false, true}) {
    Triangles triangles = box(sides);
    if (inside_out)
      for (auto& t : triangles) std::swap(t[1], t[2]);
    for (const std::string& bytes : {as_text(triangles), as_binary(triangles)}) {
      const Mesh mesh = read_stl(bytes, "box.stl");
      CHECK(mesh.corners.size() == 8);
      CHECK(mesh.triangles.size() == 12);
      const MassProperties p = properties_of(mesh);
      CHECK(p.volume == Approx(6).epsilon(1e-12));
      CHECK((p.centre - sides / 2).norm() < 1e-12);
      const Vector3d squares = sides.cwiseProduct(sides);
      for (int k = 0; k < 3; ++k)
        CHECK(p.inertia(k, k) == Approx(0.5 * (squares.sum() - squares[k])).epsilon(1e-12));  // V/12 (b^2 + c^2)
      CHECK(std::abs(p.inertia(0, 1)) + std::abs(p.inertia(0, 2)) + std::abs(p.inertia(1, 2)) < 1e-12);
    }
  }
  const MassProperties ball = properties_of(read_stl(as_text(ellipsoid(5, {1, 1, 1})), "ball.stl"));
  CHECK(ball.volume == Approx(4.0 / 3 * M_PI).epsilon(2e-3));
}

TEST_CASE("The distance to a surface is that to its faces, edges and corners", "[grains]") {
  const Mesh cube = read_stl(as_text(box({1, 1, 1})), "cube.stl");
  CHECK(distance_to(cube, {0.5, 0.5, 0.4}, 10) == Approx(0.4));
  CHECK(distance_to(cube, {0.5, 0.5, 1.7}, 10) == Approx(0.7));
  CHECK(distance_to(cube, {0.5, 1.3, 1.4}, 10) == Approx(0.5));
  CHECK(distance_to(cube, {2, 2, 2}, 10) == Approx(std::sqrt(3.0)));
  CHECK(distance_to(cube, {2, 2, 2}, 0.5) == 0.5);
}

TEST_CASE("A sphere is filled by one sphere; an ellipsoid and a box the better the more there are", "[grains]") {
  const Filling ball = filled(read_stl(as_text(ellipsoid(5, {1, 1, 1})), "ball.stl"), 1);
  REQUIRE(ball.spheres.size() == 1);
  CHECK(ball.spheres[0].radius == Approx(1).epsilon(5e-3));
  CHECK(ball.spheres[0].at.norm() < 5e-3);
  CHECK(ball.largest_distance < 0.01);
  CHECK(ball.volume_ratio == Approx(1).epsilon(0.01));

  const Vector3d sides(3, 2, 1);
  const Mesh block = read_stl(as_text(box(sides)), "block.stl");
  const Mesh egg = read_stl(as_binary(ellipsoid(4, {2, 1, 0.8})), "egg.stl");
  for (const Mesh* mesh : {&block, &egg}) {
    double before = 1e300;
    Filling filling;
    for (const int members : {1, 5, 20, 60}) {
      INFO(members);
      filling = filled(*mesh, members);
      CHECK(int(filling.spheres.size()) <= members);
      CHECK(filling.largest_distance < before);
      CHECK(filling.mean_distance < filling.largest_distance);
      CHECK(filling.volume_ratio < 1 + 1e-9);                 // none reaches out
      CHECK_NOTHROW(clump_of("filled", filling.spheres, 3));  // they hang together
      if (mesh == &block) CHECK(out_of_box(filling, sides) < 1e-9);
      before = filling.largest_distance;
    }
    if (mesh == &block) continue;
    CHECK(filling.largest_distance < 0.1);
    CHECK(filling.volume_ratio > 0.93);
    CHECK(filling.inertia_ratio > 0.9);
    CHECK(filling.largest_inertia_ratio < 1.1);
  }
}

TEST_CASE("A surface that is no grain is refused with the remedy", "[grains]") {
  const Triangles cube = box({1, 1, 1});
  CHECK(refusal_of_stl("").find("export") != std::string::npos);
  CHECK(refusal_of_stl("solid x\nendsolid\n").find("four or more") != std::string::npos);
  CHECK(refusal_of_stl("P6 a picture").find("no STL") != std::string::npos);
  Triangles open = cube;
  open.pop_back();
  CHECK(refusal_of_stl(as_text(open)).find("not closed (3 of 33 edges belong to one triangle alone)") !=
        std::string::npos);
  Triangles turned = cube;
  std::swap(turned[0][1], turned[0][2]);
  CHECK(refusal_of_stl(as_binary(turned)).find("turned differently") != std::string::npos);
  Triangles wild = cube;
  wild[3][1][0] = std::nan("");
  CHECK(refusal_of_stl(as_binary(wild)).find("not finite") != std::string::npos);
  const std::string text = as_text(cube);
  std::string cut = text;
  cut.resize(cut.find("vertex", 300) + 10);
  CHECK(refusal_of_stl(cut).find("cut off") != std::string::npos);
  cut.resize(cut.find("facet", 300));
  CHECK(refusal_of_stl(cut).find("endsolid") != std::string::npos);
  // A facet of two corners, of four, a coordinate that is a word.
  for (const auto& [from, to, words] : {std::array{"vertex", "vortex", "facet 1 has 2 corners"},
                                        std::array{" endloop", "vertex 0 0 0\n", "more than three"},
                                        std::array{"vertex 0", "vertex x", "no three numbers"}}) {
    std::string damaged = text;
    damaged.replace(damaged.find(from), std::string(from).size(), to);
    CHECK(refusal_of_stl(damaged).find(words) != std::string::npos);
  }
  std::string short_one = as_binary(cube);
  short_one.resize(short_one.size() - 20);
  CHECK(refusal_of_stl(short_one) != "");
}
