#include "rvelab/specimen/clumps.hpp"

namespace rvelab {

void add_clump(Specimen& s, const Clump& clump, double radius, const Vector3& position, const Turn& orientation,
               std::int32_t material) {
  Body body;
  body.id = s.bodies.empty() ? 0 : s.bodies.back().id + 1;
  body.first = std::int32_t(s.grains.size());
  body.position = position;
  body.orientation = orientation;
  body.volume = grain_volume(s.shape, radius, s.cell.lattice(2, 2));
  body.gyration = radius * radius * clump.gyration;
  s.bodies.push_back(body);
  const Matrix3 axes = axes_of(orientation);
  for (const Ball& member : clump.members) {
    s.members.push_back({radius * member.at});
    s.grains.id.push_back(s.grains.id.empty() ? 0 : s.grains.id.back() + 1);
    s.grains.radius.push_back(radius * member.radius);
    s.grains.material.push_back(material);
    s.grains.position.push_back(position + axes * s.members.back().offset);
    s.grains.velocity.push_back(Vector3::Zero());
    s.grains.spin.push_back(Vector3::Zero());
  }
}

Grains bodies_as_grains(const Specimen& s, const std::vector<double>& radius) {
  Grains grains;
  for (const Body& body : s.bodies) {
    grains.id.push_back(body.id);
    grains.material.push_back(s.grains.material[std::size_t(body.first)]);
    grains.position.push_back(body.position);
    grains.velocity.push_back(body.velocity);
    grains.spin.push_back(body.spin);
  }
  grains.radius = radius;
  return grains;
}

}  // namespace rvelab
