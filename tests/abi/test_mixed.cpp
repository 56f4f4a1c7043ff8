// Mixed targets and relaxation through the C interface: the same bits as the laboratory and as Rve, for one and for
// many.
#include <fstream>

#include "rvelab/measure/tensor_order.hpp"
#include "rvelab/protocol/run.hpp"
#include "tests/abi/host.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

/// A mixed target of n RVEs, with room for all that comes back.
struct Mixed {
  Mixed(std::vector<std::int64_t> of, int dimension) : ids(std::move(of)), rows(dimension == 2 ? 3 : 6) {
    const std::size_t n = ids.size(), all = n * std::size_t(rows);
    for (auto* list : {&strain, &stress}) list->resize(9 * all);
    for (auto* list : {&value, &scale, &missed}) list->resize(all);
    for (auto* list : {&sigma, &dH}) list->resize(9 * n);
    for (auto* list : {&held_error, &error_estimate}) list->resize(n);
    status.resize(n);
    tokens.resize(n);
    REQUIRE(rvelab_mixed_init(&batch, sizeof batch) == RVELAB_OK);
    batch.n = std::int64_t(n);
    batch.rows = rows;
    batch.ids = ids.data();
    batch.strain = strain.data();
    batch.stress = stress.data();
    batch.value = value.data();
    batch.scale = scale.data();
    batch.missed = missed.data();
    batch.sigma = sigma.data();
    batch.dH = dH.data();
    batch.held_error = held_error.data();
    batch.error_estimate = error_estimate.data();
    batch.status = status.data();
    batch.tokens_out = tokens.data();
  }
  void set(std::size_t entry, std::size_t row, const Matrix3& A, const Matrix3& B, double c, double size = 0,
           double left = 0) {
    const std::size_t at = entry * std::size_t(rows) + row;
    const Nine a = nine_of(A), b = nine_of(B);
    std::copy(a.begin(), a.end(), strain.begin() + std::ptrdiff_t(9 * at));
    std::copy(b.begin(), b.end(), stress.begin() + std::ptrdiff_t(9 * at));
    value[at] = c;
    scale[at] = size;
    missed[at] = left;
  }
  Matrix3 gradient(std::size_t entry = 0) const {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(dH.data() + 9 * entry);
  }
  Matrix3 sigma_of(std::size_t entry = 0) const {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(sigma.data() + 9 * entry);
  }

  std::vector<std::int64_t> ids;
  int rows;
  std::vector<double> strain, stress, value, scale, missed, sigma, dH, held_error, error_estimate;
  std::vector<std::int32_t> status;
  std::vector<std::int64_t> tokens;
  rvelab_mixed batch;
};

protocol::Protocol protocol_of(const std::string& stages) {
  const Folder folder;
  std::ofstream(folder / "test.toml") << "[test]\nname = \"test\"\ndimension = 2\npressure_Pa = 20e3\n" + stages;
  return protocol::read_protocol(folder / "test.toml");
}

/// xx yy xy with xx held at -`pressure` from the stress that is, as MixedTarget of the same.
MixedTarget drained(double shortening, double pressure, const Matrix3& stress, double missed) {
  MixedTarget target;
  for (int k = 0; k < 3; ++k) target.rows.push_back({unit_strain(k, 2), Matrix3::Zero(), 0, 0, 0});
  const double lacking = -pressure - stress(0, 0);
  target.rows[0] = {Matrix3::Zero(), unit_strain(0, 2), lacking, pressure, missed};
  target.rows[1].value = -shortening;
  return target;
}

void set_drained(Mixed& mixed, std::size_t entry, double shortening, double pressure, const Matrix3& stress) {
  const MixedTarget target = drained(shortening, pressure, stress, 0);
  for (std::size_t k = 0; k < 3; ++k)
    mixed.set(entry, k, target.rows[k].strain, target.rows[k].stress, target.rows[k].value, target.rows[k].scale);
}

}  // namespace

