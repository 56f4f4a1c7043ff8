#include "rvelab/study/increments.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/study/measures.hpp"

namespace rvelab::study {

namespace {

/// States of the path. If there are more than twice as many as asked for, every other one is dropped.
class Keeping {
 public:
  struct Met {
    std::size_t record;
    Matrix3 deformation;  ///< F since the start of the stage
    Specimen state;
  };

  explicit Keeping(std::size_t count) : count_(count) {}

  /// Keeps the state at a point if it is that of a record, and of one to be kept.
  void take(const protocol::PathPoint& reached) {
    const std::size_t records = reached.result.records.size();
    if (records == times_.size()) return;
    times_.resize(records, reached.time);
    const std::size_t record = records - 1;
    if (count_ == 0 || record % stride_ != 0) return;
    met_.push_back({record, reached.progress.deformation, reached.rve.specimen()});
    if (met_.size() <= 2 * count_) return;
    stride_ *= 2;
    std::erase_if(met_, [&](const Met& one) { return one.record % stride_ != 0; });
  }

  std::vector<Met>& met() { return met_; }
  double time_at(std::size_t record) const { return times_.at(record); }

 private:
  std::size_t count_, stride_ = 1;
  std::vector<Met> met_;
  std::vector<double> times_;  ///< s, from the start of the test to each record
};

/// A stage begins with a record that no sub-step led to.
bool begins_stage(const records::Record& record) {
  return record.substeps == 0 && record.deformation_gradient.isIdentity(0);
}

/// True if a visit of a stage goes on from one record to another.
bool same_visit(const std::vector<records::Record>& records, std::size_t from, std::size_t to) {
  if (to >= records.size()) return false;
  for (std::size_t k = from + 1; k <= to; ++k) {
    if (records[k].stage != records[from].stage || begins_stage(records[k])) return false;
  }
  return true;
}

/// Records that each stage of a protocol makes where no event ends it, less the first: its increments.
std::vector<std::size_t> increments_of_stages(const protocol::Protocol& protocol) {
  std::vector<std::size_t> increments;
  for (const protocol::Stage& stage : protocol.stages) {
    protocol::Protocol alone;
    alone.stages = {stage};
    increments.push_back(std::max<std::size_t>(protocol::planned_records(alone), 1) - 1);
  }
  return increments;
}

}  // namespace

std::vector<long> longest_increments(const protocol::Protocol& reference,
                                     const std::vector<protocol::Protocol>& protocols) {
  const auto own = increments_of_stages(reference);
  std::vector<long> spans(own.size(), 1);
  for (const protocol::Protocol& protocol : protocols) {
    const auto increments = increments_of_stages(protocol);
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (own[k] == 0 || increments[k] == 0) continue;
      const double ratio = double(own[k]) / double(increments[k]);
      spans[k] = std::max(spans[k], std::lround(ratio));
    }
  }
  return spans;
}

long parts_of(const protocol::Protocol& protocol, const protocol::Protocol& reference, std::int32_t stage,
              long records) {
  const auto row = std::size_t(stage);
  const std::size_t mine = increments_of_stages(protocol).at(row), own = increments_of_stages(reference).at(row);
  if (mine == 0 || own == 0) return 1;
  const double parts = double(records) * double(mine) / double(own);
  return std::max(1L, std::lround(parts));
}

ReferencePath reference_path(const protocol::Protocol& protocol, const Specimen& specimen, std::size_t count,
                             const std::vector<long>& spans, protocol::Watch watch) {
  Keeping keeping(count);
  watch.on_path_point = [&, shown = watch.on_path_point](const protocol::PathPoint& reached) {
    if (shown) shown(reached);
    keeping.take(reached);
  };
  ReferencePath path;
  path.run = protocol::run_protocol(protocol, specimen, watch);
  if (!path.run.complete) throw Interrupted();
  if (count == 0) return path;

  const std::vector<records::Record>& records = path.run.result.records;
  const auto span_at = [&](std::size_t record) { return spans.at(std::size_t(records[record].stage)); };
  auto& met = keeping.met();
  std::erase_if(met, [&](const Keeping::Met& one) {
    return !same_visit(records, one.record, one.record + std::size_t(span_at(one.record)));
  });
  if (met.empty()) {
    throw InputError(protocol.path +
                     ": the path makes no increment between two records of one stage; allowed: a stage that drives a "
                     "strain or a stress; give one, or --increments 0 for whole paths alone");
  }
  const std::size_t kept = std::min(count, met.size());
  for (std::size_t k = 0; k < kept; ++k) {
    Keeping::Met& one = met[k * met.size() / kept];
    const long span = span_at(one.record);
    const std::size_t end = one.record + std::size_t(span);
    const Matrix3 gradient = records[end].deformation_gradient * one.deformation.inverse() - Matrix3::Identity();
    path.states.push_back({std::move(one.state), records[one.record].stage, records[one.record].strain, gradient,
                           keeping.time_at(end) - keeping.time_at(one.record), span});
  }
  return path;
}

namespace {

/// The state with the parameters of the specimen as it was given, and the settings over them.
Specimen opened(const Specimen& state, const Opening& opening) {
  Specimen specimen = state;
  specimen.materials = opening.specimen.materials;
  specimen.contact = opening.specimen.contact;
  specimen.damping = opening.specimen.damping;
  specimen.solver = opening.specimen.solver;
  return protocol::with_overrides(opening.protocol, std::move(specimen));
}

/// Straight in F, in equal parts.
Made applied(Rve& rve, const PathState& from, long parts) {
  const Matrix3 identity = Matrix3::Identity();
  const auto at = [&](long part) -> Matrix3 {
    return identity + double(part) / double(parts) * from.displacement_gradient;
  };
  const double time = from.time / double(parts);
  const std::uint64_t grain_steps = rve.grain_steps();
  Made made;
  for (long part = 1; part <= parts; ++part) {
    const Matrix3 gradient =
        parts == 1 ? from.displacement_gradient : Matrix3(at(part) * at(part - 1).inverse() - identity);
    const double begin = processor_seconds();
    const Response response = rve.apply(gradient, time);
    made.seconds += processor_seconds() - begin;
    made.stress = response.stress;
    made.estimate = time == 0 ? response.report.error_estimate : no_value;
    made.allowed = time == 0 ? response.report.allowed_error : no_value;
  }
  made.grain_steps = double(rve.grain_steps() - grain_steps);
  return made;
}

}  // namespace

Made made_increment(const PathState& from, const Opening& opening) {
  Rve rve(opened(from.state, opening));
  rve.watch(opening.stop);
  return applied(rve, from, opening.parts);
}

Answer reference_answer(const PathState& from, const Opening& opening, const Relaxation& relaxation) {
  const Specimen specimen = opened(from.state, opening);
  Rve rve(specimen);
  rve.watch(opening.stop);
  const Matrix3 start = rve.stress();
  Answer answer;
  answer.made = applied(rve, from, opening.parts);
  if (from.time == 0) answer.at_rest = rve.relax(relaxation.unbalanced, relaxation.max_steps).target_held;
  answer.stress = rve.stress();
  answer.pressure = std::abs(mean_pressure(answer.stress, specimen.cell.dimension));
  answer.increment = (answer.stress - start).norm();
  return answer;
}

}  // namespace rvelab::study
