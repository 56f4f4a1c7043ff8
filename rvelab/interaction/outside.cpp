#include "rvelab/interaction/outside.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/error.hpp"
#include "rvelab/interaction/bridge.hpp"
#include "rvelab/interaction/bridge_of_pair.hpp"
#include "rvelab/interaction/capillary.hpp"

namespace rvelab {

namespace {

using namespace interaction;

double smaller_of(const GrainPair& pair) { return std::min(pair.radius_i, pair.radius_j); }
double mean_of(const GrainPair& pair) { return pair.radius_i * pair.radius_j / (pair.radius_i + pair.radius_j); }

template <class Is>
std::size_t count_of(const std::vector<GrainPair>& pairs, const Is& is) {
  return std::size_t(std::count_if(pairs.begin(), pairs.end(), is));
}

/// "12 of 263 pairs (4.56 %)".
std::string share(std::size_t some, const std::vector<GrainPair>& pairs) {
  return std::to_string(some) + " of " + std::to_string(pairs.size()) + " pairs (" +
         in_words(100 * double(some) / double(pairs.size())) + " %)";
}

/// A suction by the size of the bridge over the smaller radius, which the table begins and ends at.
void check_suction(const Water& water, const std::vector<GrainPair>& pairs, std::vector<std::string>& found) {
  const double pull = water.surface_tension * std::cos(water.contact_angle_deg * bridge_detail::pi / 180);
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (const GrainPair& pair : pairs) {
    smallest = std::min(smallest, smaller_of(pair));
    largest = std::max(largest, smaller_of(pair));
  }
  const double least = bridge_range::least_suction * pull, most = bridge_range::largest_suction * pull;
  const std::size_t wide = count_of(pairs, [&](const GrainPair& p) { return water.suction * smaller_of(p) < least; });
  const std::size_t narrow = count_of(pairs, [&](const GrainPair& p) { return water.suction * smaller_of(p) > most; });
  if (wide + narrow == 0) return;
  found.push_back("suction_Pa = " + in_words(water.suction) + " is outside the table of bridges for " +
                  share(wide + narrow, pairs) + ", which take the shape at its " + (wide > 0 ? "lower" : "upper") +
                  " end; of these grains it goes from " + in_words(least / smallest) + " to " +
                  in_words(most / largest) + " Pa; give a suction between them" +
                  (wide > 0 ? ", or volume_ratio" : ""));
}

void check_volume(const Water& water, std::vector<std::string>& found) {
  const bool wetting = water.contact_angle_deg * bridge_detail::pi / 180 <= bridge_table::wetting.last_angle;
  const double root = (wetting ? bridge_table::wetting : bridge_table::poorly_wetting).low;
  const double least = std::pow(root, 12);  // V^(1/3)/r = root^4
  if (water.volume_ratio >= least * (1 - 1e-6)) return;
  found.push_back("volume_ratio = " + in_words(water.volume_ratio) + " is below the table of bridges, from " +
                  in_words(least) + " to 0.1" + (wetting ? "" : " above 30 degrees of contact_angle_deg") +
                  ": they take the shape at its end; give a larger one");
}

/// Two bridges of one grain meet where both reach 30 degrees from their axes: neighbours that touch lie 60 degrees
/// apart. Between equal spheres that is a volume of 0.06 r^3 (toroid, contact angle 0).
bool may_join(const Water& water, const GrainPair& pair) {
  constexpr double of_spheres = 0.06;
  const double r = smaller_of(pair);
  if (!(pair.thickness > 0)) return content_of_bridge(water, pair).volume > of_spheres * r * r * r;
  const double theta = water.contact_angle_deg * bridge_detail::pi / 180, rho = water.surface_tension / water.suction;
  const double length = 2 * r + std::max(pair.gap, 0.0),
               reach = std::sqrt(r * r + rho * rho + 2 * r * rho * std::cos(theta));
  if (!(2 * reach > length)) return false;
  const double filled = std::acos(0.5 * length / reach) - std::atan2(rho * std::sin(theta), r + rho * std::cos(theta));
  return filled > bridge_detail::pi / 6;
}

/// (R* w^2/(E*^2 z0^3))^(1/3) of the pair, w = 2 gamma; E* from the stiffness of Hertz, 4/3 E* sqrt(R*).
double tabor_number(double surface_energy, double range, const GrainPair& pair) {
  const double R = mean_of(pair), modulus = 0.75 * pair.contact_stiffness / std::sqrt(R), w = 2 * surface_energy;
  return std::cbrt(R * w * w / (modulus * modulus)) / range;
}

constexpr double soft = 5, hard = 0.1;  // of Tabor's numbers (dmt.hpp)

}  // namespace

std::vector<std::string> outside_ranges(const Water& water, const std::vector<GrainPair>& pairs, double pore_volume) {
  std::vector<std::string> found;
  const bool plane = pairs.front().thickness > 0;
  if (water.suction > 0 && !plane) check_suction(water, pairs, found);
  if (water.volume_ratio > 0) check_volume(water, found);
  if (const std::size_t joined = count_of(pairs, [&](const GrainPair& p) { return may_join(water, p); }); joined > 0)
    found.push_back("bridges of " + share(joined, pairs) +
                    " are so wide that those of neighbours touch (half filling angle above 30 degrees): they would "
                    "join, which they do not here; give less water");
  constexpr double pendular = 0.1;  // Scheel et al. 2008: bridges join from 3 % of the whole volume on
  const double saturation = CapillaryBridge::target_of(water, pore_volume, pairs.data(), long(pairs.size()));
  if (saturation > pendular)
    found.push_back("the saturation is " + in_words(saturation) +
                    ", above the pendular regime, up to some 0.1, in which water stays in bridges; give less water");
  return found;
}

std::vector<std::string> outside_ranges(const SurfaceEnergy& surface, const std::vector<GrainPair>& pairs, double) {
  std::vector<std::string> found;
  constexpr double atoms = 4e-10, most_overlap = 0.1, at_no_load = 0.572357121276666;  // m; y^4 - y at y^3 = 3/2
  double overlap = 0, tabor = std::numeric_limits<double>::infinity();
  for (const GrainPair& pair : pairs) {
    double column[interaction_columns<JkrAdhesion>()] = {};
    JkrAdhesion::prepare(surface, pair, column);
    overlap = std::max(overlap, at_no_load * column[JkrAdhesion::overlap_scale] / smaller_of(pair));
    tabor = std::min(tabor, tabor_number(surface.surface_energy, atoms, pair));
  }
  const std::string key = "surface_energy_J_m2 = " + in_words(surface.surface_energy);
  if (overlap > most_overlap)
    found.push_back(key + " presses these grains together by " + in_words(overlap) +
                    " of their radius without any load, outside what Hertz and JKR describe, up to some 0.1; give "
                    "less, or stiffer grains");
  if (tabor < hard)
    found.push_back(key + ": Tabor's number is " + in_words(tabor) +
                    " at a range of 4e-10 m, below 0.1, where grains stick by DMT; JKR holds above 5; use kind = "
                    "\"dmt\"");
  return found;
}

std::vector<std::string> outside_ranges(const VanDerWaals& surface, const std::vector<GrainPair>& pairs, double) {
  double tabor = 0, reach = 0;
  for (const GrainPair& pair : pairs) {
    if (pair.contact_stiffness > 0) tabor = std::max(tabor, tabor_number(surface.surface_energy, surface.range, pair));
    reach = std::max(reach, DmtAdhesion::reach(surface) / smaller_of(pair));
  }
  std::vector<std::string> found;
  const std::string key = "range_m = " + in_words(surface.range);
  if (tabor > soft)
    found.push_back(key + ": Tabor's number is up to " + in_words(tabor) +
                    ", above 5, where grains stick by JKR; DMT holds below 0.1; use kind = \"jkr\", or give a longer "
                    "range");
  constexpr double small = 0.1;
  if (reach > small)
    found.push_back(key + " lets grains pull over " + in_words(reach) +
                    " of their radius, outside what the formula of near spheres describes, up to some 0.1; give a "
                    "shorter one");
  return found;
}

}  // namespace rvelab
