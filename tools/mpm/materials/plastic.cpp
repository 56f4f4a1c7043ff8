#include "tools/mpm/materials/plastic.hpp"

#include "rvelab/io/hdf5/file.hpp"

namespace mpm {
namespace {

constexpr double radians = 0.017453292519943295;

Strength read_strength(Keys& keys) {
  Strength strength;
  const auto law = keys.choice("hardening", {"none", "linear", "cubic_exponential"});
  strength.cohesion = keys.number("cohesion_Pa", 0, 0);
  strength.dilatancy = keys.number("dilatancy_angle_deg", 0, 0, 60) * radians;
  if (law == "cubic_exponential") {
    strength.law = Strength::Law::cubic_exponential;
    const auto cubic = keys.numbers("cubic_rad", 4);
    strength.a = cubic[0];
    strength.b = cubic[1];
    strength.c = cubic[2];
    strength.d = cubic[3];
    strength.peak_strain = keys.positive("peak_plastic_strain");
    strength.decay = keys.number("decay");
    if (!(strength.decay >= 0)) keys.wrong("decay", "must not be negative: the angle falls to the residual one");
    strength.peak = keys.number("peak_friction_angle_deg", 30, 0, 89) * radians;
    strength.residual = keys.number("residual_friction_angle_deg", 30, 0, 89) * radians;
    return strength;
  }
  strength.friction = keys.number("friction_angle_deg", 30, 0, 89) * radians;
  if (law == "linear") {
    strength.law = Strength::Law::linear;
    strength.friction_slope = keys.number("friction_slope_deg", 0) * radians;
    strength.cohesion_slope = keys.number("cohesion_slope_Pa", 0);
  }
  return strength;
}

}  // namespace

Continuum read_mohr_coulomb(Keys& keys) {
  const auto moduli = read_moduli(keys);
  return continuum_of<Plastic>(moduli.wave(), moduli, read_strength(keys), YieldSurface::mohr_coulomb, Cone::outer);
}

Continuum read_drucker_prager(Keys& keys) {
  const auto moduli = read_moduli(keys);
  const auto strength = read_strength(keys);
  const auto name = keys.choice("cone", {"outer", "inner", "plane_strain"});
  const auto cone = name == "outer" ? Cone::outer : name == "inner" ? Cone::inner : Cone::plane_strain;
  return continuum_of<Plastic>(moduli.wave(), moduli, strength, YieldSurface::drucker_prager, cone);
}

double Strength::friction_at(double plastic) const {
  // Beyond these there is no surface to return to.
  const auto possible = [](double angle) { return std::min(std::max(angle, 0.0), steepest); };
  if (law == Law::linear) return possible(friction + friction_slope * plastic);
  if (law == Law::constant) return friction;
  if (plastic <= 0) return residual;
  if (plastic <= peak_strain) return possible(((a * plastic + b) * plastic + c) * plastic + d);
  return possible(residual + (peak - residual) * std::exp(-decay * (plastic - peak_strain)));
}

double Strength::cohesion_at(double plastic) const {
  return law == Law::linear ? std::max(0.0, cohesion + cohesion_slope * plastic) : cohesion;
}

double cone_slope(double friction, Cone cone) {
  const double s = std::sin(friction), t = std::tan(friction);
  if (cone == Cone::plane_strain) return t / std::sqrt(9 + 12 * t * t);
  return 2 * s / (std::sqrt(3.0) * (cone == Cone::outer ? 3 - s : 3 + s));
}

double cone_size(double friction, double cohesion, Cone cone) {
  const double s = std::sin(friction), t = std::tan(friction);
  if (cone == Cone::plane_strain) return 3 * cohesion / std::sqrt(9 + 12 * t * t);
  return 6 * cohesion * std::cos(friction) / (std::sqrt(3.0) * (cone == Cone::outer ? 3 - s : 3 + s));
}

double return_to_drucker_prager(Mat<3>& stress, const ElasticModuli& moduli, double friction, double cohesion,
                                double dilatancy, Cone cone) {
  const double alpha = cone_slope(friction, cone), k = cone_size(friction, cohesion, cone);
  const double flow = cone_slope(dilatancy, cone), G = moduli.shear(), K = moduli.bulk();
  const double I1 = stress.trace();
  const Mat<3> s = stress - I1 / 3 * Mat<3>::Identity();
  const double root = std::sqrt(0.5 * s.squaredNorm());
  const double over = root + alpha * I1 - k;
  if (over <= 0) return 0;
  const double multiplier = over / (G + 9 * K * alpha * flow);
  if (alpha == 0 || root - G * multiplier >= 0) {  // without friction there is no apex
    const double I = I1 - 9 * K * flow * multiplier;
    stress = (root > 0 ? 1 - G * multiplier / root : 0) * s + I / 3 * Mat<3>::Identity();
    return multiplier / std::sqrt(3.0);
  }
  stress = k / alpha / 3 * Mat<3>::Identity();  // the apex
  return root / (std::sqrt(3.0) * G);
}

double return_to_mohr_coulomb(Mat<3>& stress, const ElasticModuli& moduli, double friction, double cohesion,
                              double dilatancy) {
  const Eigen::SelfAdjointEigenSolver<Mat<3>> eigen(stress);
  const double s1 = eigen.eigenvalues()[2], s2 = eigen.eigenvalues()[1], s3 = eigen.eigenvalues()[0];
  const double sin_phi = std::sin(friction), cos_phi = std::cos(friction), sin_psi = std::sin(dilatancy);
  const double G = moduli.shear(), K = moduli.bulk();
  const auto yield = [&](double major, double minor) {
    return major - minor + (major + minor) * sin_phi - 2 * cohesion * cos_phi;
  };
  const double over = yield(s1, s3);
  if (over <= 1e-12 * (std::abs(s1) + std::abs(s3))) return 0;
  // What a unit of flow on the plane of the largest and the smallest stress takes from each principal stress.
  const double large = 2 * G * (1 + sin_psi / 3) + 2 * K * sin_psi, middle = (4 * G / 3 - 2 * K) * sin_psi;
  const double small = 2 * G * (1 - sin_psi / 3) - 2 * K * sin_psi;
  const double a = 4 * G * (1 + sin_phi * sin_psi / 3) + 4 * K * sin_phi * sin_psi;
  double r1 = s1 - large * over / a, r2 = s2 + middle * over / a, r3 = s3 + small * over / a;
  const double slack = 1e-12 * (std::abs(s1) + std::abs(s3));
  if (r1 < r2 - slack || r2 < r3 - slack) {
    // To an edge, where a second plane yields too: triaxial extension (s1 = s2) or compression (s2 = s3).
    const bool upper = (1 - sin_psi) * s1 - 2 * s2 + (1 + sin_psi) * s3 <= 0;
    const double both = 4 * K * sin_phi * sin_psi - 2 * G * sin_phi * sin_psi / 3;
    const double b = both + 2 * G * (upper ? 1 - (sin_phi + sin_psi) : 1 + sin_phi + sin_psi);
    const double other = upper ? yield(s2, s3) : yield(s1, s2);
    const double first = (a * over - b * other) / (a * a - b * b), second = (a * other - b * over) / (a * a - b * b);
    if (upper) {
      r1 = s1 - large * first + middle * second;
      r2 = s2 + middle * first - large * second;
      r3 = s3 + small * (first + second);
    } else {
      r1 = s1 - large * (first + second);
      r2 = s2 + middle * first + small * second;
      r3 = s3 + small * first + middle * second;
    }
  }
  if (sin_phi > 0) {  // without friction there is no apex
    const double apex = cohesion * cos_phi / sin_phi;
    if (r1 < r2 - slack || r2 < r3 - slack || (r1 + r2 + r3) / 3 > apex) r1 = r2 = r3 = apex;
  }
  const Vec<3> lost(s3 - r3, s2 - r2, s1 - r1);
  const Vec<3> deviator = lost - lost.mean() * Vec<3>::Ones();
  stress = eigen.eigenvectors() * Vec<3>(r3, r2, r1).asDiagonal() * eigen.eigenvectors().transpose();
  return std::sqrt(2.0 / 3) * deviator.norm() / (2 * G);
}

template <int D>
void Plastic<D>::advance(Point<D>* points, long count, double, rvelab::Workers& workers) {
  plastic_.resize(std::size_t(count), 0.0);
  const double lame = moduli_.bulk() - 2 * moduli_.shear() / 3, twice_shear = 2 * moduli_.shear();
  workers.for_each((count + 255) / 256, [&](std::int64_t piece) {
    for (long k = piece * 256; k < std::min(count, long(piece + 1) * 256); ++k) {
      auto& point = points[k];
      elastic_trial<D>(point, lame, twice_shear);
      Mat<3> s = Mat<3>::Zero();
      s.template topLeftCorner<D, D>() = point.stress;
      if (D == 2) s(2, 2) = point.stress_zz;
      const double phi = strength_.friction_at(plastic_[k]), cohesion = strength_.cohesion_at(plastic_[k]);
      plastic_[k] += surface_ == YieldSurface::mohr_coulomb
                         ? return_to_mohr_coulomb(s, moduli_, phi, cohesion, strength_.dilatancy)
                         : return_to_drucker_prager(s, moduli_, phi, cohesion, strength_.dilatancy, cone_);
      point.stress = s.topLeftCorner<D, D>();
      if (D == 2) point.stress_zz = s(2, 2);
    }
  });
}

template <int D>
Measures Plastic<D>::measures(long point) const {
  Measures measures;
  measures.plastic_strain = plastic_.empty() ? 0 : plastic_[std::size_t(point)];
  return measures;
}

template <int D>
void Plastic<D>::save(Hdf5File& file, const std::string& name) const {
  file.write<double>("/materials/" + name + "/plastic_strain", plastic_, {plastic_.size()});
}

template <int D>
void Plastic<D>::restore(const Hdf5File& file, const std::string& name) {
  plastic_ = file.read<double>("/materials/" + name + "/plastic_strain");
}

template class Plastic<2>;
template class Plastic<3>;

}  // namespace mpm
