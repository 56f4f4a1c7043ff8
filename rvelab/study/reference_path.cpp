#include "rvelab/study/reference_path.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rvelab/error.hpp"

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

  /// Keeps the state of a moment if it is that of a record, and of one to be kept.
  void take(const protocol::Moment& moment) {
    const std::size_t records = moment.result.records.size();
    if (records == times_.size()) return;
    times_.resize(records, moment.time);
    const std::size_t record = records - 1;
    if (count_ == 0 || record % stride_ != 0) return;
    met_.push_back({record, moment.progress.deformation, moment.rve.specimen()});
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

}  // namespace

std::vector<std::size_t> increments_of_stages(const protocol::Protocol& protocol) {
  std::vector<std::size_t> increments;
  for (const protocol::Stage& stage : protocol.stages) {
    protocol::Protocol alone;
    alone.stages = {stage};
    increments.push_back(std::max<std::size_t>(protocol::planned_records(alone), 1) - 1);
  }
  return increments;
}

std::vector<long> longest_increments(const protocol::Protocol& reference,
                                     const std::vector<protocol::Protocol>& protocols) {
  const auto own = increments_of_stages(reference);
  std::vector<long> spans(own.size(), 1);
  for (const protocol::Protocol& protocol : protocols) {
    const auto increments = increments_of_stages(protocol);
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (own[k] == 0 || increments[k] == 0) continue;
      const double ratio = static_cast<double>(own[k]) / static_cast<double>(increments[k]);
      spans[k] = std::max(spans[k], std::lround(ratio));
    }
  }
  return spans;
}

long parts_of(const protocol::Protocol& protocol, const protocol::Protocol& reference, std::int32_t stage,
              long records) {
  const auto row = static_cast<std::size_t>(stage);
  const std::size_t mine = increments_of_stages(protocol).at(row), own = increments_of_stages(reference).at(row);
  if (mine == 0 || own == 0) return 1;
  const double parts = static_cast<double>(records) * static_cast<double>(mine) / static_cast<double>(own);
  return std::max(1L, std::lround(parts));
}

ReferencePath reference_path(const protocol::Protocol& protocol, const Specimen& specimen, std::size_t count,
                             const std::vector<long>& spans, protocol::Watch watch) {
  Keeping keeping(count);
  watch.on_moment = [&, shown = watch.on_moment](const protocol::Moment& moment) {
    if (shown) shown(moment);
    keeping.take(moment);
  };
  ReferencePath path;
  path.run = protocol::run_protocol(protocol, specimen, watch);
  if (!path.run.complete) throw Interrupted();
  if (count == 0) return path;

  const std::vector<records::Record>& records = path.run.result.records;
  const auto span_at = [&](std::size_t record) { return spans.at(static_cast<std::size_t>(records[record].stage)); };
  auto& met = keeping.met();
  std::erase_if(met, [&](const Keeping::Met& one) {
    return !same_visit(records, one.record, one.record + static_cast<std::size_t>(span_at(one.record)));
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
    const std::size_t end = one.record + static_cast<std::size_t>(span);
    const Matrix3 gradient = records[end].deformation_gradient * one.deformation.inverse() - Matrix3::Identity();
    path.states.push_back({std::move(one.state), records[one.record].stage, records[one.record].strain, gradient,
                           keeping.time_at(end) - keeping.time_at(one.record), span});
  }
  return path;
}

}  // namespace rvelab::study
