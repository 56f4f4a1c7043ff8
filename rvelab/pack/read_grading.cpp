#include "rvelab/pack/read_grading.hpp"

#include "rvelab/grains/sieve_grading.hpp"

namespace rvelab::pack {

using namespace keys;

namespace {

/// Diameters of colloids to boulders.
constexpr Range sieves_mm{positive, {{2e-5, 2e3}}};

/// The curve through d10, d50 and d60, which are in mm.
void read_sieves(TableReader& reader, const std::string& curve, Grading& grading) {
  const bool given = curve == "d10_d60";
  const auto d10 =
      reader.optional_number("d10_mm", "mm", sieves_mm, "grading = d10_d60: diameter that 10 % of the mass pass");
  const auto d50 =
      reader.optional_number("d50_mm", "mm", sieves_mm, "grading = d10_d60: mean diameter, that 50 % pass");
  const auto d60 = reader.optional_number("d60_mm", "mm", sieves_mm,
                                          "grading = d10_d60: diameter that 60 % pass; d60/d10 is the uniformity");
  for (const char* name : {"d10_mm", "d50_mm", "d60_mm"}) {
    if (given)
      reader.expect(name);
    else
      reader.refuse(name, "contradicts grading = " + as_toml(curve) + "; allowed: one of the two; remove one");
  }
  if (!given || !d10 || !d50 || !d60) return;
  const std::string wrong =
      wrong_with_sieves(1e-3 * *d10, 1e-3 * *d50, 1e-3 * *d60, 2 * grading.scalp_below, 2 * grading.scalp_above);
  if (wrong.empty()) {
    Grading sieved = sieve_grading(1e-3 * *d10, 1e-3 * *d50, 1e-3 * *d60);
    sieved.scalp_below = grading.scalp_below;
    sieved.scalp_above = grading.scalp_above;
    grading = sieved;
  } else {
    reader.mistake("d50_mm", wrong);
  }
}

/// Diameters at which the grading is cut.
void read_scalping(TableReader& reader, Grading& grading) {
  const auto below = reader.optional_number("scalp_below_mm", "mm", sieves_mm,
                                            "scalping: grains of a smaller diameter are left out, and the rest of the "
                                            "curve is the grading; rvelab pack reports what is cut off, by mass");
  const auto above =
      reader.optional_number("scalp_above_mm", "mm", sieves_mm, "scalping: grains of a larger diameter are left out");
  if (below) grading.scalp_below = 5e-4 * *below;
  if (above) grading.scalp_above = 5e-4 * *above;
}

/// The names of the gradings; the last is no curve of its own but a table that is made of three diameters.
enum class GradingName { uniform, linear, tabulated, d10_d60 };

}  // namespace

void read_grading(TableReader& reader, Grading& grading) {
  const Choices curves{"uniform", "linear", "tabulated", "d10_d60"};
  GradingName curve = GradingName::uniform;
  reader.choice(
      "grading", curve, curves,
      "uniform: passing is linear in the radius; linear: linear in its logarithm; tabulated: given points, "
      "linear in the radius between them; d10_d60: by mass through d10, d50 and d60, linear in the logarithm");
  const bool sieves = curve == GradingName::d10_d60;
  if (sieves)
    grading.by_mass = true;
  else
    grading.curve = GradingCurve(curve);
  reader.choice("passing_by", grading.by_mass, {"number", "mass"}, "measure of the passing fraction");
  const auto smallest = reader.optional_number(
      "smallest_radius_m", "m", radii,
      "grading = uniform, linear: radius at passing 0; of grains that are not round that of the disc of their area");
  const auto largest =
      reader.optional_number("largest_radius_m", "m", radii, "grading = uniform, linear: radius at passing 1");
  grading.smallest_radius = smallest.value_or(grading.smallest_radius);
  grading.largest_radius = largest.value_or(grading.largest_radius);
  grading.radii = reader.numbers("radii_m", "m", radii, "grading = tabulated: ascending radii");
  grading.passing =
      reader.numbers("passing", "1", {0, 1},
                     "grading = tabulated: fraction not larger than each radius, 0 first, 1 last", "each 0 to 1");
  const bool tabulated = curve == GradingName::tabulated;
  if (sieves && reader.has("passing_by") && !grading.by_mass)
    reader.mistake("passing_by", "contradicts grading = \"d10_d60\"; allowed: mass; remove it");
  read_scalping(reader, grading);
  read_sieves(reader, curves[std::size_t(curve)], grading);
  for (const char* name : {"smallest_radius_m", "largest_radius_m", "radii_m", "passing"}) {
    const bool of_table = name[0] == 'r' || name[0] == 'p';
    if (sieves || of_table != tabulated)
      reader.refuse(name, "contradicts grading = " + as_toml(curves[std::size_t(curve)]) +
                              "; allowed: one of the two; remove one");
    else if (!tabulated)
      reader.expect(name);
  }
}

}  // namespace rvelab::pack
