#include "rvelab/ranks/mpi_calls.hpp"

#include <algorithm>
#include <cstring>
#include <thread>

#include "rvelab/abi/c_boundary.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/ranks/ranked_pool.hpp"

namespace rvelab::ranks {

namespace {

using pool::Refused;
using pool::Status;

/// Of the first rank, for all.
struct Common {
  char version[32];
  rvelab_pool_def options;
};

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
  Common common{{}, options};
  std::strncpy(common.version, io::version, sizeof common.version - 1);
  broadcast(*world.link, std::as_writable_bytes(std::span(&common, 1)));
  common.options.workers = options.workers;  // these are of each rank
  common.options.run_tasks = options.run_tasks;
  common.options.host = options.host;
  options = common.options;
  if (options.workers == 0 && options.run_tasks == nullptr)  // the cores of a machine are shared by its ranks
    options.workers = std::max(1, int(std::thread::hardware_concurrency()) / world.ranks_here);
  std::unique_ptr<pool::Share> share;
  try {
    for (const char* version : {static_cast<const char*>(common.version), library.version})
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
