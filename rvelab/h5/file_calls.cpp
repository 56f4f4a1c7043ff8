#include "rvelab/h5/file_calls.hpp"

#include <dlfcn.h>

#include <string>
#include <utility>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/archive.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/keys/parameters.hpp"
#include "rvelab/keys/toml_source.hpp"
#include "rvelab/pool/pool.hpp"
#include "rvelab/pool/rve_state.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::h5 {

namespace {

/// One row for each RVE.
struct Rows {
  std::vector<std::int64_t> id, token, next_token;
  std::vector<double> initial_void_ratio, inertial_number, error_estimate;
};

/// One row for each trial that is kept, in the order of RVEs and tokens.
struct Trials {
  std::vector<std::int64_t> rve, token;  ///< rve: row of the RVE
  std::vector<double> dt;
  std::vector<Matrix3> displacement_gradient;
};

template <class Archive, class AnyRows, class AnyTrials, class Numbers>
void describe(Archive& archive, AnyRows& rows, AnyTrials& trials, Numbers& tag, Numbers& generation) {
  archive.field("pool/tag", tag, "1");
  archive.field("pool/generation", generation, "1");
  archive.field("pool/id", rows.id, "1");
  archive.field("pool/token", rows.token, "1");
  archive.field("pool/next_token", rows.next_token, "1");
  archive.field("pool/initial_void_ratio", rows.initial_void_ratio, "1");
  archive.field("pool/inertial_number", rows.inertial_number, "1");
  archive.field("pool/error_estimate_Pa", rows.error_estimate, "Pa");
  archive.field("pool/trials/rve", trials.rve, "1");
  archive.field("pool/trials/token", trials.token, "1");
  archive.field("pool/trials/dt_s", trials.dt, "s");
  archive.field("pool/trials/displacement_gradient", trials.displacement_gradient, "1");
}

std::string group_of(std::size_t k) { return std::string(io::pool_rves) + "/" + std::to_string(k); }

/// Writes a pool file, described in rvelab/io/README.md. `state(k)`: bytes of the
/// k-th RVE (pool::to_bytes). Throws InputError or Error as io::write_specimen; the file is then as it was.
void write_pool(const std::string& path, const pool::Population& population, const pool::Pool::StateOf& state) {
  io::publish(path, [&](io::Hdf5File& file) {
    io::stamp(file, io::pool_format);
    Rows rows;
    Trials trials;
    for (std::size_t k = 0; k < population.ids.size(); ++k) {
      const pool::RveState rve = pool::rve_state_of(state(k));
      rows.id.push_back(population.ids[k]);
      rows.token.push_back(rve.tokens.committed());
      rows.next_token.push_back(rve.tokens.next());
      rows.initial_void_ratio.push_back(rve.initial_void_ratio);
      rows.inertial_number.push_back(rve.last.inertial_number);
      rows.error_estimate.push_back(rve.last.error_estimate);
      for (int t = 0; t < rve.tokens.trials(); ++t) {
        const pool::TrialRecord& trial = rve.tokens.trial(t);
        trials.rve.push_back(std::int64_t(k));
        trials.token.push_back(trial.token);
        trials.dt.push_back(trial.dt);
        trials.displacement_gradient.push_back(trial.displacement_gradient);
      }
      io::put_specimen(file, group_of(k), rve.specimen);
    }
    const std::vector<std::int64_t> tag{population.tag};
    const std::vector<std::int64_t> generation(population.generations.begin(), population.generations.end());
    io::Writer writer(file, "");
    describe(writer, rows, trials, tag, generation);
  });
}

/// Shows the bytes of each RVE to `take`, in the order of the ids. InputError: missing, damaged, of another format, no
/// pool file.
pool::Population read_pool(const std::string& path, const pool::Pool::TakeState& take) {
  const auto file = io::Hdf5File::open(path);
  io::check_format(file, io::pool_format);
  Rows rows;
  Trials trials;
  std::vector<std::int64_t> tag, generation;
  io::Reader reader(file, "");
  describe(reader, rows, trials, tag, generation);
  const auto expect = [&](bool holds, const char* what) {
    if (!holds) throw InputError(path + ": " + what + "; the file is damaged: write it again");
  };
  const std::size_t n = rows.id.size(), kept = trials.rve.size();
  expect(tag.size() == 1 && tag[0] >= 0 && rows.token.size() == n && rows.next_token.size() == n &&
             rows.initial_void_ratio.size() == n && rows.inertial_number.size() == n && rows.error_estimate.size() == n,
         "the datasets under /pool have different lengths");
  expect(trials.token.size() == kept && trials.dt.size() == kept && trials.displacement_gradient.size() == kept,
         "the datasets under /pool/trials have different lengths");
  std::size_t next = 0;
  for (std::size_t k = 0; k < n; ++k) {
    pool::RveState rve{io::get_specimen(file, group_of(k)),
                       {},
                       rows.initial_void_ratio[k],
                       {rows.inertial_number[k], rows.error_estimate[k]}};
    rve.tokens.restore(rows.token[k], rows.next_token[k]);
    for (; next < kept && trials.rve[next] == std::int64_t(k); ++next) {
      expect(rve.tokens.trials() < pool::Tokens::kept, "an RVE has more trials than are kept");
      rve.tokens.add_again({trials.token[next], trials.displacement_gradient[next], trials.dt[next]});
    }
    take(pool::to_bytes(rve, rvelab::to_bytes(rve.specimen)));
  }
  expect(next == kept, "/pool/trials/rve is not in the order of the RVEs");
  pool::Population population;
  population.tag = std::uint32_t(tag[0]);
  for (const std::int64_t of_slot : generation) population.generations.push_back(std::uint32_t(of_slot));
  population.ids = rows.id;
  return population;
}

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

/// InputError where they are not stages, or wrong in themselves.
void check_stages(const std::string& text) { read_stages(text); }

/// Runs them as `rvelab run` does; the specimen becomes its end state. The text is that of a protocol; [test] may be
/// missing. Returns the grain-steps made. InputError: keys, values, what does not go with the specimen.
/// IncrementFailed: a stage cannot be carried out. Interrupted: `stop` came true. The specimen is then as it was.
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
  } catch (const Error& error) {
    // A stage that does not get there: the state is as before, as where an increment fails.
    throw IncrementFailed(error.what());
  }
}

}  // namespace

}  // namespace rvelab::h5

const rvelab::h5::FileCalls* rvelab_h5_file_calls() {
  using namespace rvelab::h5;
  static const FileCalls calls{rvelab::io::version,
                               rvelab::io::read_specimen,
                               write_pool,
                               read_pool,
                               rvelab::keys::parameters_text,
                               rvelab::keys::set_parameters,
                               check_stages,
                               run_stages,
                               dlsym(RTLD_DEFAULT, "H5check_version")};
  return &calls;
}
