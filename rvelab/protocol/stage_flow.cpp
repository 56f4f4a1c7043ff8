// Flows: a constant gradient. Declared in stage_kinds.hpp.
#include <string>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

/// exp(h) - I by its series; increments are small, and halving keeps larger ones exact.
Matrix3 exponential_less_one(const Matrix3& h) {
  int halvings = 0;
  Matrix3 part = h;
  for (; part.cwiseAbs().maxCoeff() > 0.25; part *= 0.5) ++halvings;
  Matrix3 sum = Matrix3::Zero();
  for (int k = 16; k >= 1; --k) sum = part * (Matrix3::Identity() + sum) / k;
  for (; halvings > 0; --halvings) sum = Matrix3(2 * sum + sum * sum);
  return sum;
}

struct Flow : KindOf<FlowStage> {
  const char* name() const override { return "flow"; }

  void read(TableReader& reader, Protocol& protocol) override {
    stage.gradient = reader.components(
        "gradient", "1", "G of F = exp(s G), s the driving strain; at a rate: velocity gradient = rate G", false);
    if (protocol.dimension == 2 && !in_plane())
      reader.mistake("gradient", "leaves the plane of test.dimension = 2; allowed: xx, xy, yx, yy; remove the others");
    reader.required_number("to_strain", stage.to_strain, "1", positive, "s at which the stage ends");
    read_spacing(reader, stage.record_every, stage.to_strain, "s between records; at most 1e6 records");
  }

  std::size_t planned_records() const override { return record_strains(stage.to_strain, stage.record_every).size(); }

  std::string misfit(int dimension) const override {
    if (dimension == 3 || in_plane()) return "";
    return "gradient leaves the plane of a 2D specimen; allowed: x and y; change it";
  }

  bool in_plane() const { return stage.gradient.row(2).isZero(0) && stage.gradient.col(2).isZero(0); }

  void drive(RunningTest& test) const override {
    records::Progress& at = test.run.progress;
    at.axis = "";
    at.pressure = at.first_pressure;
    const std::vector<double> strains = record_strains(stage.to_strain, stage.record_every);
    test.go_through(strains, [&](double strain) {
      // Each from the one before it in the list: a flow has no target that round-off could miss.
      const double advance = strain - strains[std::size_t(at.step) - 1];
      return test.apply(exponential_less_one(advance * stage.gradient), {}, test.time_for(advance),
                        test.loading.held_tolerance);
    });
  }
};

}  // namespace

std::unique_ptr<StageKind> flow_kind() { return std::make_unique<Flow>(); }

}  // namespace rvelab::protocol
