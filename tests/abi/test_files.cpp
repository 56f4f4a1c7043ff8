// Files by way of librvelab-h5.so: specimens, pools, damage, and the library missing.
#include <fstream>
#include <utility>

#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/io/hdf5/seal.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tests/abi/host.hpp"
#include "tests/abi/no_memory.hpp"
#include "tests/folder.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

TEST_CASE("A template from a specimen file is that specimen") {
  const Folder folder;
  const Specimen& start = packed(Shape::disc, 6);
  io::write_specimen(start, folder / "s.h5");
  Host host;
  std::int64_t made = 0, id = 0;
  REQUIRE_OK(rvelab_template_load(host.pool, (folder / "s.h5").c_str(), &made));
  REQUIRE_OK(rvelab_spawn(host.pool, made, 1, &id));
  CHECK(Rve(host.state(id)).save() == Rve(start).save());
  CHECK(host.info(id).permeability_ratio == Approx(1));
  CHECK(rvelab_template_load(host.pool, (folder / "none.h5").c_str(), &made) == RVELAB_E_FILE);
  CHECK_THAT(rvelab_last_error(), Contains("none.h5"));
  std::ofstream(folder / "text.h5") << "no HDF5";
  CHECK(rvelab_template_load(host.pool, (folder / "text.h5").c_str(), &made) == RVELAB_E_FILE);
}

TEST_CASE("A file that was edited and sealed again is refused by its field, and echoes no byte that is no letter") {
  const Folder folder;
  Specimen bad = packed(Shape::disc, 6);
  bad.grains.position[3][2] = 0.5;
  const std::string path = folder / "s\x1b\xff.h5";
  io::write_specimen(bad, path);
  Host host;
  std::int64_t made = 0;
  CHECK(rvelab_template_load(host.pool, path.c_str(), &made) == RVELAB_E_FILE);
  CHECK_THAT(rvelab_last_error(), Contains("s??.h5: /grains/position_m[3, 2] of grain") && Contains("= 0.5"));

  // The RVE of a pool file, of which the first is whole.
  host.spawn(packed(Shape::disc, 6), 2);
  REQUIRE_OK(rvelab_pool_write(host.pool, (folder / "pool.h5").c_str()));
  const auto whole = io::Hdf5File::open(folder / "pool.h5");
  const std::string name = whole.groups("/rves")[1];
  io::publish(folder / "edited.h5", [&](io::Hdf5File& file) {
    for (const char* attribute : {"format", "format_version"})
      file.set_attribute(attribute, whole.attribute(attribute));
    for (const io::Hdf5Entry& entry : whole.entries()) {
      if (entry.name.starts_with("/rves/" + name + "/")) continue;
      if (entry.type == "text") file.write_text(entry.name, whole.read_text(entry.name), entry.shape);
      if (entry.type == "float64")
        file.write<double>(entry.name, whole.read<double>(entry.name), entry.shape, entry.units);
      if (entry.type == "int32")
        file.write<std::int32_t>(entry.name, whole.read<std::int32_t>(entry.name), entry.shape, entry.units);
      if (entry.type == "int64")
        file.write<std::int64_t>(entry.name, whole.read<std::int64_t>(entry.name), entry.shape, entry.units);
      if (entry.type == "uint64")
        file.write<std::uint64_t>(entry.name, whole.read<std::uint64_t>(entry.name), entry.shape, entry.units);
      if (entry.type == "uint8")
        file.write<std::uint8_t>(entry.name, whole.read<std::uint8_t>(entry.name), entry.shape, entry.units);
    }
    io::put_specimen(file, "/rves/" + name, bad);
  });
  Host empty;
  CHECK(rvelab_pool_read(empty.pool, (folder / "edited.h5").c_str()) == RVELAB_E_FILE);
  CHECK_THAT(rvelab_last_error(), Contains("/rves/" + name + "/grains/position_m[3, 2]"));
  std::int64_t id = 0, n = -1;
  REQUIRE_OK(rvelab_ids(empty.pool, 1, &id, &n));
  CHECK(n == 0);
}

