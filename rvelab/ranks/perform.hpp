// Messages between ranks: a call of the share that a rank has of the pool, and the answer.
#pragma once

#include "rvelab/pool/threaded_pool.hpp"

namespace rvelab::ranks {

using pool::Bytes;
using pool::Packer;
using pool::Unpacker;

/// A message begins with the number of a function in ShareCalls, with pool::call_by_name, or with one of these, which
/// ranks serve in their own way. What follows, and what the answer holds behind its verdict, stands in perform.cpp.
enum class RankCall : std::int32_t { end = -1, trial = -2, apply = -3 };

/// Virtual functions of a share that ranks ask of each other; the place of each is its number in a message.
template <auto... functions>
class CallList {
 public:
  template <auto wanted>
  static constexpr std::int32_t number() {
    std::int32_t at = 0, found = -1;
    ((std::is_same_v<Name<wanted>, Name<functions>> ? found = at++ : at++), ...);
    return found;
  }
  /// Number and arguments.
  template <auto function, class... Arguments>
  static void put(Packer& to, const Arguments&... arguments) {
    static_assert(number<function>() >= 0, "the function is missing in the list of calls");
    to.put(number<function>());
    pool::SignatureOf<function>::put(to, arguments...);
  }
  /// Calls the function of that number.
  static void serve(std::int32_t number, pool::Share& share, Unpacker& given, Packer& found) {
    std::int32_t at = 0;
    const bool known =
        ((at++ == number && (pool::SignatureOf<functions>::template serve<functions>(share, given, found), true)) ||
         ...);
    if (!known)
      throw pool::Refused(pool::Status::internal, "a message between ranks has an unknown number: please report this");
  }

 private:
  template <auto>
  struct Name;
};

using ShareCalls = CallList<&pool::Share::release_template, &pool::Share::save, &pool::Share::add_template_as,
                            &pool::Share::spawn_as, &pool::Share::clone_as, &pool::Share::costs, &pool::Share::pack,
                            &pool::Share::receive, &pool::Share::place, &pool::Share::forget_received,
                            &pool::Share::give_up, &pool::Share::prepare, &pool::Share::settle>;

/// What a trial says beside ids and increments: which results it computes, a bit for each of pool::batch_outputs, and
/// whether tokens go in and out.
struct Wanted {
  std::uint32_t outputs;
  bool tokens_in, tokens_out;
};

inline Packer message(RankCall call) { return std::move(Packer().put(call)); }
/// The call of a function in ShareCalls.
template <auto function, class... Arguments>
Bytes message(const Arguments&... arguments) {
  Packer packer;
  ShareCalls::put<function>(packer, arguments...);
  return packer.take();
}

class Served {
 public:
  explicit Served(std::unique_ptr<pool::Share> share) : share_(std::move(share)) {}

  /// The answer: a status, its text, and what was found. Failures are answers, never thrown; empty: no memory was left
  /// for one.
  Bytes answer(std::span<const std::byte> message) noexcept;
  pool::Share& share() const { return *share_; }

 private:
  void trial(Unpacker& given, Packer& found);
  void apply(Unpacker& given, Packer& found);

  std::unique_ptr<pool::Share> share_;
  std::vector<std::int64_t> tried_;  ///< ids of trials that no answer tells of yet
  Bytes settled_;                    ///< the answer to Share::settle, made with that to Share::prepare
};

/// An answer opened, which allocates nothing: what it tells of has been done.
class Answer {
 public:
  explicit Answer(Bytes bytes);
  pool::Status status() const { return status_; }
  std::string_view text() const { return text_; }
  bool failed() const { return failed_; }
  /// Throws Refused with status and text of a call that was refused.
  void expect_done() const;
  Unpacker& found() { return found_; }

 private:
  Bytes bytes_;
  Unpacker found_;
  pool::Status status_ = pool::Status::ok;
  std::string_view text_;
  bool failed_ = false;
};

/// Bytes reserved for what an answer holds beside its rows of values, so that telling what was done allocates nothing.
constexpr std::size_t answer_room = 4096;

// The way of messages from rank to rank. mpi_link.cpp alone knows of MPI.

/// Of the first rank, to all others. Each message to a rank is answered before the next is sent to it.
class Link {
 public:
  virtual ~Link() = default;
  virtual int ranks() const = 0;
  virtual void send(int rank, std::span<const std::byte> message) = 0;
  /// The next message from that rank, in the room that `message` has if that is enough. What cannot be kept for want
  /// of memory is taken all the same and let go of (std::bad_alloc).
  virtual void receive(int rank, Bytes& message) = 0;
  /// Throws Refused (bad_input) if this thread may not send.
  virtual void expect_thread() const = 0;
};

/// A link over the communicator of a Fortran handle; collective. Throws Refused (bad_input) if MPI was not initialised,
/// or the handle is none.
struct World {
  std::unique_ptr<Link> link;
  int rank = 0;
  int ranks_here = 1;  ///< that share the memory, and the cores, of this one
};
World join(std::int32_t fortran_communicator);

/// Bytes of the first rank, at all of them; collective. They are as many everywhere.
void broadcast(const Link& link, std::span<std::byte> bytes);
/// Throws Refused unless `status` is ok at all ranks; collective. `text` explains that of this one.
void expect_all(const Link& link, pool::Status status, const std::string& text);

}  // namespace rvelab::ranks
