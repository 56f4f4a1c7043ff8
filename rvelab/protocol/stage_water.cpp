// Water stages: the specimen is wetted, its suction is changed, or it is flooded. Declared in stage_kinds.hpp.
#include <optional>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

struct WaterSettings {
  bool flooded = false;
  Water water;
};

struct WaterStage : KindOf<WaterSettings> {
  const char* name() const override { return "water"; }
  bool takes_events() const override { return false; }

  void read(TableReader& reader, Protocol&) override {
    Water& water = stage.water;
    reader.boolean("flooded", stage.flooded, "the pores fill: all bridges go");
    reader.number("surface_tension_N_m", water.surface_tension, "N/m", positive_number, "of water and air");
    reader.number("contact_angle_deg", water.contact_angle_deg, "degrees", {0, 45}, "of water on the grains");
    const std::optional<double> suction = reader.optional_number(
        "suction_Pa", "Pa", positive_number, "of all bridges, which exchange water with a reservoir");
    const std::optional<double> volume =
        reader.optional_number("volume_ratio", "1", {0, 0.1, true, false},
                               "volume of each bridge over the cube of its smaller radius, between spheres");
    water.suction = suction.value_or(0);
    water.volume_ratio = volume.value_or(0);
    if (stage.flooded && (suction || volume))
      reader.mistake("flooded",
                     "contradicts suction_Pa and volume_ratio; allowed: one of the three; remove the others");
    if (!stage.flooded && suction.has_value() == volume.has_value())
      reader.mistake("suction_Pa", suction ? "contradicts volume_ratio; allowed: one of them; remove the other"
                                           : "or volume_ratio is missing; give one of them, or flooded = true");
  }

  std::string misfit(int dimension) const override {
    return dimension == 2 && stage.water.volume_ratio > 0
               ? "volume_ratio is for spheres; give suction_Pa, which discs have in closed form"
               : "";
  }

  void drive(RunningTest& test) const override {
    if (stage.flooded)
      test.rve.remove_water();
    else
      test.rve.set_water(stage.water);
  }
};

}  // namespace

std::unique_ptr<StageKind> water_kind() { return std::make_unique<WaterStage>(); }

}  // namespace rvelab::protocol
