// Four spheres in a tilted cell, as other programs write them.
#pragma once

#include <Eigen/Geometry>
#include <iomanip>
#include <sstream>
#include <vector>

#include "tests/io/imported.hpp"

namespace rvelab::test {

struct PlacedSphere {
  Vector3 at;
  double radius;
};

/// Cell vectors as columns, upper triangular, within LAMMPS' tilts; its corner at `low`.
struct FourSpheres {
  Matrix3 cell = (Matrix3() << 1, 0.2, -0.3, 0, 1.25, 0.125, 0, 0, 0.75).finished();
  Vector3 low{-0.5, -0.625, -0.375};
  std::vector<PlacedSphere> grains{{{-0.31, 0.17, 0.02}, 0.21},
                                   {{0.13, 0.21, -0.11}, 0.27},
                                   {{0.37, -0.41, 0.3}, 0.1875},
                                   {{-0.2, -0.35, 0.1}, 0.3}};
};

inline std::string digits(double value) {
  std::ostringstream text;
  text << std::setprecision(17) << value;
  return text.str();
}
inline std::string digits(const Vector3& v) { return digits(v[0]) + " " + digits(v[1]) + " " + digits(v[2]); }

/// The bounds of a dump: the cuboid around the tilted box.
inline std::string bounds_of(const FourSpheres& four, const std::string& boundaries = "pp pp pp") {
  const double xy = four.cell(0, 1), xz = four.cell(0, 2), yz = four.cell(1, 2);
  const Vector3 high = four.low + four.cell.diagonal();
  return "ITEM: BOX BOUNDS xy xz yz " + boundaries + "\n" + digits(four.low[0] + std::min({0., xy, xz, xy + xz})) +
         " " + digits(high[0] + std::max({0., xy, xz, xy + xz})) + " " + digits(xy) + "\n" +
         digits(four.low[1] + std::min(0., yz)) + " " + digits(high[1] + std::max(0., yz)) + " " + digits(xz) + "\n" +
         digits(four.low[2]) + " " + digits(high[2]) + " " + digits(yz) + "\n";
}

inline std::string rows_of(const FourSpheres& four) {
  std::string rows;
  for (std::size_t k = 0; k < four.grains.size(); ++k)
    rows += std::to_string(k + 1) + " 1 " + digits(four.grains[k].at) + " " + digits(four.grains[k].radius) + "\n";
  return rows;
}

inline std::string frame_of(const FourSpheres& four, long timestep, const std::string& boundaries = "pp pp pp") {
  return "ITEM: TIMESTEP\n" + std::to_string(timestep) + "\nITEM: NUMBER OF ATOMS\n" +
         std::to_string(four.grains.size()) + "\n" + bounds_of(four, boundaries) +
         "ITEM: ATOMS id type x y z radius\n" + rows_of(four);
}

/// A data file; with `hint`, "Atoms # sphere".
inline std::string data_of(const FourSpheres& four, const std::string& hint = " # sphere") {
  const Vector3 high = four.low + four.cell.diagonal();
  std::string text = "LAMMPS data file via write_data, version 7 Jan 2022, timestep = 0\n\n" +
                     std::to_string(four.grains.size()) + " atoms\n1 atom types\n\n";
  for (int k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    text += digits(four.low[k]) + " " + digits(high[k]) + " " + axis + "lo " + axis + "hi\n";
  }
  text += digits({four.cell(0, 1), four.cell(0, 2), four.cell(1, 2)}) + " xy xz yz\n\nAtoms" + hint + "\n\n";
  std::string velocities = "\nVelocities\n\n";
  for (std::size_t k = 0; k < four.grains.size(); ++k) {
    text += std::to_string(k + 1) + " 1 " + digits(2 * four.grains[k].radius) + " 2650 " + digits(four.grains[k].at) +
            " 0 -1 2\n";
    velocities += std::to_string(k + 1) + " 0 0 0 0 0 0\n";
  }
  return text + velocities;
}

/// What import makes of a text, and what it tells.
struct Read {
  std::vector<std::string> told;
  Specimen specimen;
  std::string error;
};

inline Read read_as(const std::string& text, io::ImportOptions options = {}, const std::string& name = "in.txt") {
  Read read;
  const Folder folder;
  write_bytes(folder / name, text);
  write_bytes(folder / "m.toml", sand);
  if (!options.material_path) options.material_path = folder / "m.toml";
  options.tell = [&](const std::string& said) { read.told.push_back(said); };
  read.error = input_error([&] { read.specimen = io::import_csv(folder / name, std::nullopt, std::nullopt, options); });
  return read;
}

inline std::string said(const Read& read) {
  std::string all;
  for (const auto& line : read.told) all += line + "\n";
  return all;
}

/// The grains to the last digit, the cell to round-off; positions are those of any image.
inline void expect_four_spheres(const Read& read, const FourSpheres& four = {}, double accuracy = 0) {
  INFO(read.error);
  const Specimen& s = read.specimen;
  REQUIRE(s.grains.size() == four.grains.size());
  CHECK(s.cell.dimension == 3);
  CHECK((s.cell.lattice - four.cell).cwiseAbs().maxCoeff() <= 4e-16);
  for (std::size_t k = 0; k < four.grains.size(); ++k) {
    CHECK(s.grains.id[k] == std::int64_t(k + 1));
    CHECK(std::abs(s.grains.radius[k] - four.grains[k].radius) <= accuracy * four.grains[k].radius);
    const Vector3 images = four.cell.inverse() * (s.grains.position[k] - four.grains[k].at);
    const Vector3 moved = four.cell * images.array().round().matrix();
    CHECK((s.grains.position[k] - four.grains[k].at - moved).norm() <= 3e-16 + accuracy);
  }
}

}  // namespace rvelab::test
