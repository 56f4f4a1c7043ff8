// Networks for the tests of measures: YADE's recorded packings from tests/data, crystals, and one free contact.
#pragma once

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rvelab/solver/assembly/network.hpp"

namespace rvelab::test {

/// Largest difference of two matrices over the largest entry of the second.
inline double relative_distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

using Row = std::map<std::string, double>;

inline nlohmann::json read_json(const std::string& name) {
  std::ifstream file(std::string(RVELAB_TEST_DATA) + "/yade/" + name);
  if (!file) throw std::runtime_error("missing test data " + name);
  return nlohmann::json::parse(file);
}

/// Rows of a CSV file by column name; lines that start with # are comments.
inline std::vector<Row> read_table(const std::string& name) {
  std::ifstream file(std::string(RVELAB_TEST_DATA) + "/yade/" + name);
  if (!file) throw std::runtime_error("missing test data " + name);
  std::vector<std::string> header;
  std::vector<Row> rows;
  for (std::string line, cell; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    for (std::istringstream stream(line); std::getline(stream, cell, ',');) cells.push_back(cell);
    if (header.empty()) {
      header = cells;
      continue;
    }
    Row row;
    for (std::size_t k = 0; k < header.size(); ++k) row[header[k]] = std::stod(cells.at(k));
    rows.push_back(row);
  }
  return rows;
}

/// A contact of the grains i and j of the network: branch, normal and overlap from the positions, forces still zero.
inline ContactState touching(const Network& network, int i, int j, const Image& image) {
  ContactState contact;
  contact.i = i;
  contact.j = j;
  contact.image = image;
  const Vector3 shift = network.cell.lattice * Vector3(image[0], image[1], image[2]);
  contact.branch = network.grains[j].position + shift - network.grains[i].position;
  contact.length = contact.branch.norm();
  contact.normal = contact.branch / contact.length;
  contact.overlap = network.grains[i].radius + network.grains[j].radius - contact.length;
  contact.tangential_force.setZero();
  contact.rolling_moment.setZero();
  return contact;
}

inline GrainState grain_at(const Vector3& position, double radius) {
  GrainState grain;
  grain.radius = radius;
  grain.position = position;
  grain.velocity = grain.spin = grain.resultant = Vector3::Zero();
  return grain;
}

/// A recorded packing as a network: recorded forces and stiffnesses, overlaps from the positions.
inline Network yade_network(const std::string& name) {
  const nlohmann::json meta = read_json(name + ".json");
  const int dimension = meta.at("dim");
  const bool linear = dimension == 2;
  Network network;
  network.shape = linear ? Shape::disc : Shape::sphere;
  network.cell.dimension = dimension;
  for (int row = 0; row < dimension; ++row) {
    for (int column = 0; column < dimension; ++column) {
      network.cell.lattice(row, column) = meta.at("hSize_columns_are_cell_vectors")[row][column];
    }
  }
  if (linear) network.cell.lattice(2, 2) = meta.at("thickness_m");
  network.model.law = linear ? Law::linear : Law::hertz_mindlin;
  network.model.slip = Slip::full_radius_ratcheting;
  network.model.unload_rescale = false;
  network.model.rolling = linear && meta.at("beta").get<double>() > 0;
  const double thickness = network.cell.lattice(2, 2), density = meta.at("density");
  const double friction =
      linear ? std::tan(meta.at("phi_deg").get<double>() * std::acos(-1.0) / 180) : meta.at("mu").get<double>();
  for (const Row& row : read_table(name + ".particles.csv")) {
    GrainState grain = grain_at({row.at("x"), row.at("y"), linear ? 0.0 : row.at("z")}, row.at("r"));
    grain.mass = density * grain_volume(network.shape, grain.radius, thickness);
    grain.inertia = moment_of_inertia(network.shape, grain.mass, grain.radius);
    network.grains.push_back(grain);
  }
  for (const Row& row : read_table(name + ".contacts.csv")) {
    const Image image{static_cast<int>(row.at("sx")), static_cast<int>(row.at("sy")),
                      linear ? 0 : static_cast<int>(row.at("sz"))};
    ContactState contact = touching(network, static_cast<int>(row.at("id1")), static_cast<int>(row.at("id2")), image);
    contact.normal_force = row.at("fn");
    contact.tangential_force = {row.at("fsx"), row.at("fsy"), linear ? 0.0 : row.at("fsz")};
    contact.friction = friction;
    const double root = std::sqrt(contact.overlap);
    contact.normal_stiffness = linear ? row.at("kn") : 1.5 * row.at("kno") * root;
    contact.tangential_stiffness = linear ? row.at("ks") : row.at("kso") * root;
    if (network.model.rolling) {
      contact.rolling_moment.z() = row.at("mz");
      contact.rolling_stiffness = row.at("kr");
    }
    network.grains[contact.i].resultant -= contact.force();
    network.grains[contact.j].resultant += contact.force();
    network.contacts.push_back(contact);
  }
  return network;
}

/// The recorded stress, Pa.
inline Matrix3 recorded_stress(const std::string& name) {
  const nlohmann::json rows = read_json(name + ".json").at("stress_tension_positive_Pa");
  Matrix3 stress = Matrix3::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) stress(i, j) = rows[i][j];
  }
  return stress;
}

inline Eigen::MatrixXd matrix_of(const nlohmann::json& rows) {
  Eigen::MatrixXd matrix(rows.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j) matrix(i, j) = rows[i][j];
  }
  return matrix;
}

}  // namespace rvelab::test
