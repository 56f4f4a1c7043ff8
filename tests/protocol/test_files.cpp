// The protocols that come with the program: each is read, says what it is, and runs (shortened) on a packing.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "rvelab/protocol/run.hpp"
#include "rvelab/protocol/stage_kinds.hpp"
#include "tests/catch.hpp"
#include "tests/reference_specimen.hpp"

using namespace rvelab;

namespace {

std::vector<std::string> protocol_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(RVELAB_SOURCE_DIR "/protocols")) {
    const std::string name = entry.path().filename();
    if (name.ends_with(".toml") && !name.starts_with("pack")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The settings of a stage that was just read, to be changed; null if it is of another kind.
template <class Settings>
Settings* settings(protocol::Stage& stage) {
  return const_cast<Settings*>(protocol::settings_of<Settings>(stage));
}

/// A few records of each stage.
void shorten(protocol::Stage& stage) {
  constexpr long few = 2;
  const auto shorter = [](double& to_strain, double every) {
    to_strain = (to_strain < 0 ? -1 : 1) * std::min(std::abs(to_strain), few * every);
  };
  if (auto* compression = settings<protocol::CompressionStage>(stage))
    shorter(compression->to_strain, compression->record_every);
  if (auto* shear = settings<protocol::SimpleShearStage>(stage)) {
    shorter(shear->to_strain, shear->record_every);
    shear->cycles.count = std::min(shear->cycles.count, 1L);
  }
  if (auto* deviatoric = settings<protocol::DeviatoricStage>(stage))
    shorter(deviatoric->to_strain, deviatoric->record_every);
  if (auto* flow = settings<protocol::FlowStage>(stage)) shorter(flow->to_strain, flow->record_every);
  if (auto* path = settings<protocol::PathStage>(stage)) path->records_per_point = few;
  if (auto* pressures = settings<protocol::PressurePathStage>(stage)) pressures->pressures.resize(1);
  if (auto* envelope = settings<protocol::EnvelopeStage>(stage)) envelope->directions = 3;
  if (auto* isotropic = settings<protocol::IsotropicStage>(stage)) isotropic->stress_tolerance = 1e-2;
  if (auto* probe = settings<protocol::ProbeStage>(stage)) probe->method = protocol::ProbeStage::Method::linear;
}

}  // namespace

TEST_CASE("Every protocol opens with what it is and where its numbers are from") {
  REQUIRE(!protocol_files().empty());
  for (const std::string& file : protocol_files()) {
    CAPTURE(file);
    std::ifstream text(file);
    std::string line, opening;
    while (std::getline(text, line) && line.starts_with("#")) opening += line + "\n";
    CHECK(opening.find("# Sources.") != std::string::npos);
    CHECK(opening.find("rvelab run ") != std::string::npos);
    CHECK_FALSE(protocol::read_protocol(file).name.empty());
  }
}

TEST_CASE("Every protocol runs through all its stages") {
  const Specimen discs = reference_specimen("dense_p20"), spheres = reference_specimen("hertz");
  for (const std::string& file : protocol_files()) {
    CAPTURE(file);
    protocol::Protocol protocol = protocol::read_protocol(file, {"test.pressure_Pa=20e3"});
    for (protocol::Stage& stage : protocol.stages) shorten(stage);
    const bool physical = protocol.loading.at_rate;
    // Large shear brings its contacts; those of 3D otherwise start at their own pressure.
    if (protocol.dimension == 3) {
      for (protocol::Stage& stage : protocol.stages) {
        if (auto* isotropic = settings<protocol::IsotropicStage>(stage)) isotropic->pressure = 100e3;
        if (auto* compression = settings<protocol::CompressionStage>(stage)) compression->lateral_pressure = 100e3;
      }
    }
    if (physical) {
      protocol.overrides.erase("contact");
      protocol.overrides.erase("material");
      protocol.overrides.erase("damping");
      protocol.overrides.erase("solver");
      protocol.loading.rate = 50;
    }
    const protocol::TestRun run = protocol::run_protocol(protocol, protocol.dimension == 3 ? spheres : discs);
    CHECK(run.complete);
    long flagged = 0;
    for (const records::Record& record : run.result.records) flagged += record.target_held ? 0 : 1;
    CHECK(flagged == 0);
    if (file.find("probe") == std::string::npos) CHECK(run.result.records.size() >= 3);
  }
}
