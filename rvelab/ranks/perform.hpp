// What a rank does with a message: one call on its share of the pool, and the answer.
#pragma once

#include <map>

#include "rvelab/pool/threaded_pool.hpp"
#include "rvelab/ranks/message.hpp"

namespace rvelab::ranks {

/// Begins each message; what follows, and what the answer holds behind its verdict, stands in perform.cpp.
enum class Call : std::int32_t {
  end,
  add_template,
  release_template,
  spawn,
  clone,
  give_up,
  apply,
  trial,
  prepare,
  settle,
  info,
  cost,
  save,
  load,
  receive,
  place,
  forget_received,
};

/// Which results a trial is asked for beside stress, status, costs and factors on the step; whether it names tokens.
struct Wanted {
  bool contact_stress, reynolds_stress, tangent, error_estimate, tokens_out, tokens_in;
};

class Served {
 public:
  explicit Served(std::unique_ptr<pool::Share> share) : share_(std::move(share)) {}

  /// The answer: a status, its text, and what was found. Failures are answers, never thrown; empty: no memory was left
  /// for one.
  Bytes answer(std::span<const std::byte> message) noexcept;
  pool::Share& share() const { return *share_; }

 private:
  void perform(Call call, Unpacker& given, Packer& found);
  void trial(Unpacker& given, Packer& found);

  std::unique_ptr<pool::Share> share_;
  std::map<std::int64_t, std::int64_t> templates_;  ///< of this share, by their numbers on the first rank
  std::vector<std::int64_t> tried_;                 ///< ids of trials that no answer tells of yet
  Bytes settled_;                                   ///< the answer to Call::settle, made when it was prepared
};

/// An answer opened, which asks for no memory: what it tells of has been done.
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

/// Room for what an answer holds beside its rows of values: what is done is told without a request for memory.
constexpr std::size_t answer_room = 4096;

/// As an answer to Call::info holds it.
pool::Info take_info(Unpacker& from);

}  // namespace rvelab::ranks
