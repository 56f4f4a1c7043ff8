// A team of threads for independent pieces of work. Which thread does which piece must not matter to the result.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace rvelab {

class Workers {
 public:
  /// `threads` in all, the caller's included; 0 counts as 1.
  explicit Workers(unsigned threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  unsigned threads() const;

  /// Calls work(0) .. work(count - 1), each once, each on some thread, in no order; returns when all are done. An
  /// exception of a piece does not stop the others; the one of the lowest piece is thrown at the end.
  void run(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  struct Team;
  std::unique_ptr<Team> team_;
};

/// Grains from which a team shares the work on one cell: two hand-overs a step cost some 20 us.
constexpr std::size_t least_shared_grains = 30'000;

/// Pieces of work that is done once a list, not once a step.
constexpr std::size_t piece_length = 4096;
constexpr std::size_t pieces_in(std::size_t count) { return (count + piece_length - 1) / piece_length; }

/// Calls work(piece, first, last) for all pieces of `count` things; on the team if there is one.
template <class Work>
void in_pieces(std::size_t count, Workers* team, const Work& work) {
  const auto one = [&](std::size_t k) {
    const std::size_t end = (k + 1) * piece_length;
    work(k, k * piece_length, end < count ? end : count);
  };
  if (team != nullptr && pieces_in(count) > 1)
    team->run(pieces_in(count), [&one](std::size_t k) { one(k); });
  else
    for (std::size_t k = 0; k < pieces_in(count); ++k) one(k);
}

}  // namespace rvelab
