#include "rvelab/h5/run_stages.hpp"

#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/keys/toml_source.hpp"
#include "rvelab/protocol/run.hpp"

namespace rvelab::h5 {

namespace {

constexpr const char* source = "stages";  ///< in the place of a path, in messages

protocol::Protocol read_stages(const std::string& text) {
  std::string whole = text;
  try {  // at the end, so that lines keep their numbers
    if (!keys::parse_toml(text).contains("test")) whole += "\n[test]\nname = \"stages\"\n";
  } catch (const toml::parse_error&) {  // parse_protocol says where
  }
  protocol::Protocol protocol = protocol::parse_protocol(whole, source);
  if (!protocol.specimen_file.empty())
    throw InputError(std::string(source) + ": specimen.file is given; allowed: none, since the RVE is the specimen");
  protocol.quantities = 0;  // no record is kept
  protocol.snapshots_every = 0;
  return protocol;
}

}  // namespace

void check_stages(const std::string& text) { read_stages(text); }

std::int64_t run_stages(Specimen& specimen, const std::string& text, const std::atomic<bool>& stop) {
  const protocol::Protocol protocol = read_stages(text);
  try {
    protocol::Watch watch;
    watch.stop = &stop;
    protocol::TestRun run = protocol::run_protocol(protocol, specimen, watch);
    if (!run.complete) throw Interrupted();
    specimen = std::move(run.end_state);
    return std::int64_t(run.result.grain_steps);
  } catch (const InputError&) {
    throw;
  } catch (const IncrementFailed&) {
    throw;
  } catch (const Interrupted&) {
    throw;
  } catch (
      const Error& error) {  // a stage that does not get there: the state is as before, as where an increment fails
    throw IncrementFailed(error.what());
  }
}

}  // namespace rvelab::h5