TEST_CASE("A pool read from its file goes on with the same ids, tokens and bits; stale ids stay stale") {
  const Folder folder;
  std::vector<std::int64_t> ids;
  std::int64_t stale = 0;
  std::vector<Nine> expected;
  const std::string file = folder / "pool.h5";
  Trials trials(std::vector<std::int64_t>(3, 0));
  const auto go_on = [&](Host& host) {
    // The first goes on from a trial that was not committed when the file was written, the others from their states.
    Trials next(ids);
    next.tokens = trials.tokens;
    next.tokens[1] = host.info(ids[1]).token;
    next.batch.tokens_in = next.tokens.data();
    Increments draw(8);
    for (Nine& dH : next.dH) dH = draw.next(1e-5);
    REQUIRE_OK(rvelab_trial(host.pool, &next.batch));
    REQUIRE_OK(rvelab_commit(host.pool, 0, nullptr));
    return std::make_pair(next.sigma, next.tokens);
  };
  std::pair<std::vector<Nine>, std::vector<std::int64_t>> undisturbed;
  {
    Host host;
    ids = host.spawn(packed(Shape::disc, 6), 4);
    stale = ids[1];
    REQUIRE_OK(rvelab_release(host.pool, 1, &stale));
    ids.erase(ids.begin() + 1);
    trials.ids = ids;
    trials.batch.ids = trials.ids.data();
    Increments draw(7);
    for (int round = 0; round < 3; ++round) {
      for (Nine& dH : trials.dH) dH = draw.next(1e-5);
      REQUIRE_OK(rvelab_trial(host.pool, &trials.batch));
      if (round == 0) REQUIRE_OK(rvelab_commit(host.pool, 0, nullptr));
    }
    REQUIRE_OK(rvelab_pool_write(host.pool, file.c_str()));
    undisturbed = go_on(host);
    Host occupied;
    occupied.spawn(packed(Shape::disc, 3));
    CHECK(rvelab_pool_read(occupied.pool, file.c_str()) == RVELAB_E_INPUT);
  }
  Host host;
  REQUIRE_OK(rvelab_pool_read(host.pool, file.c_str()));
  std::vector<std::int64_t> found(3);
  std::int64_t n = 0;
  REQUIRE_OK(rvelab_ids(host.pool, 3, found.data(), &n));
  CHECK((n == 3 && found == ids));
  CHECK(go_on(host) == undisturbed);
  Nine nine{};
  CHECK(rvelab_apply(host.pool, stale, nine.data(), 0, nine.data()) == RVELAB_E_ID);
  const auto again = host.spawn(packed(Shape::disc, 3), 2);
  CHECK((again[0] != stale && again[1] != stale));
  CHECK(rvelab_apply(host.pool, stale, nine.data(), 0, nine.data()) == RVELAB_E_ID);
  CHECK_THAT(rvelab_last_error(), Contains("stale"));
  CHECK(rvelab_pool_write(host.pool, "/nowhere/at/all/p.h5") == RVELAB_E_FILE);
  // The same states make the same bytes.
  Host twice;
  REQUIRE_OK(rvelab_pool_read(twice.pool, file.c_str()));
  REQUIRE_OK(rvelab_pool_write(twice.pool, (folder / "twice.h5").c_str()));
  CHECK(bytes_of(file) == bytes_of(folder / "twice.h5"));
}

TEST_CASE("A pool file of one RVE is read as a specimen, one of two is refused") {
  const Folder folder;
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 6), 2);
  REQUIRE_OK(rvelab_pool_write(host.pool, (folder / "two.h5").c_str()));
  CHECK_THROWS_WITH(io::read_specimen(folder / "two.h5"), Contains("a pool of 2 RVEs; allowed: one"));
  REQUIRE_OK(rvelab_release(host.pool, 1, &ids[0]));
  Nine dH{}, sigma{};
  dH[1] = 1e-4;
  REQUIRE_OK(rvelab_apply(host.pool, ids[1], dH.data(), 0, sigma.data()));
  REQUIRE_OK(rvelab_pool_write(host.pool, (folder / "one.h5").c_str()));
  CHECK(Rve(io::read_specimen(folder / "one.h5")).save() == Rve(host.state(ids[1])).save());
}

