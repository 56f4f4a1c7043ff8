// A study run over the cores, piece by piece (measures.hpp). What a piece gives depends on the study alone, times
// apart: neither on the number of threads nor on which pieces were there before.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "rvelab/protocol/runner.hpp"
#include "rvelab/study/measures.hpp"
#include "rvelab/study/study.hpp"

namespace rvelab::study {

/// How a study is run, and functions that it calls to keep its pieces. They may be empty; `keep` comes from any thread,
/// one call at a time. Progress is that of pieces, counted from 0.
struct Keeper : protocol::RunnerOptions {
  std::function<std::optional<Piece>(const std::string&)> kept;  ///< a piece that is there by its name
  std::function<void(const std::string&, const Piece&)> keep;    ///< one that was made
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
