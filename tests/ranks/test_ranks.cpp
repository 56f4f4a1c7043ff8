// A pool over ranks: whatever is done with it, results, ids, texts and states are those of the pool in one process.
// tests/ranks/mpirun does the same under mpirun.
#include <algorithm>
#include <cstring>
#include <limits>
#include <regex>

#include "tests/ranks/local_ranks.hpp"

using namespace rvelab;
using namespace rvelab::test;

namespace {

/// A call that this test alone knows: it stands in no list.
std::int64_t grains_times(pool::Share& share, std::int64_t id, std::int64_t factor) {
  return share.of_committed(id,
                            [&](const pool::Resident& resident) { return factor * std::int64_t(resident.rve.size()); });
}

}  // namespace

TEST_CASE("a pool over ranks gives the bits, ids, tokens and costs of a pool in one process") {
  for (const int ranks : {1, 2, 3, 5})
    for (const auto memory : {RVELAB_TRIAL_KEEP, RVELAB_TRIAL_RECOMPUTE}) {
      pool::Options options = one_thread();
      options.trial_memory = memory;
      pool::ThreadedPool one(options);
      const auto spread = over(ranks, options);
      std::vector<std::int64_t> ids;
      for (const int side : {4, 8, 5}) {  // of unlike cost
        std::vector<std::int64_t> here(5), there(5);
        const Specimen& start = side == 5 ? cemented(side) : packed(side);
        one.spawn(one.add_template(start), 5, here.data());
        spread->spawn(spread->add_template(start), 5, there.data());
        // the tag is that of the pool; generation and slot are the same
        for (std::size_t k = 0; k < 5; ++k) {
          CHECK(pool::Id::of(here[k]).slot == pool::Id::of(there[k]).slot);
          CHECK(pool::Id::of(here[k]).generation == pool::Id::of(there[k]).generation);
        }
        ids.insert(ids.end(), here.begin(), here.end());
      }
      const std::vector<std::int64_t> all = spread->ids();
      std::map<std::int64_t, std::int64_t> there_of;
      for (std::size_t k = 0; k < ids.size(); ++k) there_of[ids[k]] = all[k];
      const auto there = [&](const std::vector<std::int64_t>& here) {
        std::vector<std::int64_t> mapped;
        for (const std::int64_t id : here) mapped.push_back(there_of.at(id));
        return mapped;
      };
      Draw draw{std::uint64_t(ranks)};
      bool equal = true;
      for (int round = 0; round < 40; ++round) {
        const std::vector<std::int64_t> chosen = some(ids, draw);
        if (chosen.empty()) continue;
        const auto gradients = draw.gradients(chosen.size(), round % 7 == 0 ? 2e-3 : 1e-5);
        const double dt = round % 5 == 4 ? 1e-4 : 0;
        const bool with_all = round % 11 == 3;
        std::vector<std::int64_t> tokens;
        for (const std::int64_t id : chosen) tokens.push_back(one.info(id).token);
        const Found first = trial(one, chosen, gradients, round % 3 == 0 ? &tokens : nullptr, dt, with_all);
        equal = equal &&
                first == trial(*spread, there(chosen), gradients, round % 3 == 0 ? &tokens : nullptr, dt, with_all);
        if (round % 4 == 1) {  // a token that is not the last one
          const auto step = draw.gradients(chosen.size(), 1e-5), other = draw.gradients(chosen.size(), 1e-5);
          equal = equal && trial(one, chosen, step) == trial(*spread, there(chosen), step);
          equal =
              equal && trial(one, chosen, other, &first.tokens) == trial(*spread, there(chosen), other, &first.tokens);
        }
        switch (draw.below(4)) {
          case 0:
            one.revert(chosen), spread->revert(there(chosen));
            break;
          case 1:
            one.commit({}), spread->commit({});
            break;  // all that are pending
          case 2:
            one.commit(chosen), spread->commit(there(chosen));
            break;
          default: {
            const std::vector<std::int64_t> part(chosen.begin(), chosen.begin() + std::ptrdiff_t(chosen.size() / 2));
            if (part.empty()) break;
            one.commit(part), spread->commit(there(part));
          }
        }
        double here_stress[9], there_stress[9];
        Matrix3 gradient = Matrix3::Zero();
        gradient(0, 1) = 1e-6;
        one.apply(chosen[0], gradient, 0, here_stress);
        spread->apply(there_of.at(chosen[0]), gradient, 0, there_stress);
        equal = equal && std::memcmp(here_stress, there_stress, sizeof here_stress) == 0;
      }
      CHECK(equal);
      for (const std::int64_t id : ids) {
        CHECK(one.save(id) == spread->at<&pool::Share::save>(there_of.at(id)));
        const rvelab_info a = one.info(id), b = spread->at<&pool::Share::info>(there_of.at(id));
        CHECK((a.p == b.p && std::ranges::equal(a.fabric, b.fabric) && std::ranges::equal(a.lattice, b.lattice) &&
               a.token == b.token && a.contacts == b.contacts && a.grain_steps == b.grain_steps &&
               a.inertial_number == b.inertial_number && a.error_estimate == b.error_estimate));
        CHECK(spread->at<&grains_times>(there_of.at(id), std::int64_t(3)) == 3 * a.grains);
        const auto rows = one.array_rows(id);
        CHECK(rows == spread->at<&pool::Share::array_rows>(there_of.at(id)));
        for (std::size_t k = 0; k < rows.size(); ++k)
          if (rows[k] >= 0 && k % 7 == 0)
            CHECK(one.array(id, std::int64_t(k)) == spread->at<&pool::Share::array>(there_of.at(id), std::int64_t(k)));
        std::int64_t cost_here = 0, cost_there = 1;
        one.cost({&id, 1}, &cost_here);
        spread->cost({&there_of.at(id), 1}, &cost_there);
        CHECK(cost_here == cost_there);
      }
      if (ranks > 1) CHECK(spread->moved() > 0);
    }
}

