// Cement stages: bonds between the grains as they lie, without force. Declared in stage_kinds.hpp.
#include <optional>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/cementation.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

struct Cement : KindOf<Cementation> {
  const char* name() const override { return "cement"; }
  bool takes_events() const override { return false; }

  void read(TableReader& reader, Protocol&) override {
    reader.choice("model", stage.model, {"parallel_bond", "interaction_surface", "contact_bond", "softening_bond"},
                  "beam that breaks by the stress at its rim; beam that breaks by a surface of all it bears; glue at a "
                  "point, without moments; beam that softens from its strength on");
    reader.number("gap", stage.gap, "1", {0, 1},
                  "largest gap of a pair that is cemented, over its smaller radius; 0: pairs that touch");
    reader.number("share", stage.share, "1", {0, 1, true, false},
                  "share of these pairs that is cemented, drawn by seed");
    reader.whole_number("seed", stage.seed, {0, 1e15}, "of the draw of pairs and strengths");
    reader.number("radius", stage.radius, "1", {0, 2, true, false}, "radius of a bond over that of its smaller grain");
    reader.required_number("young_modulus_Pa", stage.young_modulus, "Pa", positive_number,
                           "Young's modulus of the cement: kn = E/(r_i + r_j) over the section of the bond");
    reader.number("shear_ratio", stage.shear_ratio, "1", number_from_zero, "shear over normal stiffness of a bond");
    reader.required_number("tensile_strength_Pa", stage.tensile_strength, "Pa", positive_number,
                           "tension at the rim of a bond at which it breaks");
    const std::optional<double> cohesion = reader.optional_number(
        "cohesion_Pa", "Pa", positive_number,
        "shear stress at the rim at which it breaks, without pressure on it; of a surface it is tan(friction angle) "
        "times the tensile strength");
    stage.cohesion = cohesion.value_or(0);
    const bool surface = stage.model == BondModel::surface;
    if (!surface && !cohesion)
      reader.mistake("cohesion_Pa", "is missing; give the shear strength of the cement, as large as its tensile one");
    if (surface && cohesion)
      reader.mistake("cohesion_Pa", "contradicts model = \"interaction_surface\"; remove one of them");
    reader.number("friction_angle_deg", stage.friction_angle_deg, "degrees", {0, 89},
                  "by which that grows with the pressure on the bond");
    if (surface && !(stage.friction_angle_deg > 0))
      reader.mistake("friction_angle_deg", in_words(stage.friction_angle_deg) +
                                               " does not go with model = \"interaction_surface\"; allowed: above 0");
    const std::optional<double> energy =
        reader.optional_number("fracture_energy_J_m2", "J/m^2", positive_number,
                               "of a softening bond: spent over its section until it is broken; a tensile strength "
                               "squared over 2 kn is brittle");
    stage.fracture_energy = energy.value_or(0);
    if (energy.has_value() != (stage.model == BondModel::softening))
      reader.mistake("fracture_energy_J_m2",
                     energy ? "contradicts model, which is not \"softening_bond\"; change one of them"
                            : "is missing; give it, or choose model = \"parallel_bond\"");
    reader.number("moment_factor", stage.moment_factor, "1", {0, 1}, "of the moments in the stress at the rim");
    reader.number(
        "strength_scatter", stage.strength_scatter, "1", {0, 2},
        "standard deviation of both strengths between bonds over their mean: Weibull's distribution; 0: all alike");
    if (stage.strength_scatter > 0 && stage.strength_scatter < 0.001)
      reader.mistake("strength_scatter", in_words(stage.strength_scatter) +
                                             " is out of range; allowed: 0, or 0.001 to 2; give 0.1 to 0.5 for cement");
  }

  void drive(RunningTest& test) const override { test.rve.set_interactions(cemented(test.rve, stage)); }
};

}  // namespace

std::unique_ptr<StageKind> cement_kind() { return std::make_unique<Cement>(); }

}  // namespace rvelab::protocol
