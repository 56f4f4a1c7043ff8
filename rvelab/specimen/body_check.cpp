#include "rvelab/specimen/body_check.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/specimen/solids.hpp"
#include "rvelab/superellipsoid/lanes.hpp"

namespace rvelab {

namespace {

class BodyCheck : CheckedSpecimen {
 public:
  explicit BodyCheck(const CheckedSpecimen& checked) : CheckedSpecimen(checked) {}
  void check() const {
    check_outlines();
    check_bodies();
  }

 private:
  /// Lengths and orientation where the grains are not round, and nowhere else.
  void check_outlines() const {
    const std::size_t n = s.grains.size();
    for (int number = 0; number < shape_count; ++number)
      with_shape(Shape(number), [&](auto is) {
        using By = typename decltype(is)::By;
        const bool own = s.shape == decltype(is)::value;
        if constexpr (!By::round) {
          each_column_of<By>(
              [&](const auto& described, const auto& column) {
                expect_rows<By>((std::string("grains/") + described.dataset).c_str(), column.size(), own ? n : 0);
              },
              s.grains);
          expect_rows<By>("grains/orientation", s.grains.orientation.size(), keeps_axis(s.shape) ? n : 0);
          for (std::size_t k = 0; own && k < n; ++k) check_outline<By>(k);
        }
      });
    const std::string plural = name(s.shape) + std::string("s");
    if (!is_round(s.shape) && s.contact.slip != Slip::consistent)
      refuse(std::string("contact/slip = \"") + name(s.contact.slip) + "\" is for round grains; allowed for " + plural +
             ": \"consistent\"");
    if (!has_hertz_curvature(s.shape) && s.contact.hertz_radius != HertzRadius::equivalent)
      refuse(std::string("contact/hertz_radius = \"") + name(s.contact.hertz_radius) + "\" is for " +
             names_of_shapes(has_hertz_curvature, true) + "; allowed for " + plural + ": \"equivalent\"");
  }

  template <class By>
  void expect_rows(const char* field, std::size_t found, std::size_t allowed) const {
    if (found != allowed)
      refuse(std::string(field) + " has " + std::to_string(found) +
             " rows; allowed: one for each grain where shape is " + By::name + ", else none");
  }

  template <class By>
  void check_outline(std::size_t k) const {
    const Grains& g = s.grains;
    const OwnValues own = own_of<By>(g, k);
    if (!By::allowed(own)) {
      std::string lengths;
      each_column_of<By>(
          [&](const auto& described, double value) {
            lengths += (lengths.empty() ? "grains/" : ", ") + at(described.dataset, k) + " = " + in_words(value);
          },
          own);
      refuse(lengths + " of grain " + std::to_string(g.id[k]) + "; allowed: " + By::allowed_lengths);
    }
    if (!(std::abs(g.radius[k] - By::radius(own)) <= 1e-9 * g.radius[k]))
      refuse(of_grain("grains/radius_m", k) + " = " + in_words(g.radius[k]) + "; that of its " + By::name + " is " +
             By::radius_in_words + ", " + in_words(By::radius(own)) + " m here");
    if constexpr (By::rigid) return;
    const double length = g.orientation[k].norm();
    if (!(std::abs(length - 1) <= 1e-9))
      refuse(of_grain("grains/orientation", k) + " has the length " + digits_of(length) +
             "; allowed: 1, a direction in the plane");
  }

