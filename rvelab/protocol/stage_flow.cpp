// Flows: a constant gradient. Declared in stage_kinds.hpp.
#include <string>

#include "rvelab/keys/key_builders.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

/// In 2D nothing moves along z.
void expect_plane(TableReader& reader, const std::string& key, const Matrix3& f, const Protocol& protocol) {
  Matrix3 out = f;
  out.topLeftCorner<2, 2>().setZero();
  if (protocol.dimension == 2 && !out.isZero(0)) {
    reader.mistake(key, "leaves the plane of test.dimension = 2; allowed: xx, xy, yx, yy; remove the others");
  }
}

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

  std::vector<TableKey> keys() const override {
    const char* t = "stage.flow";
    return {
        required(listed(t, "gradient", "1", "components", "xx, xy, xz, yx, yy, yz, zx, zy, zz = numbers",
                        KeyKind::components,
                        "G of F = exp(s G), s the driving strain; physical loading: velocity gradient = rate G")),
        required(number(t, "to_strain", "1", "", positive, "s at which the stage ends")),
        number(t, "record_every", "1", FlowStage{}.record_every, positive, "s between records; at most 1e6 records"),
    };
  }

  void read(StageSource& source) override {
    TableReader& reader = source.reader;
    const Protocol& protocol = source.protocol;
    stage.gradient = reader.components("gradient", false);
    expect_plane(reader, "gradient", stage.gradient, protocol);
    stage.to_strain = reader.number("to_strain");
    stage.record_every = spacing_of(reader, stage.to_strain);
  }

  std::size_t planned_records() const override { return record_strains(stage.to_strain, stage.record_every).size(); }

  std::string misfit(int dimension) const override {
    const bool in_plane = stage.gradient.row(2).isZero(0) && stage.gradient.col(2).isZero(0);
    if (dimension == 3 || in_plane) return "";
    return "gradient leaves the plane of a 2D specimen; allowed: x and y; change it";
  }

  void drive(RunningTest& test) const override {
    records::Progress& at = test.run.progress;
    at.axis = "";
    at.pressure = at.first_pressure;
    const std::vector<double> strains = record_strains(stage.to_strain, stage.record_every);
    test.go_through(strains, [&](double strain) {
      // Each from the one before it in the list: a flow has no target that round-off could miss.
      const double advance = strain - strains[static_cast<std::size_t>(at.step) - 1];
      return test.apply(exponential_less_one(advance * stage.gradient), {}, test.time_for(advance),
                        test.loading.held_tolerance);
    });
  }
};

}  // namespace

std::unique_ptr<StageKind> flow_kind() { return std::make_unique<Flow>(); }

}  // namespace rvelab::protocol