TEST_CASE("ids and tokens over ranks begin with what is drawn once for all of them, and those of another are refused") {
  std::int64_t foreign[4], foreign_token = 0;
  for (int k = 0; k < 2; ++k) {  // the second over the same ids, but for what was drawn
    const auto spread = over(3);
    std::int64_t ids[4];
    spread->spawn(spread->add_template(packed(3)), 4, ids);  // on three ranks
    const std::int64_t token = spread->at<&pool::Share::info>(ids[0]).token;
    for (const std::int64_t id : ids) {
      CHECK(pool::Id::of(id).tag == pool::Id::of(ids[0]).tag);
      CHECK(pool::Id::of(id).generation == pool::Id::of(ids[0]).generation);
      CHECK(spread->at<&pool::Share::info>(id).token == token);
    }
    CHECK(token > 1);
    const Found first = trial(*spread, {ids, ids + 4}, Draw(1).gradients(4, 1e-5));
    for (const std::int64_t each : first.tokens) CHECK(each == token + 1);
    if (k == 1) {
      CHECK_THAT(refusal([&] { spread->at<&pool::Share::info>(foreign[1]); }),
                 Catch::Matchers::StartsWith("-4") && Catch::Matchers::Contains("another pool or process made it"));
      const std::vector<std::int64_t> tokens(4, foreign_token);
      const Found refused = trial(*spread, {ids, ids + 4}, Draw(1).gradients(4, 1e-5), &tokens);
      CHECK(refused.status == std::vector<std::int32_t>(4, RVELAB_E_STALE));
    }
    std::copy_n(ids, 4, foreign);
    foreign_token = token;
  }
}

