// librvelab.so in processes as hosts have them (process_host.cpp), and calls that a host interrupts.
#include <chrono>
#include <filesystem>
#include <thread>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/abi/host.hpp"
#include "tests/abi/shell.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

std::string process_host(const std::string& kind, const std::string& environment = "") {
  const Folder folder;
  io::write_specimen(packed(Shape::disc, 5), folder / "s.h5");
  return output_of(environment + " '" RVELAB_PROCESS_HOST "' '" RVELAB_LIBRARY "' '" RVELAB_H5_LIBRARY "' '" +
                   (folder / "s.h5") + "' '" + (folder / ".") + "' " + kind);
}

/// Runs a call, and interrupts its pool 0.1 s after it began; the status of the call.
template <class Call>
std::int32_t interrupted(rvelab_pool* pool, const Call& call) {
  std::thread other([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    CHECK(rvelab_interrupt(pool, 1) == RVELAB_OK);
  });
  const auto begin = std::chrono::steady_clock::now();
  const std::int32_t status = call();
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(10));  // of hours
  other.join();
  return status;
}

}  // namespace

TEST_CASE("files are read and written in a host that has another HDF5 and an operator new of its own") {
  const std::string found = process_host("hdf5");
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  CHECK_THAT(found, Contains("another HDF5 of the host"));  // refused: sanitizers want their symbols first
#else
  CHECK(found == "ok\n\n0");
#endif
}

TEST_CASE("a host that has loaded librvelab-h5.so itself, beside another HDF5, is told not to") {
  CHECK(process_host("loaded") == "ok\n\n0");
}

TEST_CASE("parameters and messages have the numbers of C whatever locale the host has set") {
  CHECK(process_host("locale") == "ok\n\n0");
}

TEST_CASE("numbers are those of C where setlocale has a comma before decimals") {
  const Folder folder;
  const std::string made = output_of("localedef -i de_DE -f UTF-8 '" + (folder / "comma.UTF-8") + "'");
  if (!std::filesystem::exists(folder / "comma.UTF-8/LC_NUMERIC")) {
    WARN("left out: localedef makes no German locale here: " << made);
    return;
  }
  CHECK(process_host("locale", "LOCPATH='" + (folder / ".") + "' RVELAB_COMMA_LOCALE=comma.UTF-8") == "ok\n\n0");
}

TEST_CASE("a host may unload librvelab.so while a pool lives") { CHECK(process_host("unload") == "ok\n\n0"); }

TEST_CASE("an interrupt ends a call within some sub-steps, and the RVE is as before, bit for bit") {
  for (const Shape shape : {Shape::disc, Shape::sphere}) {
    Host host(2);
    const auto ids = host.spawn(packed(shape, shape == Shape::sphere ? 5 : 12), 4);
    const Nine small{0, 1e-4, 0, -1e-4};
    host.apply(ids[0], small);
    const auto before = host.snapshot(ids[0]);
    const auto as_before = [&] {
      rvelab_interrupt(host.pool, 0);
      CHECK(host.snapshot(ids[0]) == before);
    };
    CHECK(interrupted(host.pool, [&] { return rvelab_relax(host.pool, ids[0], 1e-300, 1'000'000'000, nullptr); }) ==
          RVELAB_E_INTERRUPTED);
    CHECK_THAT(rvelab_last_error(), Contains("rvelab_interrupt"));
    // Until it is taken back later calls end at their first sub-step.
    Nine sigma{};
    const Nine large{0, 1e-2, 0, -1e-2};
    CHECK_STATUS(rvelab_apply(host.pool, ids[0], large.data(), 0, sigma.data()), RVELAB_E_INTERRUPTED);
    CHECK_STATUS(rvelab_apply(host.pool, ids[0], small.data(), 1e-3, sigma.data()), RVELAB_E_INTERRUPTED);
    std::int64_t more[3];
    CHECK_STATUS(rvelab_spawn(host.pool, host.template_of(packed(shape, 4)), 3, more), RVELAB_E_INTERRUPTED);
    CHECK(host.info(ids[0]).grains > 0);
    as_before();

    const char* const stages = "[[stage]]\nkind = \"relax\"\nunbalanced = 1e-300\nmax_steps = 1000000000\n";
    std::int32_t status[4] = {};
    CHECK(interrupted(host.pool, [&] {
            return rvelab_run_stages(host.pool, 4, ids.data(), stages, nullptr, status);
          }) == RVELAB_E_INTERRUPTED);
    for (const std::int32_t each : status) CHECK(each == RVELAB_E_INTERRUPTED);
    as_before();

    Trials trials({ids.begin(), ids.end()});
    for (Nine& dH : trials.dH) dH = large;
    rvelab_interrupt(host.pool, 1);
    CHECK_STATUS(rvelab_trial(host.pool, &trials.batch), RVELAB_E_INTERRUPTED);
    CHECK_STATUS(rvelab_commit(host.pool, 1, ids.data()), RVELAB_E_NO_TRIAL);
    as_before();

    Host undisturbed;
    const auto alone = undisturbed.spawn(packed(shape, shape == Shape::sphere ? 5 : 12));
    undisturbed.apply(alone[0], small);
    CHECK(same(host.apply(ids[0], large), undisturbed.apply(alone[0], large)));
  }
  CHECK(rvelab_interrupt(nullptr, 1) == RVELAB_E_NULL);
}

TEST_CASE("an interrupted pool writes no file and reads none") {
  const Folder folder;
  const std::string file = folder / "pool.h5";
  Host host;
  host.spawn(packed(Shape::disc, 5), 2);
  REQUIRE_OK(rvelab_pool_write(host.pool, file.c_str()));
  const std::string bytes = bytes_of(file);
  host.spawn(packed(Shape::disc, 4));
  rvelab_interrupt(host.pool, 1);
  CHECK_STATUS(rvelab_pool_write(host.pool, file.c_str()), RVELAB_E_INTERRUPTED);
  CHECK(bytes_of(file) == bytes);
  Host other;
  rvelab_interrupt(other.pool, 1);
  CHECK_STATUS(rvelab_pool_read(other.pool, file.c_str()), RVELAB_E_INTERRUPTED);
  rvelab_interrupt(other.pool, 0);
  REQUIRE_OK(rvelab_pool_read(other.pool, file.c_str()));
}
