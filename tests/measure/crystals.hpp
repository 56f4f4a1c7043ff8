// Crystals and small clusters as networks, forces and stiffnesses of the linear law f = kn delta.
#pragma once

#include <cmath>
#include <vector>

#include "tests/measure/reference_network.hpp"

namespace rvelab::test {

struct Springs {
  double kn = 1, kt = 0, kr = 0;
};

inline void load(ContactState& contact, const Springs& springs) {
  contact.normal_force = springs.kn * contact.overlap;
  contact.normal_stiffness = springs.kn;
  contact.tangential_stiffness = springs.kt;
  contact.rolling_stiffness = springs.kr;
  contact.friction = 1e6;
  contact.elastic_energy = 0.5 * springs.kn * contact.overlap * contact.overlap;
}

/// All touching pairs of the network, each once, found by looking at the nearest images (cell heights must be above
/// half a diameter for grains of one size).
inline void find_contacts(Network& network, const Springs& springs) {
  network.contacts.clear();
  const int grains = static_cast<int>(network.grains.size()), depth = network.dimension() == 3 ? 2 : 0;
  for (int i = 0; i < grains; ++i) {
    for (int j = i; j < grains; ++j) {
      for (int x = -2; x <= 2; ++x) {
        for (int y = -2; y <= 2; ++y) {
          for (int z = -depth; z <= depth; ++z) {
            if (i == j && !(x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0))))) continue;
            ContactState contact = touching(network, i, j, {x, y, z});
            if (contact.overlap <= 0) continue;
            load(contact, springs);
            network.contacts.push_back(contact);
          }
        }
      }
    }
  }
}

/// A Bravais lattice of spheres or discs of the given diameter, `repeat` primitive cells along each cell vector.
/// 2D: thickness 1. Cell vectors in the columns of `primitive` (upper triangular).
inline Network bravais(int dimension, const Matrix3& primitive, double diameter, int repeat, const Springs& springs) {
  Network network;
  network.shape = dimension == 2 ? Shape::disc : Shape::sphere;
  network.cell.dimension = dimension;
  network.cell.lattice = repeat * primitive;
  if (dimension == 2) network.cell.lattice(2, 2) = 1;
  network.model.law = Law::linear_stiffness;
  const int layers = dimension == 3 ? repeat : 1;
  for (int x = 0; x < repeat; ++x) {
    for (int y = 0; y < repeat; ++y) {
      for (int z = 0; z < layers; ++z) {
        const Vector3 at = primitive * Vector3(x, y, z);
        network.grains.push_back(grain_at(dimension == 2 ? Vector3(at.x(), at.y(), 0) : at, 0.5 * diameter));
      }
    }
  }
  find_contacts(network, springs);
  return network;
}

/// Triangular lattice of discs at spacing l, one row along x.
inline Network triangular(double diameter, double spacing, int repeat, const Springs& springs) {
  Matrix3 primitive = Matrix3::Identity();
  primitive(0, 0) = spacing;
  primitive(0, 1) = 0.5 * spacing;
  primitive(1, 1) = std::sqrt(0.75) * spacing;
  return bravais(2, primitive, diameter, repeat, springs);
}

/// Square lattice of discs, rows along x and y.
inline Network square(double diameter, double spacing, int repeat, const Springs& springs) {
  return bravais(2, spacing * Matrix3::Identity(), diameter, repeat, springs);
}

/// Face-centred cubic lattice of spheres, nearest neighbours at `spacing`, cube axes not along the cell's.
inline Network face_centred(double diameter, double spacing, int repeat, const Springs& springs) {
  Matrix3 primitive = Matrix3::Zero();
  primitive.col(0) = spacing * Vector3(1, 0, 0);
  primitive.col(1) = spacing * Vector3(0.5, std::sqrt(0.75), 0);
  primitive.col(2) = spacing * Vector3(0.5, std::sqrt(1.0 / 12), std::sqrt(2.0 / 3));
  return bravais(3, primitive, diameter, repeat, springs);
}

}  // namespace rvelab::test
