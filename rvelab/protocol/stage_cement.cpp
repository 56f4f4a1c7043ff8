// Cement stages: bonds between the grains as they lie, without force. Declared in stage_kinds.hpp.
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
    reader.required_number("cohesion_Pa", stage.cohesion, "Pa", positive_number,
                           "shear stress at the rim at which it breaks, without pressure on it");
    reader.number("friction_angle_deg", stage.friction_angle_deg, "degrees", {0, 89},
                  "by which that grows with the pressure on the bond");
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
