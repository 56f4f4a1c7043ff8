#include "rvelab/solver/loading/sweep.hpp"

#include <algorithm>
#include <array>

#include "rvelab/solver/assembly/gather_table.hpp"

namespace rvelab {

namespace {

constexpr long piece_pairs = 8192, piece_grains = 4096;
static_assert(piece_grains % chunk_grains == 0, "a chunk has one gather table");
/// Grains whose pairs are updated at a time where they are just in time.
constexpr long block_grains = 2048;
/// Pieces between two additions of their sums; their number is a limit on the team's size only.
constexpr std::size_t round_pieces = 64;

/// Calls work(piece) for all pieces. The function object holds one reference: nothing is allocated in the step loop.
template <class Work>
void each_piece(std::size_t pieces, Workers* team, const Work& work) {
  if (team != nullptr && pieces > 1)
    team->for_each(pieces, [&work](std::size_t piece) { work(piece); });
  else
    for (std::size_t piece = 0; piece < pieces; ++piece) work(piece);
}

std::size_t pieces_of(long count, long piece) { return std::size_t((count + piece - 1) / piece); }

void add(const StepSums& piece, StepSums& sums) {
  for (int k = 0; k < 3; ++k) sums.momentum[k] += piece.momentum[k];
  sums.largest_speed_squared = std::max(sums.largest_speed_squared, piece.largest_speed_squared);
  sums.local_damping += piece.local_damping;
  sums.global_damping += piece.global_damping;
}

}  // namespace

void sweep_pairs(PairKernel kernel, const StepConstants& constants, const PairArrays& pairs, const double* grain_rows,
                 long padded_pairs, Workers* team) {
  each_piece(pieces_of(padded_pairs, piece_pairs), team, [&](std::size_t piece) {
    const long begin = long(piece) * piece_pairs;
    kernel(constants, pairs, grain_rows, begin, std::min(padded_pairs, begin + piece_pairs), nullptr);
  });
}

namespace {

/// Calls work(begin, end, sums of the piece) for all pieces, and adds up.
template <class Work>
void sum_of_pieces(long count, Workers* team, StepSums& sums, const Work& work) {
  const std::size_t pieces = pieces_of(count, piece_grains);
  // Most cells: the sums of a round, set to zero, took 3 % of the instructions of a biaxial test with 400 discs.
  if (pieces == 1) return work(0, count, &sums);
  std::array<StepSums, round_pieces> of_piece;
  for (std::size_t first = 0; first < pieces; first += round_pieces) {
    const std::size_t of_round = std::min(round_pieces, pieces - first);
    each_piece(of_round, team, [&](std::size_t k) {
      const long begin = long(first + k) * piece_grains;
      work(begin, std::min(count, begin + piece_grains), &of_piece[k]);
    });
    for (std::size_t k = 0; k < of_round; ++k) {
      if (first + k == 0)
        sums = of_piece[0];
      else
        add(of_piece[k], sums);
    }
  }
}

}  // namespace

void sweep_grains(GrainKernel kernel, const StepConstants& constants, const GrainArrays& grains,
                  const PairArrays& pairs, long padded_grains, Workers* team, StepSums& sums) {
  sum_of_pieces(padded_grains, team, sums, [&](long begin, long end, StepSums* of_piece) {
    kernel(constants, grains, pairs, begin, end, of_piece);
  });
}

void sweep_bodies(const Kernels& kernels, bool at_rate, const StepConstants& constants, const BodyConstants& of_bodies,
                  const GrainArrays& grains, const PairArrays& pairs, const BodyArrays& bodies, long padded_bodies,
                  long padded_members, Workers* team, StepSums& sums) {
  each_piece(pieces_of(padded_members, piece_grains), team, [&](std::size_t piece) {
    const long begin = long(piece) * piece_grains;
    kernels.gather_on_members(grains, pairs, bodies, begin, std::min(padded_members, begin + piece_grains));
  });
  const auto sweep = [&](BodyKernel kernel, long count, StepSums& of_kernel) {
    sum_of_pieces(count, team, of_kernel, [&](long begin, long end, StepSums* of_piece) {
      kernel(constants, of_bodies, bodies, grains.rows, begin, end, of_piece);
    });
  };
  sweep(kernels.move_bodies[at_rate ? 1 : 0], padded_bodies, sums);
  if (kernels.place_members == nullptr) return;
  StepSums of_members;
  sweep(kernels.place_members, padded_members, of_members);
  sums.largest_speed_squared = of_members.largest_speed_squared;
}

void WaitingPairs::arrange(PairKernel kernel, PairTable& pairs) {
  kernel_ = kernel;
  table_ = &pairs;
  const auto places = [&](std::size_t begin, std::size_t end) {
    std::size_t ascending = begin;
    while (ascending + 1 < end && pairs.i[ascending] <= pairs.i[ascending + 1]) ++ascending;
    return Places{long(begin), ascending + 1 < end ? long(ascending + 1) / 8 * 8 : long(end), long(end), 0};
  };
  near_ = places(0, pairs.near);
  beyond_ = places(pairs.near, pairs.padded());
}

void WaitingPairs::wait(const StepConstants& constants) {
  constants_ = constants;
  waiting_ = true;
}

void WaitingPairs::update(long begin, long end) {
  if (begin == end) return;
  kernel_(constants_, pairs_, rows_, begin, end, nullptr);
  gather_pairs_that_touch(*table_, std::size_t(begin), std::size_t(end));
}

void WaitingPairs::update_up_to(long grain) {
  grain = (grain + block_grains - 1) / block_grains * block_grains;
  for (Places* places : {&near_, &beyond_}) {
    long to = places->next;
    while (to < places->ascending_end && table_->i[std::size_t(to)] < grain) to += 8;
    update(places->next, to);
    places->next = to;
  }
}

void WaitingPairs::sweep_with_grains(GrainKernel kernel, const StepConstants& constants, GrainArrays grains,
                                     const PairArrays& pairs, long padded_grains, StepSums& sums) {
  pairs_ = pairs;
  rows_ = grains.rows;
  for (Places* places : {&near_, &beyond_}) {
    update(places->ascending_end, places->end);
    places->next = places->begin;
  }
  grains.sweep = this;
  grains.before_chunk = [](void* sweep, long end) { static_cast<WaitingPairs*>(sweep)->update_up_to(end); };
  sweep_grains(kernel, constants, grains, pairs, padded_grains, nullptr, sums);
  waiting_ = false;
}

}  // namespace rvelab