TEST_CASE("A pool file cut at every 4 KiB, or with a byte changed, is refused, and the pool stays empty") {
  const Folder folder;
  const std::string file = folder / "pool.h5", cut = folder / "cut.h5";
  {
    Host host;
    host.spawn(packed(Shape::disc, 3), 5);
    REQUIRE_OK(rvelab_pool_write(host.pool, file.c_str()));
  }
  const std::string whole = bytes_of(file);
  REQUIRE(whole.size() > 20 * 4096);
  Host host;
  std::int64_t n = -1;
  const auto refused = [&](const std::string& bytes) {
    std::ofstream(cut, std::ios::binary) << bytes;
    const std::int32_t status = rvelab_pool_read(host.pool, cut.c_str());
    return status == RVELAB_E_FILE && std::strlen(rvelab_last_error()) > 20;
  };
  for (std::size_t size = 0; size < whole.size(); size += 4096) {
    INFO(size);
    CHECK(refused(whole.substr(0, size)));
  }
  for (std::size_t at = 100; at < whole.size(); at += whole.size() / 50) {
    std::string changed = whole;
    changed[at] = char(changed[at] ^ 4);
    INFO(at);
    CHECK(refused(changed));
  }
  REQUIRE_OK(rvelab_ids(host.pool, 0, nullptr, &n));
  CHECK(n == 0);
  REQUIRE_OK(rvelab_pool_read(host.pool, file.c_str()));
}

TEST_CASE("wherever memory ends while a file is read or written, RVELAB_E_MEMORY is all that happens") {
  const Folder folder;
  const std::string specimen = folder / "s.h5", pool = folder / "pool.h5";
  io::write_specimen(packed(Shape::disc, 3), specimen);
  Host host;
  const auto ids = host.spawn(packed(Shape::disc, 3), 2);
  REQUIRE_OK(rvelab_pool_write(host.pool, pool.c_str()));
  const std::string whole = bytes_of(pool);
  const auto refused_until_done = [&](auto call) {
    int refused = 0;
    for (long n = 1;; n += n < 60 ? 1 : 41) {
      allocations_left = n;
      const std::int32_t status = call();
      const bool reached = std::exchange(allocations_left, 0) == 0;
      if (!reached) {
        CHECK(status >= RVELAB_OK);
        return refused;
      }
      INFO(n);
      CHECK(status == RVELAB_E_MEMORY);
      CHECK(bytes_of(pool) == whole);
      ++refused;
    }
  };
  std::int64_t made = 0;
  CHECK(refused_until_done([&] { return rvelab_template_load(host.pool, specimen.c_str(), &made); }) > 60);
  CHECK(refused_until_done([&] { return rvelab_pool_write(host.pool, pool.c_str()); }) > 60);
  Host empty;
  CHECK(refused_until_done([&] { return rvelab_pool_read(empty.pool, pool.c_str()); }) > 60);
  CHECK(Rve(empty.state(ids[0])).save() == Rve(host.state(ids[0])).save());
}

TEST_CASE("a file without its seal is refused in a host, and the remedy named") {
  Host host;
  std::int64_t made = 0;
  const Folder folder;
  const std::string old = folder / "s.h5";
  io::write_specimen(packed(Shape::disc, 5), old);
  std::filesystem::resize_file(old, std::filesystem::file_size(old) - io::seal_bytes);
  CHECK(rvelab_template_load(host.pool, old.c_str(), &made) == RVELAB_E_FILE);
  CHECK_THAT(rvelab_last_error(), Contains("lacks the checksum") && Contains("rvelab seal " + old));
  CHECK(rvelab_pool_read(host.pool, old.c_str()) == RVELAB_E_FILE);
  CHECK_THAT(rvelab_last_error(), Contains("rvelab seal " + old));
}