TEST_CASE("mixed targets and relaxation over ranks have the bits and costs of a pool in one process") {
  for (const int ranks : {1, 3}) {
    pool::ThreadedPool one(one_thread());
    const auto spread = over(ranks, one_thread());
    std::vector<std::int64_t> here(5), there(5);
    one.spawn(one.add_template(cemented(5)), 5, here.data());
    spread->spawn(spread->add_template(cemented(5)), 5, there.data());
    const double p = one.info(here[0]).p;
    std::vector<double> strain(9 * 15), stress(9 * 15), value(15), scale(15);
    for (std::size_t m = 0; m < 5; ++m) {  // sigma_xx held, eps_yy and eps_xy given
      stress[27 * m] = strain[27 * m + 9 + 4] = 1;
      strain[27 * m + 18 + 1] = strain[27 * m + 18 + 3] = 0.5;
      value[3 * m + 1] = -1e-4 * double(m + 1);
      scale[3 * m] = p;
    }
    const auto apply = [&](pool::Pool& pool, const std::vector<std::int64_t>& ids) {
      std::vector<double> found(45 + 45 + 5);
      std::vector<std::int64_t> tokens(5);
      rvelab_mixed batch{};
      batch.n = 5;
      batch.rows = 3;
      batch.ids = ids.data();
      batch.strain = strain.data();
      batch.stress = stress.data();
      batch.value = value.data();
      batch.scale = scale.data();
      batch.sigma = found.data();
      batch.dH = found.data() + 45;
      batch.held_error = found.data() + 90;
      batch.tokens_out = tokens.data();
      CHECK(pool::apply_mixed(pool, batch).status == pool::Status::ok);
      found.insert(found.end(), tokens.begin(), tokens.end());
      return found;
    };
    CHECK(apply(one, here) == apply(*spread, there));
    for (std::size_t m = 0; m < 5; ++m) {
      const auto alone = one.relax(here[m], 1e-6, 50), apart = spread->at<&pool::Share::relax>(there[m], 1e-6, 50);
      CHECK(std::memcmp(&alone, &apart, sizeof alone) == 0);
      const auto state = one.save(here[m]);
      CHECK(state == spread->at<&pool::Share::save>(there[m]));
      const std::span<const std::byte> bytes(state);
      const std::int64_t token = one.info(here[m]).token;
      spread->at<&pool::Share::replace>(there[m], bytes, token, std::int64_t(7));
      CHECK(state == spread->at<&pool::Share::save>(there[m]));
      CHECK_THROWS_AS(spread->at<&pool::Share::replace>(there[m], bytes, token + 1, std::int64_t(0)), pool::Refused);
      std::int64_t cost_here = 0, cost_there = 1;
      one.cost({&here[m], 1}, &cost_here);
      spread->cost({&there[m], 1}, &cost_there);
      CHECK(cost_there == cost_here + 7);
    }
  }
}

TEST_CASE("RVEs that move between ranks keep their pending trials") {
  const auto spread = over(2, one_thread());
  pool::ThreadedPool one(one_thread());
  std::vector<std::int64_t> small(6), large(6), small_here(6), large_here(6);
  const auto spawn = [](pool::Pool& pool, int side, std::vector<std::int64_t>& ids) {
    pool.spawn(pool.add_template(packed(side)), std::int64_t(ids.size()), ids.data());
  };
  spawn(*spread, 4, small), spawn(one, 4, small_here);
  spawn(*spread, 8, large), spawn(one, 8, large_here);
  // Every other RVE is on each rank: of the large ones only those of one rank are asked to work.
  const std::vector<std::int64_t> busy{large[0], large[2], large[4]},
      busy_here{large_here[0], large_here[2], large_here[4]};
  Draw draw(1);
  const auto gradients = draw.gradients(3, 1e-4), next = draw.gradients(3, 1e-4);
  const Found first = trial(*spread, busy, gradients);
  CHECK(first == trial(one, busy_here, gradients));
  const std::vector<std::int64_t> stale{99, 99, 99};
  const Found refused = trial(*spread, busy, next, &stale);  // they move, and nothing else is done
  CHECK(spread->moved() > 0);
  CHECK(refused.verdict.status == pool::Status::stale_token);
  spread->commit(busy);
  one.commit(busy_here);
  for (std::size_t k = 0; k < busy.size(); ++k)
    CHECK(spread->at<&pool::Share::save>(busy[k]) == one.save(busy_here[k]));
}

