// A study run over the cores, piece by piece (measures.hpp). What a piece gives depends on the study alone, times
// apart: neither on the number of threads nor on which pieces were there before.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "rvelab/study/measures.hpp"
#include "rvelab/study/study.hpp"

namespace rvelab::study {

/// Functions that a study calls to keep its pieces and to show progress. All functions may be empty. `keep` and
/// `on_progress` come from any thread, one call at a time.
struct Keeper {
  unsigned threads = 0;                                          ///< 0: one per core
  std::function<std::optional<Piece>(const std::string&)> kept;  ///< a piece that is there by its name
  std::function<void(const std::string&, const Piece&)> keep;    ///< one that was made
  /// Piece `number` of all, counted from 0: the part of it that is done, 0 to 1, and its grain-steps so far.
  std::function<void(std::size_t number, const std::string& name, double part, double grain_steps)> on_progress;
  const std::atomic<bool>* stop = nullptr;
};

struct Pieces {
  std::map<std::string, Piece> by_name;
  bool complete = true;  ///< false: stopped
};

std::size_t planned_pieces(const Study& study, const Prepared& prepared);

/// Runs what is not kept yet. Whole paths of a specimen come first, its reference path ahead of them; then the
/// reference's answers; then the increments of one grid point after the other. Throws InputError where a path cannot
/// start, Error where the reference path cannot be carried out.
Pieces run_study(const Study& study, const Prepared& prepared, const Keeper& keeper);

}  // namespace rvelab::study
