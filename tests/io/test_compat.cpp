// Files of earlier versions of the format, as tests/data/compat/make wrote them, are read by this one.
#include <cmath>
#include <map>

#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/journal/recorded_test.hpp"
#include "rvelab/solver/rve.hpp"
#include "tests/catch.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// sigma_yy of the last record, Pa, as h5py reads it; a run of 2000 sub-steps a record ends at -276447.8787.
const std::map<std::string, double> last_stress = {
    {"1_10", -276447.8731603987}, {"1_11", -276447.87447605334}, {"1_12", -276447.87447605334}};

}  // namespace

TEST_CASE("files of every version of the format are read with all that they hold") {
  for (const std::string version : {"1_10", "1_11", "1_12"}) {
    CAPTURE(version);
    const Folder folder;
    const std::string kept = std::string(RVELAB_TEST_DATA) + "/compat/";
    const std::string records = kept_file(folder, kept + "records_" + version + ".h5"),
                      specimen = kept_file(folder, kept + "specimen_" + version + ".h5");
    std::string dotted = version;
    dotted[1] = '.';
    CHECK(io::Hdf5File::open(records).attribute("format_version") == dotted);
    CHECK(io::Hdf5File::open(specimen).sealed());

    const Specimen start = io::read_specimen(specimen);
    REQUIRE(start.grains.size() == 9);
    CHECK(start.grains.radius[7] == 0.00506);
    CHECK(start.materials.at(0).name == "sand");
    CHECK(start.materials[0].friction == 0.42);
    CHECK(start.contact.hertz_radius == HertzRadius::equivalent);

    const io::RecordedTest test = io::read_recorded_test(records);
    CHECK(test.complete);
    CHECK(test.result.protocol == "compat");
    CHECK(test.result.axis == "y");
    CHECK(test.result.stages == std::vector<std::string>{"relax", "probe", "compression"});
    REQUIRE(test.result.records.size() == 7);
    CHECK(test.result.records.back().strain == 0.002);
    const double end = last_stress.at(version);
    CHECK(test.result.records.back().stress(1, 1) == end);
    CHECK(end == Approx(-276447.8787).epsilon(3e-8));
    CHECK(test.result.records[3].stage == 2);
    CHECK(test.result.probes.size() == 1);
    CHECK(test.provenance.protocol.find("constant_volume") != std::string::npos);
    CHECK(Rve(test.checkpoint.specimen).stress()(1, 1) == Approx(end).epsilon(1e-8));
  }
  // The newest files are of the version that is written now: a step of the version asks for files of its own.
  CHECK(io::format_major == 1);
  CHECK(io::format_minor == 12);
}
