// Flows: a constant gradient. Declared in stage_kinds.hpp.
#include <string>

#include "rvelab/keys/key_builders.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/protocol/stage_readers.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

std::vector<TableKey> entries() {
  const char* t = "stage.flow";
  return {
      required(listed(t, "gradient", "1", "components", "xx, xy, xz, yx, yy, yz, zx, zy, zz = numbers",
                      KeyKind::components,
                      "G of F = exp(s G), s the driving strain; physical loading: velocity gradient = rate G")),
      required(number(t, "to_strain", "1", "", positive, "s at which the stage ends")),
      number(t, "record_every", "1", FlowStage{}.record_every, positive, "s between records; at most 1e6 records"),
  };
}

/// In 2D nothing moves along z.
void expect_plane(TableReader& reader, const std::string& key, const Matrix3& f, const Protocol& protocol) {
  Matrix3 out = f;
  out.topLeftCorner<2, 2>().setZero();
  if (protocol.dimension == 2 && !out.isZero(0)) {
    reader.mistake(key, "leaves the plane of test.dimension = 2; allowed: xx, xy, yx, yy; remove the others");
  }
}

FlowStage read(StageSource& source) {
  TableReader& reader = source.reader;
  const Protocol& protocol = source.protocol;
  FlowStage stage;
  stage.gradient = reader.components("gradient", false);
  expect_plane(reader, "gradient", stage.gradient, protocol);
  stage.to_strain = reader.number("to_strain");
  stage.record_every = spacing_of(reader, stage.to_strain);
  return stage;
}

std::string misfit(const FlowStage& stage, int dimension) {
  const bool in_plane = stage.gradient.row(2).isZero(0) && stage.gradient.col(2).isZero(0);
  if (dimension == 3 || in_plane) return "";
  return "gradient leaves the plane of a 2D specimen; allowed: x and y; change it";
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

void drive(RunningTest& test, const FlowStage& stage) {
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

}  // namespace

StageKind flow_kind() {
  return KindOf<FlowStage>{
      .name = "flow",
      .keys = entries,
      .read = read,
      .drive = drive,
      .planned_records =
          [](const FlowStage& stage) { return record_strains(stage.to_strain, stage.record_every).size(); },
      .misfit = misfit};
}

}  // namespace rvelab::protocol
