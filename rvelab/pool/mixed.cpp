#include "rvelab/pool/mixed.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rvelab/pool/threaded_pool.hpp"
#include "rvelab/pool/warnings.hpp"

namespace rvelab::pool {

namespace {

MixedTarget target_of(const MixedSetting& setting, const std::vector<MixedRow>& rows) {
  MixedTarget target;
  if (setting.tolerance != 0) target.tolerance = setting.tolerance;
  target.spin = tensor_at(setting.spin);
  for (const MixedRow& row : rows)
    target.rows.push_back({tensor_at(row.strain), tensor_at(row.stress), row.value, row.scale, row.missed});
  return target;
}

/// Of entry m.
std::vector<MixedRow> rows_of(const rvelab_mixed& batch, std::size_t m) {
  std::vector<MixedRow> rows(static_cast<std::size_t>(batch.rows));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t at = m * rows.size() + k;
    std::copy_n(batch.strain + 9 * at, 9, rows[k].strain);
    std::copy_n(batch.stress + 9 * at, 9, rows[k].stress);
    rows[k].value = batch.value[at];
    rows[k].scale = batch.scale[at];
    rows[k].missed = batch.missed == nullptr ? 0 : batch.missed[at];
  }
  return rows;
}

void expect_mixed(const rvelab_mixed& batch) {
  if (batch.n < 0) throw Refused(Status::bad_input, "mixed.n is " + std::to_string(batch.n) + "; allowed: 0 or more");
  if (batch.rows != 3 && batch.rows != 6)
    throw Refused(Status::bad_input, "mixed.rows is " + std::to_string(batch.rows) + "; allowed: 3 in 2D, 6 in 3D");
  expect_time(batch.dt);
}

}  // namespace

Verdict each_entry(Pool& pool, const char* name, std::int64_t count, const std::int64_t* ids, std::int32_t* status,
                   const std::function<void(std::size_t, Verdict&)>& call) {
  const auto n = std::size_t(count);
  std::vector<std::int64_t> sorted(ids, ids + n);
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    throw Refused(Status::duplicate, std::string(name) + ": id " + std::to_string(*twice) +
                                         " stands twice in one call; give each RVE once");
  std::vector<Verdict> verdicts(n);
  pool.run_each(n, [&](std::size_t m) {
    try {
      call(m, verdicts[m]);
    } catch (...) {
      verdicts[m] = verdict_of_failure();
    }
  });
  std::size_t worst = 0;
  for (std::size_t m = 0; m < n; ++m) {
    if (status != nullptr) status[m] = std::int32_t(verdicts[m].status);
    if (severity(verdicts[m].status) > severity(verdicts[worst].status)) worst = m;
  }
  if (n == 0) return {};
  return of_entry(std::move(verdicts[worst]), std::int64_t(worst), ids[worst]);
}

Verdict apply_mixed(Pool& pool, const rvelab_mixed& batch) {
  expect_mixed(batch);
  return each_entry(pool, "apply_mixed", batch.n, batch.ids, batch.status, [&](std::size_t m, Verdict& verdict) {
    MixedSetting setting{batch.dt, batch.tolerance, {}};
    if (batch.spin != nullptr) std::copy_n(batch.spin + 9 * m, 9, setting.spin);
    const MixedDone done = pool.at<&Share::apply_mixed>(batch.ids[m], setting, rows_of(batch, m));
    std::copy_n(done.sigma, 9, batch.sigma + 9 * m);
    if (batch.dH != nullptr) std::copy_n(done.displacement_gradient, 9, batch.dH + 9 * m);
    if (batch.held_error != nullptr) batch.held_error[m] = done.held_error;
    if (batch.error_estimate != nullptr) batch.error_estimate[m] = done.error_estimate;
    if (batch.tokens_out != nullptr) batch.tokens_out[m] = done.token;
    verdict.status = Status(done.status);
    put_before(verdict, done.text);
  });
}

/// One call that changes the committed state at once: change(rve) makes it and returns its report. Its token. What
/// comes after the change asks for no memory.
template <class Change>
std::int64_t ThreadedPool::go_on(std::int64_t id, const Change& change) {
  const AtWork working(*this);
  const Hold hold = held(id, ++serial_);
  Resident& resident = hold.resident();
  resident.rve.revert();
  resident.pending = false;
  hold.slot().allocated.store(true, std::memory_order_relaxed);
  Report report;
  {
    const Cost cost(hold.slot());
    report = change(resident.rve);
  }
  resident.last = {report.inertial_number, report.error_estimate};
  called(hold.slot(), report.substeps);
  return resident.tokens.go_on();
}

MixedDone ThreadedPool::apply_mixed(std::int64_t id, const MixedSetting& setting, const std::vector<MixedRow>& rows) {
  const MixedTarget target = target_of(setting, rows);
  MixedDone done{};
  done.token = go_on(id, [&](Rve& rve) {
    const Response response = rve.apply(target, setting.dt);
    const Report& report = response.report;
    store(response.stress, done.sigma);
    store(response.displacement_gradient, done.displacement_gradient);
    done.held_error = report.held_error;
    done.error_estimate = report.error_estimate;
    if (has_warning(report, setting.dt))
      done.status = std::int64_t(write_warning(report, setting.dt, done.text, sizeof done.text));
    return report;
  });
  return done;
}

RelaxDone ThreadedPool::relax(std::int64_t id, double unbalanced, std::int64_t max_substeps) {
  if (!(unbalanced > 0 && std::isfinite(unbalanced)))
    throw Refused(Status::bad_input, "relax: unbalanced is " + in_words(unbalanced) + "; allowed: above 0");
  if (max_substeps < 1)
    throw Refused(Status::bad_input, "relax: max_substeps is " + std::to_string(max_substeps) + "; allowed: 1 or more");
  RelaxDone done{};
  go_on(id, [&](Rve& rve) {
    Rve relaxed(rve);  // to read its stress asks for memory, once the steps are made
    const Report report = relaxed.relax(unbalanced, long(max_substeps));
    store(relaxed.stress(), done.sigma);
    rve = std::move(relaxed);
    done.unbalanced = report.unbalanced_ratio;
    done.substeps = report.substeps;
    done.reached = report.target_held;
    return report;
  });
  return done;
}

}  // namespace rvelab::pool
