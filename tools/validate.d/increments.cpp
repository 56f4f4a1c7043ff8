// Increments of displacement gradient from one state, over settings of the solver: stress and processor time of
// Rve::apply (tools/validate yade_increments). Before each call the state is restored from a snapshot; timed is the
// whole call: sub-steps, equilibrium checks and estimate, and the first scaling of the masses too, unless the
// setting says `warm`: then that has been done before.
//
//   rvelab-increments STATE.h5 JOB.json     prints JSON
//
// JOB.json: increments [dH, 2 x 2], settings [{relative_tolerance, absolute_tolerance, fixed_substeps, damping,
// time_step, warm, only: number of the increment}], repeats, resolved [sub-steps of an answer that is then relaxed],
// beside: how often to time what a host may ask beside the call.
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/solver/rve.hpp"

using namespace rvelab;
using Json = nlohmann::json;

namespace {

/// Of this thread, s.
double processor_time() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

Matrix3 gradient(const Json& rows) {
  Matrix3 m = Matrix3::Zero();
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) m(i, j) = rows[std::size_t(i)][std::size_t(j)].get<double>();
  return m;
}

Json in_plane(const Matrix3& stress) { return {{stress(0, 0), stress(0, 1)}, {stress(1, 0), stress(1, 1)}}; }

Specimen with(Specimen specimen, const Json& setting) {
  SolverOptions& o = specimen.solver;
  o.relative_tolerance = setting.value("relative_tolerance", o.relative_tolerance);
  o.absolute_tolerance = setting.value("absolute_tolerance", o.absolute_tolerance);
  o.fixed_substeps = setting.value("fixed_substeps", 0L);
  o.time_step_factor = setting.value("time_step", o.time_step_factor);
  double& damping = specimen.damping.local_quasi_static;
  damping = setting.value("damping", damping);
  return specimen;
}

Json resolved(const Specimen& state, const Matrix3& increment, long substeps) {
  Rve rve(with(state, {{"fixed_substeps", substeps}}));
  rve.apply(increment, 0);
  const Report made = rve.relax(1e-9, 1'000'000);
  return {{"steps", substeps},
          {"relax_steps", made.substeps},
          {"unbalanced", made.unbalanced_ratio},
          {"stress", in_plane(rve.stress())}};
}

Json point(const Specimen& state, const Matrix3& increment, const Json& setting, long repeats) {
  Rve rve(with(state, setting));
  if (setting.value("warm", false)) rve.relax(1, 0);  // makes no sub-step
  const std::vector<std::byte> snapshot = rve.save();
  Response made;
  std::vector<double> seconds;
  for (long k = 0; k < repeats; ++k) {
    rve.restore(snapshot);
    const double begin = processor_time();
    made = rve.apply(increment, 0);
    seconds.push_back(processor_time() - begin);
  }
  Json found = setting;
  found["seconds"] = seconds;
  found["stress"] = in_plane(made.stress);
  found["substeps"] = made.report.substeps;
  found["estimate"] = made.report.error_estimate;
  found["allowed"] = made.report.allowed_error;
  return found;
}

/// What a host pays beside the call: a snapshot and its way back.
Json beside(const Specimen& state, long repeats) {
  Rve rve(state);
  Json found = {{"save", Json::array()}, {"restore", Json::array()}, {"snapshot_bytes", rve.save().size()}};
  for (long k = 0; k < repeats; ++k) {
    const double begin = processor_time();
    const std::vector<std::byte> snapshot = rve.save();
    const double saved = processor_time();
    rve.restore(snapshot);
    found["save"].push_back(saved - begin);
    found["restore"].push_back(processor_time() - saved);
  }
  return found;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: rvelab-increments STATE.h5 JOB.json\n", stderr);
    return 2;
  }
  const Specimen state = io::read_specimen(argv[1]);
  const Json job = Json::parse(std::ifstream(argv[2]));
  const long repeats = job.at("repeats").get<long>();
  Json found = Json::array();
  for (const Json& rows : job.at("increments")) {
    const Matrix3 increment = gradient(rows);
    Json of = {{"start", in_plane(Rve(state).stress())},
               {"resolved", Json::array()},
               {"points", Json::array()},
               {"beside", beside(state, job.value("beside", 0L))}};
    for (const Json& steps : job.value("resolved", Json::array()))
      of["resolved"].push_back(resolved(state, increment, steps.get<long>()));
    for (const Json& setting : job.at("settings")) {
      if (setting.contains("only") && setting["only"].get<std::size_t>() != found.size()) continue;
      of["points"].push_back(point(state, increment, setting, repeats));
    }
    found.push_back(of);
  }
  std::puts(found.dump().c_str());
  return 0;
}