TEST_CASE("a drained biaxial test by mixed targets of the C interface has the bits of the laboratory") {
  const auto consolidated =
      protocol::run_protocol(protocol_of("[[stage]]\nkind = \"isotropic\"\nshear = \"zero_strain\"\n"),
                             packed(Shape::disc, 8))
          .end_state;
  const auto records =
      protocol::run_protocol(
          protocol_of("[[stage]]\nkind = \"compression\"\naxis = \"y\"\nto_strain = 0.01\nrecord_every = 0.0005\n"),
          consolidated)
          .result.records;
  REQUIRE(records.size() == 21);
  Host host;
  Mixed step(host.spawn(consolidated), 2);
  Matrix3 deformation = Matrix3::Identity();
  for (std::size_t k = 1; k < records.size(); ++k) {
    const Matrix3 stress = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(host.info(step.ids[0]).sigma);
    const double lacking = -20e3 - stress(0, 0);
    step.set(0, 0, Matrix3::Zero(), unit_strain(0, 2), lacking, 20e3, k > 1 ? lacking : 0);
    step.set(0, 1, unit_strain(1, 2), Matrix3::Zero(), (1 - records[k].strain) / deformation(1, 1) - 1);
    step.set(0, 2, unit_strain(2, 2), Matrix3::Zero(), 0);
    REQUIRE_OK(rvelab_apply_mixed(host.pool, &step.batch));
    deformation = (Matrix3::Identity() + step.gradient()) * deformation;
    CHECK(step.sigma_of() == records[k].stress);
    CHECK(deformation == records[k].deformation_gradient);
    CHECK(step.held_error[0] == records[k].held_error);
    CHECK(std::abs(step.sigma_of()(0, 0) + 20e3) < 0.005 * 20e3);
    CHECK(host.info(step.ids[0]).token == step.tokens[0]);
    CHECK(host.info(step.ids[0]).error_estimate == step.error_estimate[0]);
  }
}

TEST_CASE("mixed targets of many RVEs are each that of one alone, on any number of workers, in 2D and 3D") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    const Specimen& start = packed(shape, shape == Shape::disc ? 6 : 4);
    const int d = start.cell.dimension, rows = d == 2 ? 3 : 6;
    for (const int workers : {1, 3}) {
      Host host(workers);
      Mixed step(host.spawn(start, 5), d);
      std::vector<MixedTarget> targets(5);
      Matrix3 spin = Matrix3::Zero();
      spin(0, 1) = 1e-4, spin(1, 0) = -1e-4;
      std::vector<double> spins;
      for (std::size_t m = 0; m < 5; ++m) {
        const Rve rve(start);
        const double p = -rve.stress().trace() / d;
        for (int k = 0; k < rows; ++k) {
          MixedTarget::Row row{unit_strain(k, d), Matrix3::Zero(), -1e-4 * double(m + 1) * (k == 1), 0, 0};
          if (k == 0) row = {Matrix3::Zero(), unit_strain(0, d), 0.01 * p * double(m), p, 0};
          targets[m].rows.push_back(row);
          step.set(m, std::size_t(k), row.strain, row.stress, row.value, row.scale);
        }
        targets[m].spin = spin;
        const Nine nine = nine_of(spin);
        spins.insert(spins.end(), nine.begin(), nine.end());
      }
      step.batch.spin = spins.data();
      REQUIRE_OK(rvelab_apply_mixed(host.pool, &step.batch));
      for (std::size_t m = 0; m < 5; ++m) {
        Rve rve(start);
        const Response alone = rve.apply(targets[m], 0);
        CHECK(step.sigma_of(m) == alone.stress);
        CHECK(step.gradient(m) == alone.displacement_gradient);
        CHECK(step.held_error[m] == alone.report.held_error);
        CHECK(step.error_estimate[m] == alone.report.error_estimate);
        const Nine next{1e-4};  // the state goes on as that of Rve
        CHECK(same(host.apply(step.ids[m], next), nine_of(rve.apply(matrix_of(next), 0).stress)));
      }
    }
  }
}

