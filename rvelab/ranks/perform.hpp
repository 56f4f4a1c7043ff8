// What a rank does with a message: a call of its share of the pool, and the answer.
#pragma once

#include "rvelab/pool/threaded_pool.hpp"

namespace rvelab::ranks {

using pool::Bytes;
using pool::Packer;
using pool::ShareCalls;
using pool::Unpacker;

/// A message begins with the number of a function in pool::ShareCalls, or with one of these, which ranks serve in their
/// own way. What follows, and what the answer holds behind its verdict, stands in perform.cpp.
enum class RankCall : std::int32_t { end = -1, trial = -2, apply = -3, cost = -4, save = -5, receive = -6 };

/// Which results a trial computes beside stress, status, costs and factors on the step; whether it names tokens.
struct Wanted {
  bool contact_stress, reynolds_stress, tangent, error_estimate, tokens_out, tokens_in;
};

inline Packer message(RankCall call) { return std::move(Packer().put(call)); }
/// The call of a function in pool::ShareCalls.
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
  void perform(std::int32_t number, Unpacker& given, Packer& found);
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

}  // namespace rvelab::ranks
