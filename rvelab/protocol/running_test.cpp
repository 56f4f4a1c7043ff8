// The state of a running test. Declared in drive.hpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/error.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/measure/tensor_order.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/path.hpp"

namespace rvelab::protocol {
namespace {

/// A protocol whose stages lead back for ever is stopped.
constexpr std::int64_t most_visits = 1'000'000;

}  // namespace

MixedTarget mixed_target(const Matrix3& displacement_gradient, const std::vector<HeldStress>& held,
                         const Matrix3& stress, int dimension, bool held_before) {
  MixedTarget target;
  target.spin = 0.5 * (displacement_gradient - displacement_gradient.transpose());
  const Matrix3 strain = 0.5 * (displacement_gradient + displacement_gradient.transpose());
  for (int k = 0; k < component_count(dimension); ++k) {
    const auto [i, j] = component_axes(k, dimension);
    MixedTarget::Row row;
    row.strain = unit_strain(k, dimension);  // E with E : dE = dE_ij for symmetric dE
    row.value = strain(i, j);
    for (const HeldStress& component : held) {
      if (component.i != i || component.j != j) continue;
      row.stress = row.strain;
      row.strain.setZero();
      // From the stress as it is: what the increment before missed is made good, not carried on.
      row.value = component.target - 0.5 * (stress(i, j) + stress(j, i));
      if (held_before) row.missed = row.value;
      row.scale = component.scale;
    }
    target.rows.push_back(row);
  }
  return target;
}

RunningTest::RunningTest(const Protocol& protocol, const Specimen& specimen, const Watch& watch)
    : rve(specimen),
      loading(protocol.loading),
      watch_(watch),
      snapshots_every_(protocol.snapshots_every),
      quantities_(protocol.quantities),
      records_planned_(planned_records(protocol)) {
  run.result.protocol = protocol.name;
  for (const Stage& stage : protocol.stages) run.result.stages.push_back(stage.name);
  rve.watch(watch.stop);
  rve.share(watch.team);
  if (watch.measure_time) rve.measure_time(&times);
}

Error RunningTest::failed(const std::string& text) const { return Error("stage \"" + stage_->name + "\": " + text); }

void RunningTest::enter(const Stage& stage) {
  stage_ = &stage;
  records::Progress& at = run.progress;
  if (at.phase > 0) return;
  at.deformation = Matrix3::Identity();
  at.strain_sum = Matrix3::Zero();
  at.stress = at.first_stress = rve.stress();
  at.turns = at.place = 0;
  at.visits.resize(run.result.stages.size());
  if (++at.visits[std::size_t(at.stage)] > most_visits) {
    throw failed("was begun " + std::to_string(most_visits) + " times; let an event with quantity = \"visits\" end it");
  }
  at.largest.assign(stage.until.size(), std::numeric_limits<double>::lowest());
  at.first_pressure = mean_pressure(at.stress, dimension());
  at.substeps = 0;
  at.rate = loading.rate;
  if (loading.at_rate && loading.inertial_number > 0) {
    const Network network = rve.network();
    // I = rate d sqrt(rho/p), the inertial number (GDR MiDi 2004), with the driving strain's rate
    at.rate = at.first_pressure > 0 ? loading.inertial_number * std::sqrt(at.first_pressure / solid_density(network)) /
                                          mean_diameter(network)
                                    : 0;
  }
  at.phase = 1;
  at.step = 0;
}

int RunningTest::stage_number(const std::string& name) const {
  const auto& stages = run.result.stages;
  if (name.empty()) return run.progress.stage + 1;
  return int(std::find(stages.begin(), stages.end(), name) - stages.begin());  // "end": their number
}

void RunningTest::leave_stage() {
  records::Progress& at = run.progress;
  const Event* const event =
      at.phase > done_phase ? &stage_->until.at(std::size_t(at.phase - done_phase - 1)) : nullptr;
  if (event != nullptr) run.events.push_back(stage_->name + ": " + event_in_words(*event));
  at.stage = stage_number(event != nullptr ? event->then : stage_->then);
  at.phase = 0;
  at.step = 0;
  pause();
}

void RunningTest::step_done() {
  const int event = met_event(*this, *stage_);
  ++run.progress.step;
  if (event >= 0) run.progress.phase = done_phase + 1 + event;
  pause();
}

void RunningTest::pause() {
  clock();
  if (watch_.on_path_point) watch_.on_path_point({run.progress, run.result, rve, records_planned_, time_});
  if (watch_.stop != nullptr && watch_.stop->load()) throw Interrupted();
}

void RunningTest::expect_consolidated(const std::string& name, double found, double held) const {
  const double allowed = std::min(10 * loading.held_tolerance, 1.0) * with_bonds(held);
  if (std::abs(found - held) <= allowed) return;
  throw InputError(
      "stage \"" + stage_->name + "\": " + name + " = " + in_words(found) + " Pa where it starts, and it holds " +
      in_words(held) + " Pa; allowed: within " + in_words(allowed) +
      " Pa (ten times loading.held_tolerance), since a stress that jumps within one record is no test; bring "
      "the specimen there by a stage before it (kind = \"isotropic\", \"pressure_path\" or \"path\"), or "
      "give the stage the pressure that it starts from");
}

double RunningTest::held_scale(double target) const {
  const double scale = with_bonds(std::max(std::abs(target), 0.01 * std::abs(run.progress.first_pressure)));
  if (scale > 0) return scale;
  throw failed(
      "a stress of 0 Pa cannot be held from a state without pressure; allowed: a pressure > 0; compress first, or "
      "cement the grains");
}

double RunningTest::with_bonds(double scale, double factor) const {
  // Forces of bonds balance each other where there is no pressure: a thousandth of that of the reference state is
  // reported.
  const double least = 1e-3 * rve.reference_pressure() * factor;
  if (scale >= least) return scale;
  const Interactions all = rve.interactions();
  return static_cast<const ListOf<ParallelBond>&>(all).items.empty() ? scale : least;
}

double RunningTest::time_for(double strain_increment) const {
  if (!loading.at_rate) return 0;
  if (run.progress.rate > 0) return std::abs(strain_increment) / run.progress.rate;
  throw failed("loading.inertial_number gives no rate at p = " + std::to_string(run.progress.first_pressure) +
               " Pa; allowed: p > 0 at the start of the stage; give loading.rate_1_s");
}

Report RunningTest::apply(MixedTarget target, double dt, double tolerance) {
  target.tolerance = tolerance;
  return applied([&] { return rve.apply(target, dt); }, dt);
}

Report RunningTest::apply(const Matrix3& displacement_gradient, const std::vector<HeldStress>& held, double dt,
                          double tolerance, long wait) {
  if (!held.empty()) {
    // The first increment of a stage (step 1) brings the stress to where the others hold it.
    const bool held_before = run.progress.step > 1;
    MixedTarget target = mixed_target(displacement_gradient, held, run.progress.stress, dimension(), held_before);
    target.wait = wait;
    return apply(target, dt, tolerance);
  }
  return applied(
      [&] {
        Response response = rve.apply(displacement_gradient, dt);
        response.displacement_gradient = displacement_gradient;
        return response;
      },
      dt);
}

template <class Apply>
Report RunningTest::applied(Apply apply, double dt) {
  Response response;
  try {
    response = apply();
  } catch (const InvalidIncrement& error) {
    throw InvalidIncrement("stage \"" + stage_->name + "\": " + error.what());
  } catch (const IncrementFailed& error) {
    throw IncrementFailed("stage \"" + stage_->name + "\": " + error.what());
  }
  records::Progress& at = run.progress;
  at.deformation = (Matrix3::Identity() + response.displacement_gradient) * at.deformation;
  at.strain_sum += strain_increment(response.displacement_gradient, dimension());
  at.stress = response.stress;
  at.substeps += response.report.substeps;
  run.costs.substeps += response.report.substeps;
  run.costs.waited += response.report.waited;
  time_ += dt;
  return response.report;
}

Report RunningTest::relax(double unbalanced, long max_steps) {
  // Slices of about a second, between which a checkpoint can be taken. Each call of Rve::relax scales the masses anew,
  // so their length must depend on nothing but the specimen.
  constexpr long interval = 25, grain_steps = 20'000'000;
  const long slice = interval * std::clamp(grain_steps / (interval * long(rve.size() + 1)), 10L, 1000L);
  records::Progress& at = run.progress;
  while (true) {
    Report report = rve.relax(unbalanced, std::min(slice, max_steps - long(at.relaxation_steps)));
    at.stress = rve.stress();
    at.substeps += report.substeps;
    at.relaxation_steps += report.substeps;
    if (report.target_held || at.relaxation_steps >= max_steps) {
      report.substeps = at.relaxation_steps;
      at.relaxation_steps = 0;
      return report;
    }
    pause();
  }
}

void RunningTest::note_error(const Report& report, records::Record& record) {
  const double p = mean_pressure(run.progress.stress, dimension());
  if (!(report.error_estimate > 0 && p > 0)) return;
  Costs& costs = run.costs;
  const double error = record.error_estimate = report.error_estimate / p;
  costs.mean_error += (error - costs.mean_error) / double(++costs.judged);
  if (error <= costs.largest_error) return;
  costs.largest_error = error;
  costs.largest_error_strain = record.strain;
}

void RunningTest::record(double strain, const Report& report) {
  records::Record record;
  record.stage = run.progress.stage;
  record.strain = strain;
  record.deformation_gradient = run.progress.deformation;
  record.stress = run.progress.stress;
  record.quantities = quantities_;
  records::measure_quantities(record, rve);
  record.unbalanced_force_ratio = report.unbalanced_ratio;
  record.inertial_number = report.inertial_number;
  record.substeps = run.progress.substeps;
  record.held_error = report.held_error;
  record.target_held = report.target_held;
  record.quasi_static = report.in_equilibrium;
  record.cell_thin = rve.cell_thin();
  run.progress.substeps = 0;
  note_error(report, record);
  const std::size_t number = run.result.records.size();
  run.result.records.push_back(record);
  ++run.progress.records;
  if (watch_.on_record) watch_.on_record(record);
  if (watch_.on_snapshot && snapshots_every_ > 0 && number % std::size_t(snapshots_every_) == 0) {
    watch_.on_snapshot(number, rve.specimen());
  }
}

void RunningTest::probed(const Eigen::MatrixXd& stiffness) {
  run.result.probes.push_back({stage_->name, stiffness});
  ++run.progress.probes;
  if (watch_.on_probe) watch_.on_probe(run.result.probes.back());
}

void RunningTest::record_now(double strain) {
  Report report;
  report.unbalanced_ratio = rve.unbalanced_ratio();
  record(strain, report);
}

}  // namespace rvelab::protocol
