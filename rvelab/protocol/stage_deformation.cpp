// A given history of deformation gradients. Declared in stage_kinds.hpp.
#include <Eigen/LU>

#include "rvelab/keys/table_reader.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

struct Deformation : KindOf<DeformationStage> {
  const char* name() const override { return "deformation"; }

  void read(TableReader& reader, Protocol& protocol) override {
    stage.gradients =
        reader.matrices("gradients", "deformation gradients F since the start of the stage, a record at each");
    for (const Matrix3& f : stage.gradients) {
      if (f.determinant() <= 0) {
        reader.mistake("gradients", "has a determinant <= 0; allowed: > 0; correct it");
        break;
      }
      Matrix3 out = f - Matrix3::Identity();
      out.topLeftCorner<2, 2>().setZero();
      if (protocol.dimension == 2 && !out.isZero(0)) {
        reader.mistake("gradients", "leave the plane of test.dimension = 2; allowed: 4 numbers each; correct them");
        break;
      }
    }
  }

  std::size_t planned_records() const override { return stage.gradients.size() + 1; }

  void drive(RunningTest& test) const override {
    records::Progress& at = test.run.progress;
    at.axis = "";
    at.pressure = at.first_pressure;
    std::vector<double> numbers;
    for (std::size_t k = 0; k <= stage.gradients.size(); ++k) numbers.push_back(double(k));
    test.go_through(numbers, [&](double number) {
      const Matrix3& next = stage.gradients[std::size_t(number) - 1];
      const Matrix3 gradient = next * at.deformation.inverse() - Matrix3::Identity();
      const double size = (0.5 * (gradient + gradient.transpose())).norm();
      return test.apply(gradient, {}, test.time_for(size), test.loading.held_tolerance);
    });
  }
};

}  // namespace

std::unique_ptr<StageKind> deformation_kind() { return std::make_unique<Deformation>(); }

}  // namespace rvelab::protocol