TEST_CASE("a pool over ranks refuses what a pool in one process does, with the same words") {
  const auto errors = [](pool::Pool& pool) {
    std::vector<std::string> found;
    std::vector<std::int64_t> ids(4);
    const std::int64_t specimen = pool.add_template(packed(4));
    pool.spawn(specimen, 4, ids.data());
    const auto say = [&](const std::function<void()>& work) {
      std::string text = refusal(work);
      for (const std::int64_t id : ids)  // ids differ by the tag of the pool
        for (auto at = text.find(std::to_string(id)); at != std::string::npos; at = text.find(std::to_string(id)))
          text.replace(at, std::to_string(id).size(), "ID" + std::to_string(pool::Id::of(id).slot));
      found.push_back(text);
    };
    std::int64_t made = 0;
    double stress[9];
    const Matrix3 none = Matrix3::Zero();
    Matrix3 inside_out = Matrix3::Zero();
    inside_out(0, 0) = -2;
    say([&] { pool.spawn(0, 1, &made); });
    say([&] { pool.spawn(specimen, -1, &made); });
    say([&] { pool.apply(0, none, 0, stress); });
    say([&] { pool.apply(std::int64_t(float(ids[1])), none, 0, stress); });
    say([&] { pool.apply(ids[2], none, -1, stress); });
    say([&] { pool.apply(ids[2], inside_out, 0, stress); });
    say([&] { pool.commit(ids); });
    say([&] { pool.commit(std::vector{ids[0], ids[0]}); });
    say([&] { pool.release(std::vector{ids[1], std::int64_t(5)}); });
    say([&] { trial(pool, {ids[0], ids[1], ids[0]}, std::vector<double>(27, 0.0)); });
    say([&] { trial(pool, ids, std::vector<double>(36, 0.0), nullptr, -1); });
    say([&] { pool.at<&pool::Share::load>(ids[3], std::vector<std::byte>(100)); });
    say([&] { pool.read([](const auto&) { return pool::Population{}; }); });
    // One entry of a batch alone: the others are done.
    std::vector<double> gradients(36, 0.0);
    for (std::size_t k = 0; k < 4; ++k) gradients[9 * k] = 1e-5;
    gradients[9] = std::numeric_limits<double>::quiet_NaN();
    Found some_done = trial(pool, ids, gradients);
    CHECK((some_done.status[0] >= 0 && some_done.status[1] == -2 && some_done.status[3] >= 0));
    CHECK((some_done.scale[1] == 0 && some_done.stress[9] == 7 && some_done.stress[0] != 7));
    say([&] { throw pool::Refused(some_done.verdict.status, some_done.verdict.text); });
    const Found foreign = trial(pool, {ids[0], std::int64_t(5), ids[2]}, std::vector<double>(27, 0.0));
    CHECK((foreign.status[0] >= 0 && foreign.status[1] == -4 && foreign.scale[1] == 0 && foreign.status[2] >= 0));
    say([&] { throw pool::Refused(foreign.verdict.status, foreign.verdict.text); });
    say([&] { pool.commit(ids); });  // the second has no trial: none is committed
    CHECK(pool.at<&pool::Share::info>(ids[0]).token == 1);
    pool.release(std::vector{ids[1]});
    say([&] { pool.apply(ids[1], none, 0, stress); });
    CHECK(pool.ids() == std::vector{ids[0], ids[2], ids[3]});
    std::int64_t again = pool.clone(ids[3]);
    CHECK((pool::Id::of(again).slot == pool::Id::of(ids[1]).slot &&
           pool.at<&pool::Share::save>(again) == pool.at<&pool::Share::save>(ids[3])));
    return found;
  };
  pool::ThreadedPool one(one_thread());
  const std::vector<std::string> expected = errors(one);
  for (const int ranks : {1, 2, 3}) {
    const auto spread = over(ranks, one_thread());
    const std::vector<std::string> found = errors(*spread);
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      INFO("ranks " << ranks << ", call " << k);
      const auto of_pool = [](const std::string& text) {  // tags and what is rounded of an id are those of the pool
        return std::regex_replace(text, std::regex("tag [0-9]+|[0-9]{9,}"), "...");
      };
      CHECK(of_pool(found[k]) == of_pool(expected[k]));
      CHECK(!found[k].empty());
    }
  }
}
