#include "tools/mpm/materials/grain_pool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/mpm/keys/keys.hpp"

namespace mpm {
namespace {

void run_tasks(void* host, rvelab_task task, void* work, std::int64_t count) {
  static_cast<rvelab::Workers*>(host)->for_each_in_turn(count, [&](std::int64_t k) { task(work, k); });
}

/// A trial of one RVE from its committed state; its status.
std::int32_t try_one(rvelab_pool* pool, std::int64_t id, const double* dH, double* sigma, double* tangent) {
  rvelab_batch batch;
  expect_ok(rvelab_batch_init(&batch, sizeof batch));
  batch.n = 1;
  batch.ids = &id;
  batch.dH = dH;
  batch.sigma = sigma;
  batch.tangent = tangent;
  return rvelab_trial(pool, &batch);
}

}  // namespace

void expect_ok(std::int32_t status) {
  if (status < RVELAB_OK) throw InputError(std::string(rvelab_status_name(status)) + ": " + rvelab_last_error());
}

void read_state(rvelab_pool* pool, std::int64_t id, double* sigma, double* tangent) {
  const double zero[9] = {};
  expect_ok(try_one(pool, id, zero, sigma, tangent));
  expect_ok(rvelab_revert(pool, 1, &id));
}

GrainPool::GrainPool(rvelab::Workers& workers, const GrainOptions& options) {
  rvelab_pool_def def;
  expect_ok(rvelab_pool_def_init(&def, sizeof def));
  def.tolerance_rel = options.tolerance_rel;
  def.tolerance_abs = options.tolerance_abs;
  def.workers = 1;
  def.run_tasks = run_tasks;
  def.host = &workers;
  def.flags = RVELAB_POOL_COUNTED_IDS;  // the files of a scene have the same bytes in each run
  expect_ok(options.source.create(&def, &pool_));
}

GrainPool::~GrainPool() { rvelab_pool_destroy(pool_); }

rvelab_info GrainPool::info(std::int64_t id) const {
  rvelab_info info;
  expect_ok(rvelab_info_init(&info, sizeof info));
  expect_ok(rvelab_get_info(pool_, id, &info));
  return info;
}

void GrainPool::write(const std::string& path) const {
  if (rvelab_pool_write(pool_, path.c_str()) < RVELAB_OK) throw std::runtime_error(rvelab_last_error());
}
void GrainPool::read(const std::string& path) { expect_ok(rvelab_pool_read(pool_, path.c_str())); }

std::int64_t GrainPool::copy_from(const GrainPool& other, std::int64_t id) const {
  std::size_t size = 0;
  expect_ok(rvelab_snapshot_save(other.get(), id, nullptr, 0, &size));
  std::vector<unsigned char> state(size);
  expect_ok(rvelab_snapshot_save(other.get(), id, state.data(), size, &size));
  std::int64_t tmpl = 0, copy = 0;
  expect_ok(rvelab_template_from_snapshot(pool_, state.data(), size, &tmpl));
  expect_ok(rvelab_spawn(pool_, tmpl, 1, &copy));
  return copy;
}

void GrainPool::write_alone(std::int64_t id, const std::string& path) const {
  // In this process, also where the RVEs themselves are spread over ranks.
  rvelab::Workers here(1);
  const GrainPool alone(here, {});
  alone.copy_from(*this, id);
  alone.write(path);
}

double wave_modulus_of(const GrainPool& pool, std::int64_t id) {
  double sigma[9], tangent[36];
  read_state(pool.get(), id, sigma, tangent);
  return std::max({tangent[0], tangent[7], tangent[14]});
}

double measured_modulus_of(const GrainPool& pool, std::int64_t id, int dimension) {
  constexpr double strain = 1e-5;
  double largest = 0;
  const rvelab_info at_rest = pool.info(id);
  for (int axis = 0; axis < dimension; ++axis) {
    const double rest = at_rest.sigma[4 * axis];
    double slope[2];
    for (const int side : {0, 1}) {
      double dH[9] = {}, moved[9];
      dH[4 * axis] = side == 0 ? strain : -strain;
      const auto status = try_one(pool.get(), id, dH, moved, nullptr);
      if (status == RVELAB_DISCARD) return 0;
      expect_ok(status);
      slope[side] = (moved[4 * axis] - rest) / dH[4 * axis];
    }
    // Grains that slip make one side soft, a state that drifts makes one too stiff: then by at most a factor of two.
    largest = std::max(largest, std::min(std::max(slope[0], slope[1]), slope[0] + slope[1]));
  }
  expect_ok(rvelab_revert(pool.get(), 1, &id));
  return largest;
}

SpecimenFamily::SpecimenFamily(std::shared_ptr<GrainPool> pool, const std::vector<std::string>& paths)
    : pool_(std::move(pool)), preparation_(thread_, {}) {
  for (const auto& path : paths) {
    std::int64_t tmpl = 0, id = 0;
    expect_ok(rvelab_template_load(preparation_.get(), path.c_str(), &tmpl));
    expect_ok(rvelab_spawn(preparation_.get(), tmpl, 1, &id));
    specimens_.push_back({tmpl, preparation_.info(id).p});
    expect_ok(rvelab_release(preparation_.get(), 1, &id));
  }
}

std::int64_t SpecimenFamily::moved_to_scene(std::int64_t id) {
  const std::int64_t copy = pool_->copy_from(preparation_, id);
  expect_ok(rvelab_release(preparation_.get(), 1, &id));
  return copy;
}

std::int64_t SpecimenFamily::prepare(double pressure) {
  std::vector<Specimen> nearest_first = specimens_;
  const auto apart = [&](const Specimen& s) {
    return s.pressure > 0 ? std::abs(std::log(s.pressure / pressure)) : std::numeric_limits<double>::infinity();
  };
  if (pressure > 0)
    std::stable_sort(nearest_first.begin(), nearest_first.end(),
                     [&](const Specimen& one, const Specimen& other) { return apart(one) < apart(other); });
  for (const Specimen& from : nearest_first) {
    std::int64_t id = 0;
    expect_ok(rvelab_spawn(preparation_.get(), from.tmpl, 1, &id));
    if (pressure <= 0 || brought_to(pressure, id)) return moved_to_scene(id);
    expect_ok(rvelab_release(preparation_.get(), 1, &id));
  }
  throw InputError("a specimen at " + in_words(nearest_first.front().pressure) + " Pa does not come to " +
                   in_words(pressure) + " Pa" + (nearest_first.size() > 1 ? ", and none of the others does" : "") +
                   "; pack one nearer to that pressure (rvelab pack, target.pressures_Pa) and name it in specimens");
}

bool SpecimenFamily::brought_to(double pressure, std::int64_t id) {
  const int d = int(preparation_.info(id).dimension);
  // Symmetric strains in the tangent's order; in the plane xx, yy, xy.
  const std::vector<int> rows = d == 2 ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
  const int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
  const long n = long(rows.size());
  double sigma[9], tangent[36], start = 0;
  for (int round = 0; round < 200; ++round) {
    read_state(preparation_.get(), id, sigma, tangent);
    double now = 0;
    for (int i = 0; i < d; ++i) now -= sigma[4 * i] / d;
    if (round == 0) start = now;
    if (!(now > 1e-3 * std::min(pressure, start))) return false;  // the grains have lost their contacts
    // In steps of a fifth of the pressure at most, since the network changes.
    const double aim = std::min(std::max(pressure, now / 1.2), now * 1.2);
    Eigen::MatrixXd C(n, n);
    Eigen::VectorXd missing(n);
    for (long i = 0; i < n; ++i) {
      const int r = rows[i];
      missing[i] = (r < 3 ? -aim : 0) - 0.5 * (sigma[3 * first[r] + second[r]] + sigma[3 * second[r] + first[r]]);
      for (long j = 0; j < n; ++j) C(i, j) = tangent[6 * r + rows[j]];
    }
    if (aim == pressure && missing.cwiseAbs().maxCoeff() < 1e-3 * pressure) return true;
    Eigen::VectorXd strain = C.fullPivLu().solve(missing);
    strain *= std::min(1.0, 2e-3 / strain.cwiseAbs().maxCoeff());
    double dH[9] = {};
    for (long i = 0; i < n; ++i) {
      const int r = rows[i];
      dH[3 * first[r] + second[r]] = dH[3 * second[r] + first[r]] = r < 3 ? strain[i] : 0.5 * strain[i];
    }
    const auto status = rvelab_apply(preparation_.get(), id, dH, 0, sigma);
    if (status == RVELAB_DISCARD) return false;
    expect_ok(status);
  }
  return false;
}

std::int64_t SpecimenFamily::spawn(double pressure) {
  auto found = prepared_.find(pressure);
  if (found == prepared_.end()) found = prepared_.emplace(pressure, prepare(pressure)).first;
  std::int64_t id = 0;
  expect_ok(rvelab_clone(pool_->get(), found->second, &id));
  return id;
}

rvelab_info SpecimenFamily::prepared(double pressure) {
  auto found = prepared_.find(pressure);
  if (found == prepared_.end()) found = prepared_.emplace(pressure, prepare(pressure)).first;
  return pool_->info(found->second);
}

double SpecimenFamily::wave_modulus() {
  double largest = 0;
  for (const auto& specimen : specimens_) {
    std::int64_t id = 0;
    expect_ok(rvelab_spawn(preparation_.get(), specimen.tmpl, 1, &id));
    largest = std::max(largest, wave_modulus_of(preparation_, id));
    expect_ok(rvelab_release(preparation_.get(), 1, &id));
  }
  return largest;
}

void SpecimenFamily::release() {
  for (const auto& [pressure, id] : prepared_) expect_ok(rvelab_release(pool_->get(), 1, &id));
  prepared_.clear();
}

}  // namespace mpm
