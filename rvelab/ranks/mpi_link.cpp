// Messages by MPI. Declared in perform.hpp.
#include "rvelab/ranks/perform.hpp"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <new>

namespace rvelab::ranks {

namespace {

using pool::Refused;
using pool::Status;

constexpr int tag = 1;
constexpr std::size_t piece = std::size_t(1) << 30;  ///< counts of MPI are of 31 bits

void expect_success(int code, const char* what) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw Refused(Status::internal, std::string("pool: ") + what + " between ranks failed: " + text);
}

[[noreturn]] void refuse_handle() {
  throw Refused(Status::bad_input,
                "rvelab_mpi_pool_create: fortran_comm is no communicator; give MPI_Comm_c2f(comm), or "
                "the handle of Fortran itself");
}

class MpiLink final : public Link {
 public:
  explicit MpiLink(MPI_Comm of) {
    // An invalid handle is reported to the handler of the world, which by default ends the program.
    MPI_Errhandler as_found;
    MPI_Comm_get_errhandler(MPI_COMM_WORLD, &as_found);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    const int code = MPI_Comm_dup(of, &communicator_);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, as_found);
    MPI_Errhandler_free(&as_found);
    if (code != MPI_SUCCESS) refuse_handle();
    MPI_Comm_set_errhandler(communicator_, MPI_ERRORS_RETURN);
    MPI_Comm_size(communicator_, &ranks_);
    MPI_Query_thread(&threads_);
  }
  ~MpiLink() override {
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (finalized == 0) MPI_Comm_free(&communicator_);
  }
  int ranks() const override { return ranks_; }

  /// Its length, then the bytes in pieces.
  void send(int rank, std::span<const std::byte> message) override {
    const std::uint64_t length = message.size();
    expect_success(MPI_Send(&length, 1, MPI_UINT64_T, rank, tag, communicator_), "a message");
    for (std::size_t at = 0; at < message.size(); at += piece)
      expect_success(
          MPI_Send(message.data() + at, int(std::min(piece, message.size() - at)), MPI_BYTE, rank, tag, communicator_),
          "a message");
  }

  void receive(int rank, Bytes& message) override {
    std::uint64_t length = 0;
    expect_success(MPI_Recv(&length, 1, MPI_UINT64_T, rank, tag, communicator_, MPI_STATUS_IGNORE), "a message");
    try {
      message.resize(length);
    } catch (...) {
      std::byte none;
      for (std::size_t at = 0; at < length; at += piece)  // taken off the line, cut short
        MPI_Recv(&none, 1, MPI_BYTE, rank, tag, communicator_, MPI_STATUS_IGNORE);
      throw std::bad_alloc();
    }
    for (std::size_t at = 0; at < length; at += piece)
      expect_success(MPI_Recv(message.data() + at, int(std::min<std::uint64_t>(piece, length - at)), MPI_BYTE, rank,
                              tag, communicator_, MPI_STATUS_IGNORE),
                     "a message");
  }

  void expect_thread() const override {
    if (threads_ >= MPI_THREAD_SERIALIZED) return;
    int main = 0;
    MPI_Is_thread_main(&main);
    if (main == 0)
      throw Refused(Status::bad_input,
                    "pool: MPI was initialised for one thread, and this is another; call "
                    "MPI_Init_thread with MPI_THREAD_SERIALIZED, or the pool from the thread that "
                    "initialised MPI");
  }

  MPI_Comm communicator() const { return communicator_; }

 private:
  MPI_Comm communicator_ = MPI_COMM_NULL;
  int ranks_ = 1, threads_ = MPI_THREAD_SINGLE;
};

MPI_Comm communicator_of(const Link& link) { return static_cast<const MpiLink&>(link).communicator(); }

}  // namespace

World join(std::int32_t fortran_communicator) {
  int initialised = 0, finalised = 0;
  MPI_Initialized(&initialised);
  MPI_Finalized(&finalised);
  if (initialised == 0 || finalised != 0)
    throw Refused(Status::bad_input,
                  "rvelab_mpi_pool_create: MPI is not initialised; call MPI_Init before, and "
                  "MPI_Finalize after rvelab_pool_destroy");
  const MPI_Comm given = MPI_Comm_f2c(fortran_communicator);
  if (given == MPI_COMM_NULL) refuse_handle();
  World world;
  world.link = std::make_unique<MpiLink>(given);
  MPI_Comm_rank(communicator_of(*world.link), &world.rank);
  MPI_Comm here;
  expect_success(MPI_Comm_split_type(communicator_of(*world.link), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here),
                 "a communicator");
  MPI_Comm_size(here, &world.ranks_here);
  MPI_Comm_free(&here);
  return world;
}

void broadcast(const Link& link, std::span<std::byte> bytes) {
  expect_success(MPI_Bcast(bytes.data(), int(bytes.size()), MPI_BYTE, 0, communicator_of(link)), "a broadcast");
}

void expect_all(const Link& link, Status status, const std::string& text) {
  auto worst = std::int32_t(status);
  expect_success(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT32_T, MPI_MIN, communicator_of(link)), "a reduction");
  if (status != Status::ok) throw Refused(status, text);
  if (worst != 0)
    throw Refused(Status(worst), "rvelab_mpi_pool_create: another rank refused; its rvelab_last_error() says why");
}

}  // namespace rvelab::ranks
