// The data of a record file for a page. Declared in test.hpp.
#include <filesystem>

#include "rvelab/protocol/stage_kinds.hpp"
#include "rvelab/report/test.hpp"

namespace rvelab::report {
namespace {

/// F since the start of the test: a stage begins at the end of the one before.
std::vector<Matrix3> deformation_of(const std::vector<records::Record>& records) {
  std::vector<Matrix3> found;
  Matrix3 before = Matrix3::Identity();
  for (std::size_t k = 0; k < records.size(); ++k) {
    if (k > 0 && records[k].stage != records[k - 1].stage) before = found.back();
    found.emplace_back(records[k].deformation_gradient * before);
  }
  return found;
}

/// Pa, compression positive: the held lateral stress of the last stage; without one p at its first record.
double pressure_of(const Test& test) {
  const auto last = calibrate::last_stage(test.recorded.result);
  const protocol::Stage& stage = test.protocol.stages.at(std::size_t(last.front().stage));
  const auto* compression = protocol::settings_of<protocol::CompressionStage>(stage);
  if (compression != nullptr && compression->lateral == protocol::CompressionStage::Lateral::constant_stress)
    return compression->lateral_pressure;
  return mean_pressure(last.front().stress, test.dimension);
}

}  // namespace

std::optional<Test> read_test(const std::string& path, const std::string& group) {
  Test test;
  test.path = path;
  test.file = std::filesystem::path(path).filename().string();
  test.group = group;
  test.recorded = io::read_recorded_test(path);
  if (test.records().empty()) return {};
  test.protocol = protocol::parse_recorded_protocol(test.recorded.provenance.protocol, path);
  test.dimension = test.recorded.checkpoint.specimen.cell.dimension;
  test.measured = ensemble::measured(test.protocol, test.recorded.result, test.dimension);
  test.strength = ensemble::strength_of(test.protocol, test.recorded.result, test.dimension);
  test.pressure = pressure_of(test);
  test.deformation = deformation_of(test.records());
  return test;
}

}  // namespace rvelab::report
