#include "rvelab/io/record_file.hpp"

#include "rvelab/error.hpp"
#include "rvelab/io/archive.hpp"
#include "rvelab/io/schema.hpp"
#include "rvelab/io/version.hpp"

namespace rvelab {
namespace {

using io::Column;

/// Every field of a test, once for both directions.
template <class Archive, class Value>
void describe(Archive& archive, Value& result) {
  archive.field("test/protocol", result.protocol, "-");
  archive.field("test/axis", result.axis, "-");
  archive.field("test/pressure_Pa", result.pressure, "Pa");
  archive.field("test/stages", result.stages, "-");
  archive.field("test/grain_steps", result.grain_steps, "1");
  archive.field("provenance/wall_seconds", result.wall_seconds, "s");
  archive.table("records", result.records,                                               //
                Column{"stage", &Record::stage, "1"},                                    //
                Column{"strain", &Record::strain, "1"},                                  //
                Column{"deformation_gradient", &Record::deformation_gradient, "1"},      //
                Column{"stress_Pa", &Record::stress, "Pa"},                              //
                Column{"void_ratio", &Record::void_ratio, "1"},                          //
                Column{"coordination_number", &Record::coordination_number, "1"},        //
                Column{"fabric_anisotropy", &Record::fabric_anisotropy, "1"},            //
                Column{"sliding_fraction", &Record::sliding_fraction, "1"},              //
                Column{"unbalanced_force_ratio", &Record::unbalanced_force_ratio, "1"},  //
                Column{"inertial_number", &Record::inertial_number, "1"},                //
                Column{"substeps", &Record::substeps, "1"},                              //
                Column{"held_error", &Record::held_error, "1"},                          //
                Column{"target_held", &Record::target_held, "1"});
}

Hdf5File open_records(const std::string& path) {
  auto file = Hdf5File::open(path);
  if (io::checked_kind(file) != FileKind::records) {
    throw InputError(path + ": holds a specimen and no records; give a file that `rvelab run` wrote");
  }
  return file;
}

}  // namespace

void write_records(const TestResult& result, const Specimen& end_state, const std::string& resolved_protocol_text,
                   const std::string& path) {
  publish(path, [&](Hdf5File& file) {
    io::stamp(file, FileKind::records);
    io::Writer writer(file, "");
    describe(writer, result);
    writer.field("provenance/protocol", resolved_protocol_text, "-");
    writer.field("provenance/version", std::string(version), "-");
    writer.field("provenance/compiler", compiler(), "-");
    io::put_specimen(file, "/specimen", end_state);
  });
}

TestResult read_records(const std::string& path) {
  const auto file = open_records(path);
  TestResult result;
  io::Reader reader(file, "");
  describe(reader, result);
  return result;
}

std::string read_protocol_text(const std::string& path) {
  const auto file = open_records(path);
  std::string text;
  io::Reader(file, "").field("provenance/protocol", text, "-");
  return text;
}

}  // namespace rvelab