  /// Bodies (clumps): each grain in one of them, of one material, where its offset says.
  void check_bodies() const {
    const std::size_t n = s.grains.size();
    if (s.members.size() != (s.bodies.empty() ? 0 : n))
      refuse("members has " + std::to_string(s.members.size()) +
             " rows; allowed: one for each grain where there are bodies, else none");
    if (moves_as_body(s.shape) && s.bodies.size() != n)
      refuse("bodies has " + std::to_string(s.bodies.size()) + " rows; allowed: " + std::to_string(n) +
             ", one for each grain where shape is " + name(s.shape));
    if (s.bodies.empty()) return;
    if (keeps_axis(s.shape))
      refuse(std::string("bodies of ") + name(s.shape) + "s; allowed: of discs, spheres or superellipsoids");
    if (has_any(s))
      advise(
          "bodies beside bonds, bridges or adhesion: interactions other than contacts do not act on clumps or "
          "superellipsoids yet; take "
          "grains that move by themselves, or leave the interactions out");
    if (s.contact.slip != Slip::consistent)
      refuse(std::string("contact/slip = \"") + name(s.contact.slip) + "\" with bodies; allowed: \"consistent\"");
    if (!s.state.memory_order.empty()) advise("state/memory_order with bodies; leave it empty");
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      const Body& body = s.bodies[b];
      const auto first = std::size_t(body.first);
      if (b > 0 && body.id <= s.bodies[b - 1].id)
        advise(at("bodies/id", b) + " follows " + std::to_string(s.bodies[b - 1].id) +
               "; ids must ascend, each once: sort the bodies by id, and the grains with them");
      if (b == 0 ? first != 0 : (first <= std::size_t(s.bodies[b - 1].first) || first >= n))
        refuse(at("bodies/first", b) + " = " + std::to_string(body.first) +
               "; allowed: 0 for the first body, then ascending rows of grains");
      const Turn& q = body.orientation;
      const double length = std::sqrt(q.w * q.w + q.v.squaredNorm());
      if (!(std::abs(length - 1) <= 1e-9) || (s.cell.dimension == 2 && (q.v[0] != 0 || q.v[1] != 0)))
        refuse(at("bodies/orientation", b) + " has the length " + digits_of(length) +
               "; allowed: a quaternion of length 1, scalar first, in 2D about z");
      const std::size_t last = b + 1 < s.bodies.size() ? std::size_t(s.bodies[b + 1].first) : n;
      for (std::size_t g = first; g < std::min(last, n); ++g) check_member(body, first, g);
      if (moves_as_body(s.shape)) check_solid(b);
    }
  }
  /// A body of one grain has the volume and the inertia of that.
  void check_solid(std::size_t b) const {
    const Body& body = s.bodies[b];
    const Body right = body_of_solid(s.grains, b);
    if (!s.members[b].offset.isZero(0))
      refuse(at("members/offset_m", b) + " is not 0; allowed: 0 where shape is " + name(s.shape));
    if (!(std::abs(body.volume - right.volume) <= 1e-9 * right.volume))
      refuse(at("bodies/volume_m3", b) + " = " + in_words(body.volume) + "; that of its grain is " +
             in_words(right.volume) + " m^3");
    if (!((body.gyration - right.gyration).norm() <= 1e-9 * right.gyration.norm()))
      refuse(at("bodies/gyration_m2", b) + " is not that of its grain, " + in_words(right.gyration[0]) + " " +
             in_words(right.gyration[1]) + " " + in_words(right.gyration[2]) + " m^2");
  }
  void check_member(const Body& body, std::size_t first, std::size_t g) const {
    if (s.grains.material[g] != s.grains.material[first])
      refuse(of_grain("grains/material", g) + " differs from that of the first member of body " +
             std::to_string(body.id) + "; allowed: one material in a body");
    const Vector3 from = s.grains.position[g] - body.position - axes_of(body.orientation) * s.members[g].offset;
    Vector3 periods = s.cell.lattice.triangularView<Eigen::Upper>().solve(from);
    for (int k = 0; k < 3; ++k) periods[k] -= std::floor(periods[k] + 0.5);
    if (s.cell.dimension == 2) periods[2] = 0;
    const double off = (s.cell.lattice * periods).norm();
    if (!(off <= 1e-6 * s.grains.radius[g]))
      advise(of_grain("grains/position_m", g) + " is " + in_words(off) + " m from where members/offset_m[" +
             std::to_string(g) + "] puts it in body " + std::to_string(body.id) +
             "; give position = body position + axes offset, up to lattice vectors");
  }
};

}  // namespace

void check_bodies(const CheckedSpecimen& checked) { BodyCheck(checked).check(); }

Vector3 normal_of_solids(const Specimen& s, const Contact& c, const std::vector<double>& rolling) {
  const auto i = std::size_t(c.i), j = std::size_t(c.j);
  const auto form = [&](std::size_t g) {
    SuperellipsoidForm<double> plain = plain_form_of(superellipsoid_of(s.grains, g));
    plain.rolling = rolling[g];
    return plain;
  };
  const auto axes = [&](std::size_t g) -> SuperellipsoidAxes<double> {
    const Matrix3 m = axes_of(s.bodies[g].orientation);
    return {{m(0, 0), m(1, 0), m(2, 0)}, {m(0, 1), m(1, 1), m(2, 1)}, {m(0, 2), m(1, 2), m(2, 2)}};
  };
  const Vector3 b = s.grains.position[j] + translation(s.cell, c.image) - s.grains.position[i];
  Triple<double> guess = {0, 0, 0};
  const ContactsOf<double> at =
      contacts_of(SuperellipsoidPair<double>{form(i), form(j), axes(i), axes(j), {b.x(), b.y(), b.z()}}, guess);
  return at.overlap > 0 ? Vector3(at.n.x, at.n.y, at.n.z) : Vector3(Vector3::Zero());
}

}  // namespace rvelab
