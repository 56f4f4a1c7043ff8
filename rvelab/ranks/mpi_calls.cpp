#include "rvelab/ranks/mpi_calls.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <thread>

#include "rvelab/abi/rank_calls.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/ranks/mpi_link.hpp"
#include "rvelab/ranks/ranked_pool.hpp"

namespace rvelab::ranks {

namespace {

using pool::Refused;
using pool::Status;

/// Of the first rank, for all.
struct Common {
  std::array<char, 32> version{};
  double tolerance_rel = 0, tolerance_abs = 0, damping = 0, min_height = 0;
  std::int64_t max_substeps = 0;
  std::int32_t trial_memory = 0, padding = 0;
};

Common common_of(const pool::Options& options) {
  Common common;
  std::strncpy(common.version.data(), io::version, common.version.size() - 1);
  common.tolerance_rel = options.tolerance_rel;
  common.tolerance_abs = options.tolerance_abs;
  common.damping = options.damping;
  common.min_height = options.min_height;
  common.max_substeps = options.max_substeps;
  common.trial_memory = std::int32_t(options.trial_memory);
  return common;
}

void override_options(pool::Options& options, const Common& common) {
  options.tolerance_rel = common.tolerance_rel;
  options.tolerance_abs = common.tolerance_abs;
  options.damping = common.damping;
  options.min_height = common.min_height;
  options.max_substeps = long(common.max_substeps);
  options.trial_memory = pool::TrialMemory(common.trial_memory);
}

const abi::RankCalls& library_calls() { return *static_cast<const abi::RankCalls*>(rvelab_rank_calls()); }

/// The pool at the first rank. The others serve it until its end, and have none.
std::unique_ptr<pool::Pool> made(void* self, const std::function<pool::Options()>& given) {
  World world = join(*static_cast<const std::int32_t*>(self));
  const abi::RankCalls& library = library_calls();
  Status status = Status::ok;
  char text[1024] = "";
  pool::Options options;
  try {
    options = given();
  } catch (...) {
    status = pool::status_of_exception(text, sizeof text);
  }
  expect_all(*world.link, status, text);
  Common common = common_of(options);
  broadcast(*world.link, std::as_writable_bytes(std::span(&common, 1)));
  override_options(options, common);
  if (options.workers == 0 && options.run_tasks == nullptr)  // the cores of a machine are shared by its ranks
    options.workers = std::max(1u, std::thread::hardware_concurrency() / unsigned(world.ranks_here));
  std::unique_ptr<pool::Share> share;
  try {
    for (const char* version : {static_cast<const char*>(common.version.data()), library.version})
      if (std::strcmp(version, io::version) != 0)
        throw Refused(Status::no_library, std::string("librvelab-mpi.so is of rvelab ") + io::version +
                                              "; librvelab.so, or that of the first rank, is of " + version +
                                              ": install one version everywhere");
    share = library.open_share(options);
  } catch (...) {
    status = pool::status_of_exception(text, sizeof text);
  }
  expect_all(*world.link, status, text);
  if (world.rank == 0) return std::make_unique<RankedPool>(std::move(world.link), std::move(share));
  serve(*world.link, std::move(share));
  return nullptr;
}

}  // namespace
}  // namespace rvelab::ranks

int32_t rvelab_mpi_pool_create(const rvelab_pool_def* def, int32_t fortran_comm, rvelab_pool** pool) {
  return rvelab::ranks::library_calls().give_pool(def, &fortran_comm, rvelab::ranks::made, pool);
}
