#include "tools/models/hardening_soil_small.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "tools/models/description.hpp"
#include "tools/models/plasticity.hpp"

namespace rvelab::models {
namespace {

constexpr double decay = 0.385;  // Santos and Correia 2001
constexpr double on_surface = 1e-3;

/// Memory of an element.
enum Memory { plastic_shear, cap_pressure, reversal_strain, smallest_shear };

/// Plastic strain of a shear multiplier of one: d gamma_p = 1, d eps_v = -sine.
std::array<double, 2> shear_flow(double sine, bool compression) {
  const double larger = 0.5 * (1 - sine), smaller = -0.5 * (1 + sine);
  return compression ? std::array{larger, 0.5 * smaller} : std::array{smaller, 0.5 * larger};
}

std::string missing_of_hardening_soil(const Tests& tests) {
  const Tests drained = of_loading(tests, Loading::drained);
  if (drained.size() < 2 || !several_pressures(drained)) return "drained tests at two pressures at least";
  if (of_loading(tests, Loading::oedometer).empty()) return "an oedometer test";
  return "";
}

std::vector<Entry> parameters_of_hardening_soil(const Tests& tests, const Numbers& numbers) {
  const double phi = largest_friction_angle_deg(tests);
  const SecantModulus secant = secant_modulus(tests);
  const double E50 = number_or(numbers, "E50_ref_Pa", secant.at_100_kPa);
  const double m = number_or(numbers, "exponent_m", std::clamp(secant.exponent, 0.2, 0.9));
  const double Eoed = number_or(numbers, "Eoed_ref_Pa", oedometer_modulus(tests, m));
  const double Eur = number_or(numbers, "Eur_ref_Pa", 3 * E50);
  constexpr Origin fitted = Origin::fitted;
  // Small strains: without a test of them nothing tells what a sheet does not, and G0 follows E_ur.
  const Origin small = of_loading(tests, Loading::cyclic_shear).empty() ? Origin::assumed : fitted;
  const double G0 = number_or(numbers, "G0_ref_Pa", small == fitted ? 0.8 * Eur : unknown);
  return {
      {"phi", "deg", "friction angle", phi, 15, 65, fitted, false},
      {"psi", "deg", "dilation angle", std::max(1.0, 0.3 * phi), -15, 40, fitted, false},
      {"E50_ref", "Pa", "secant stiffness at half of the strength, 100 kPa", E50, 1e5, 1e10, fitted, true},
      {"Eoed_ref", "Pa", "oedometer stiffness of first loading, 100 kPa", Eoed, 1e5, 1e10, fitted, true},
      {"Eur_ref", "Pa", "stiffness of unloading and reloading, 100 kPa", Eur, 2e5, 1e11,
       sheet_or(numbers, "Eur_ref_Pa", fitted), true},
      {"m", "", "exponent of stiffness over stress", m, 0.01, 1, sheet_or(numbers, "exponent_m", fitted), false},
      {"nu_ur", "", "Poisson's ratio of unloading and reloading", number_or(numbers, "nu_ur", 0.2), 0, 0.5,
       sheet_or(numbers, "nu_ur", Origin::assumed), false},
      {"K0nc", "",
       has_number(numbers, "K0nc") ? "sigma_3/sigma_1 of first oedometric loading"
                                   : "sigma_3/sigma_1 of first oedometric loading: 1 - sin phi (Jaky 1948)",
       number_or(numbers, "K0nc", unknown), 0.1, 0.9, sheet_or(numbers, "K0nc", Origin::assumed), false},
      {"R_f", "", "strength over the asymptote of the hyperbola", number_or(numbers, "R_f", 0.85), 0.4, 0.995, fitted,
       false},
      {"G0_ref", "Pa", "shear stiffness at smallest strain, 100 kPa", G0, 1e5, 1e11,
       sheet_or(numbers, "G0_ref_Pa", small), true},
      {"gamma_07", "", "shear strain at which G is 0.722 G0", number_or(numbers, "gamma_07", 1e-4), 1e-7, 1e-2,
       small == fitted ? fitted : sheet_or(numbers, "gamma_07", small), true},
  };
}

/// Places of the parameters.
enum Place { phi_at, psi_at, E50_at, Eoed_at, Eur_at, m_at, nu_at, K0_at, R_f_at, G0_at, gamma_at };

HardeningSoilParameters parameters_at(const std::vector<double>& v) {
  return {v[phi_at], v[psi_at], v[E50_at], v[Eoed_at], v[Eur_at],  v[m_at],
          v[nu_at],  v[K0_at],  v[R_f_at], v[G0_at],   v[gamma_at]};
}

void tie_of_hardening_soil(std::vector<double>& v) {
  if (!std::isfinite(v[K0_at])) v[K0_at] = 1 - std::sin(v[phi_at] * degree);
  const HardeningSoilSmall law(parameters_at(v));
  v[Eur_at] = law.used().Eur;
  v[G0_at] = std::isfinite(v[G0_at]) ? law.used().G0 : 0.8 * law.used().Eur;
}

std::unique_ptr<Law> law_of_hardening_soil(const std::vector<double>& v) {
  return std::make_unique<HardeningSoilSmall>(parameters_at(v));
}

std::string warning_of_hardening_soil(const std::vector<double>& v) {
  const HardeningSoilSmall law(parameters_at(v));
  std::string warning;
  if (!law.cap_exists())
    warning = "no cap gives K0nc = " + in_words(v[K0_at]) + " and Eoed_ref = " + in_words(v[Eoed_at]) +
              " Pa together: the nearest one is used";
  if (v[Eur_at] < 2 * v[E50_at])
    warning += (warning.empty() ? "" : "; ") + std::string("Plaxis wants Eur_ref of 2 E50_ref at least");
  return warning;
}

}  // namespace

HardeningSoilSmall::HardeningSoilSmall(const HardeningSoilParameters& parameters, bool with_cap)
    : given(parameters), with_cap(with_cap) {
  sin_phi = std::sin(given.phi_deg * degree);
  sin_psi = std::sin(given.psi_deg * degree);
  sin_cv = (sin_phi - sin_psi) / (1 - sin_phi * sin_psi);
  N = (1 + sin_phi) / (1 - sin_phi);
  failure_ratio = 2 * sin_phi / (1 - sin_phi);
  E_i = 2 * given.E50 / (2 - given.R_f);
  given.Eur = std::max(given.Eur, 1.01 * E_i);  // else the hyperbola leaves no plastic strain
  G_ur = given.Eur / (2 * (1 + given.nu_ur));
  given.G0 = std::max(given.G0, G_ur);
  extension = (3 + sin_phi) / (3 - sin_phi);
  if (with_cap) fit_cap();
}

double HardeningSoilSmall::power(double sigma_3) const { return std::pow(std::max(sigma_3, 1.0) / p_ref, given.m); }

/// gamma_p of first loading to q at that sigma_3.
double HardeningSoilSmall::hyperbola(double q, double sigma_3) const {
  const double q_a = failure_ratio * sigma_3 / given.R_f;
  return (2 * q / (E_i * (1 - std::min(q / q_a, 0.9999))) - 2 * q / given.Eur) / power(sigma_3);
}

/// p_p of a cap through the stress.
double HardeningSoilSmall::cap(const Element& at) const {
  const double q = at.q() > 0 ? at.q() : -at.q() * extension;
  return std::sqrt(q * q / alpha2 + at.p() * at.p());
}

double HardeningSoilSmall::mobilised_dilation(double q, double sum) const {
  if (sin_psi <= 0) return sin_psi;
  const double sin_m = q / sum;
  return std::max(0.0, (sin_m - sin_cv) / (1 - sin_m * sin_cv));
}

/// The plastic strain that oedometric loading along K0nc leaves to the cap gives its direction, and so alpha, and its
/// amount, and so beta.
void HardeningSoilSmall::fit_cap() {
  const double sigma_3 = given.K0nc * p_ref, q = p_ref - sigma_3, p = (p_ref + 2 * sigma_3) / 3;
  const double scale = power(sigma_3), E = given.Eur * scale, nu = given.nu_ur;
  const double per_stress = 1 / p_ref;  // of d(sigma_1) = 1 the stress grows by this share of itself
  double plastic_a = 1 / given.Eoed - (1 - 2 * nu * given.K0nc) / E;
  double plastic_r = -(given.K0nc - nu * (1 + given.K0nc)) / E;
  if (q < failure_ratio * sigma_3) {
    const double shear = (1 - given.m) * hyperbola(q, sigma_3) * per_stress;
    const auto flow = shear_flow(mobilised_dilation(q, p_ref + sigma_3), true);
    plastic_a -= shear * flow[0];
    plastic_r -= shear * flow[1];
  }
  const double volume = plastic_a + 2 * plastic_r, deviator = 2 * (plastic_a - plastic_r) / 3;
  const double least = 1e-3 / E;
  exists = volume > least && deviator > 1e-3 * volume;
  const double some_volume = std::max(volume, least), some_deviator = std::max(deviator, 1e-3 * some_volume);
  alpha2 = q / p * some_volume / some_deviator;
  const double p_p = std::sqrt(q * q / alpha2 + p * p);
  beta = some_volume * std::pow(p_p / p_ref, given.m) * p_ref / (p_p * per_stress);
}

void HardeningSoilSmall::start(Element& at) const {
  at.memory = {};
  at.memory[cap_pressure] = at.p();
  at.memory[smallest_shear] = given.G0 / G_ur;
}

void HardeningSoilSmall::reverse(Element& at) const { at.memory[reversal_strain] = at.eps_a - at.eps_r; }

/// At p_ref.
double HardeningSoilSmall::tangent_shear(const Element& at) const {
  const double gamma = std::abs(at.eps_a - at.eps_r - at.memory[reversal_strain]);
  const double fall = 1 + decay * gamma / given.gamma_07;
  return std::max(G_ur, given.G0 / (fall * fall));
}

Rate HardeningSoilSmall::rate(const Element& at, StrainRate d) const {
  const bool compression = at.q() > 1e-9 * at.p() || (at.q() > -1e-9 * at.p() && d.a >= d.r);
  const double sigma_3 = compression ? at.sigma_r : at.sigma_a, q = std::abs(at.q());
  const double scale = power(sigma_3), nu = given.nu_ur;
  const double shear = tangent_shear(at) * scale;
  const Elasticity elastic{2 * shear * (1 + nu) / (3 * (1 - 2 * nu)), shear};
  const auto in_axes = [&](double of_1, double of_3) {
    return compression ? std::array{of_1, of_3} : std::array{of_3, of_1};
  };
  std::array<Mechanism, 2> mechanisms;
  Mechanism& hardening = mechanisms[0];
  const bool fails = q >= failure_ratio * sigma_3 * (1 - 1e-9);
  const double share = std::min(q * given.R_f / (failure_ratio * sigma_3), 0.9999), rest = 1 - share;
  const double ease = std::pow(std::max(1.0, std::min(at.memory[smallest_shear], shear / scale / G_ur)),
                               1 + given.Eur / (2 * given.E50));
  if (fails) {
    hardening = {true, in_axes(1, -N), shear_flow(sin_psi, compression), 0};
  } else {
    const double value = hyperbola(q, sigma_3);
    const double by_q = (2 / (E_i * rest * rest) - 2 / given.Eur) / scale;
    const double by_3 = -given.m * value / sigma_3 - 2 * q * share / (E_i * scale * sigma_3 * rest * rest);
    hardening.active = value >= at.memory[plastic_shear] * (1 - on_surface);
    hardening.normal = in_axes(by_q, by_3 - by_q);
    hardening.flow = shear_flow(mobilised_dilation(q, at.sigma_a + at.sigma_r), compression);
    hardening.hardening = ease;
  }
  const double p_p = at.memory[cap_pressure];
  if (with_cap) {
    const double weight = (compression ? 1 : extension * extension) / alpha2;
    mechanisms[1].active = cap(at) >= p_p * (1 - on_surface);
    mechanisms[1].normal = {2 * at.q() * weight + 2 * at.p() / 3, -2 * at.q() * weight + 4 * at.p() / 3};
    mechanisms[1].flow = {mechanisms[1].normal[0], 0.5 * mechanisms[1].normal[1]};
    mechanisms[1].hardening = 4 * p_p * at.p() * p_ref / beta * std::pow(p_p / p_ref, given.m);
  }
  const auto plastic = plastic_rate(elastic, mechanisms, d);
  Rate rate{plastic.stress[0], plastic.stress[1], {}};
  if (!fails) rate.memory[plastic_shear] = ease * plastic.multiplier[0];
  if (with_cap) rate.memory[cap_pressure] = plastic.multiplier[1] * mechanisms[1].hardening / (2 * std::max(p_p, 1.0));
  return rate;
}

void HardeningSoilSmall::settle(Element& at) const {
  if (at.q() >= 0) at.sigma_a = std::min(at.sigma_a, N * at.sigma_r);
  if (at.q() < 0) at.sigma_a = std::max(at.sigma_a, at.sigma_r / N);
  const double sigma_3 = std::min(at.sigma_a, at.sigma_r);
  at.memory[plastic_shear] = std::max(at.memory[plastic_shear], hyperbola(std::abs(at.q()), sigma_3));
  if (with_cap) at.memory[cap_pressure] = std::max(at.memory[cap_pressure], cap(at));
  at.memory[smallest_shear] = std::min(at.memory[smallest_shear], tangent_shear(at) / G_ur);
}

double HardeningSoilSmall::shear_stress(double gamma, double p) const {
  const double scale = power(p), last = given.gamma_07 / decay * (std::sqrt(given.G0 / G_ur) - 1);
  const double small = std::min(gamma, last);
  const double stress = given.G0 * small / (1 + decay * small / given.gamma_07) + G_ur * (gamma - small);
  return std::min(stress * scale, p * sin_phi);
}

const Description& hardening_soil_small() {
  static const Description description{"hardening_soil_small",
                                       "Hardening Soil small",
                                       missing_of_hardening_soil,
                                       parameters_of_hardening_soil,
                                       law_of_hardening_soil,
                                       tie_of_hardening_soil,
                                       warning_of_hardening_soil,
                                       false,
                                       true};
  return description;
}

}  // namespace rvelab::models
