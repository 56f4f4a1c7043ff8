#include "rvelab/specimen/solids.hpp"

namespace rvelab {

std::vector<double> rolling_radii_of(const Grains& grains) {
  std::vector<double> radii;
  radii.reserve(grains.size());
  Superellipsoid last{};
  double last_rolling = 0;  // of a half axis c of 1
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const Superellipsoid s = superellipsoid_of(grains, g), unit = {s.a / s.c, s.b / s.c, 1, s.e, s.n};
    if (unit.a != last.a || unit.b != last.b || unit.e != last.e || unit.n != last.n) {
      last = unit;
      last_rolling = rolling_radius_of(unit);
    }
    radii.push_back(s.c * last_rolling);
  }
  return radii;
}

Body body_of_solid(const Grains& grains, std::size_t g) {
  const Superellipsoid shape = superellipsoid_of(grains, g);
  const PrincipalInertia inertia = inertia_of(shape);
  Body body;
  body.volume = volume_of(shape);
  body.gyration = Vector3(inertia.x, inertia.y, inertia.z) / body.volume;
  return body;
}

void add_superellipsoid(Specimen& s, const Superellipsoid& shape, const Vector3& position, const Turn& orientation,
                        std::int32_t material) {
  Grains& g = s.grains;
  g.id.push_back(g.id.empty() ? 0 : g.id.back() + 1);
  g.radius.push_back(equivalent_radius_of(shape));
  g.material.push_back(material);
  g.position.push_back(position);
  g.velocity.push_back(Vector3::Zero());
  g.spin.push_back(Vector3::Zero());
  g.half_x.push_back(shape.a);
  g.half_y.push_back(shape.b);
  g.half_z.push_back(shape.c);
  g.exponent_xy.push_back(shape.e);
  g.exponent_z.push_back(shape.n);
  Body body = body_of_solid(g, g.size() - 1);
  body.id = g.id.back();
  body.first = std::int32_t(g.size() - 1);
  body.position = position;
  body.orientation = orientation;
  s.bodies.push_back(body);
  s.members.push_back({});
}

}  // namespace rvelab