TEST_CASE("a mixed target reverts a pending trial, makes older tokens stale, and fails for one RVE alone") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6), 2);
  Trials trials(ids);
  trials.dH[0] = trials.dH[1] = Nine{1e-4};
  REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
  const double p = host.info(ids[0]).p;
  const Matrix3 stress = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(host.info(ids[0]).sigma);
  Mixed step(ids, 2);
  set_drained(step, 0, 1e-4, p, stress);
  set_drained(step, 1, 2, p, stress);  // turns the cell inside out
  step.status.assign(2, 99);
  step.sigma.assign(18, 7.0);
  const auto before = host.snapshot(ids[1]);
  CHECK_STATUS(rvelab_apply_mixed(host.pool, &step.batch), step.status[1]);
  CHECK_THAT(rvelab_last_error(), Contains("entry 1 (id " + std::to_string(ids[1]) + ")"));
  CHECK(step.status[0] >= RVELAB_OK);
  CHECK(step.status[1] < RVELAB_OK);
  CHECK(step.sigma[0] != 7);
  CHECK(step.sigma[9] == 7);
  const Specimen after = host.state(ids[1]);
  CHECK(after.cell.lattice == pool::rve_state_of(before).specimen.cell.lattice);
  CHECK_STATUS(rvelab_commit(host.pool, 1, ids.data()), RVELAB_E_NO_TRIAL);
  trials.batch.n = 1;
  trials.batch.tokens_in = trials.tokens.data();
  CHECK_STATUS(rvelab_trial(host.pool, &trials.batch), RVELAB_E_STALE);
}

TEST_CASE("mixed targets that are none are refused by name, and nothing changes") {
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6), 2);
  const double p = host.info(ids[0]).p;
  const Matrix3 stress = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(host.info(ids[0]).sigma);
  Mixed good(ids, 2);
  for (const std::size_t m : {0, 1}) set_drained(good, m, 1e-4, p, stress);
  const auto refused = [&](rvelab_mixed batch, std::int32_t status, const char* part) {
    CHECK_STATUS(rvelab_apply_mixed(host.pool, &batch), status);
    CHECK_THAT(rvelab_last_error(), Contains(part));
    CHECK(host.info(ids[0]).token == host.info(ids[1]).token);  // as they were spawned
  };
  rvelab_mixed bad = good.batch;
  bad.rows = 4;
  refused(bad, RVELAB_E_INPUT, "mixed.rows is 4");
  bad = good.batch;
  bad.rows = 6;
  bad.n = 1;
  refused(bad, RVELAB_E_INPUT, "3");
  bad = good.batch;
  bad.stress = nullptr;
  refused(bad, RVELAB_E_NULL, "mixed.stress");
  bad = good.batch;
  const std::int64_t twice[] = {ids[0], ids[0]};
  bad.ids = twice;
  refused(bad, RVELAB_E_DUPLICATE, "twice");
  bad = good.batch;
  bad.dt = -1;
  refused(bad, RVELAB_E_INPUT, "time");
  bad = good.batch;
  bad.n = 1;
  std::vector<double> none(27, 0.0);
  bad.stress = none.data();  // row 0 asks for nothing
  refused(bad, RVELAB_E_INPUT, "row");
  bad = good.batch;
  bad.n = 1;
  std::vector<double> nan(3, std::nan(""));
  bad.value = nan.data();
  refused(bad, RVELAB_E_INPUT, "finite");
}

TEST_CASE("relaxation by the C interface is that of Rve, and tells where it did not come so far") {
  const Specimen& start = packed(Shape::sphere, 4);
  Host host;
  const auto ids = host.spawn(start);
  Rve rve(start);
  const Nine push{3e-3};
  host.apply(ids[0], push);
  rve.apply(matrix_of(push), 0);
  Nine sigma{};
  CHECK_STATUS(rvelab_relax(host.pool, ids[0], 1e-9, 3, sigma.data()), RVELAB_W_NOT_QUASI_STATIC);
  CHECK_THAT(rvelab_last_error(), Contains("after 3 sub-steps"));
  rve.relax(1e-9, 3);
  CHECK(same(sigma, nine_of(rve.stress())));
  REQUIRE_OK(rvelab_relax(host.pool, ids[0], 1e-4, 100'000, sigma.data()));
  CHECK(rve.relax(1e-4, 100'000).target_held);
  CHECK(same(sigma, nine_of(rve.stress())));
  CHECK(host.info(ids[0]).unbalanced_force_ratio <= 1e-4);
  CHECK_STATUS(rvelab_relax(host.pool, ids[0], 0, 10, nullptr), RVELAB_E_INPUT);
  CHECK_STATUS(rvelab_relax(host.pool, ids[0], 1e-3, 0, nullptr), RVELAB_E_INPUT);
  CHECK_STATUS(rvelab_relax(host.pool, 0, 1e-3, 10, nullptr), RVELAB_E_ID);
}
