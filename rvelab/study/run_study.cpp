#include "rvelab/study/run_study.hpp"

#include <algorithm>
#include <mutex>

#include "rvelab/error.hpp"
#include "rvelab/study/measures.hpp"

namespace rvelab::study {
namespace {

class Running {
 public:
  Running(const Study& study, const Prepared& prepared, const Keeper& keeper)
      : study_(study),
        prepared_(prepared),
        keeper_(keeper),
        runner_(keeper),
        spans_(longest_increments(prepared.reference, prepared.points)) {}

  Pieces run() {
    take_kept();
    try {
      for (std::size_t s = 1; s <= prepared_.specimens.size(); ++s) run_specimen(s);
    } catch (const Interrupted&) {
      pieces_.complete = false;
    }
    return std::move(pieces_);
  }

 private:
  std::size_t points() const { return prepared_.points.size(); }
  std::size_t repeats() const { return std::size_t(study_.repeats); }
  const protocol::Protocol& protocol(std::size_t point) const {
    return point == 0 ? prepared_.reference : prepared_.points[point - 1];
  }
  std::string name(std::size_t point) const {
    return point == 0 ? "reference" : name_of(assignments_at(study_.grid, point - 1));
  }
  bool there(const std::string& piece) const { return pieces_.by_name.contains(piece); }

  // Numbers of pieces: those of a specimen follow each other, whole paths first.
  std::size_t first_number(std::size_t s) const {
    return (s - 1) * (points() + 1) * (repeats() + (study_.increments > 0 ? 1 : 0));
  }
  std::size_t path_number(std::size_t point, std::size_t s, std::size_t repeat) const {
    return first_number(s) + point * repeats() + repeat - 1;
  }
  std::size_t increments_number(std::size_t point, std::size_t s) const {
    return first_number(s) + (points() + 1) * repeats() + point;
  }

  /// Where it is stopped, what follows does not begin.
  void each(std::size_t count, const std::function<void(std::size_t)>& one) {
    if (!runner_.each(count, one)) throw Interrupted();
  }

  void take_kept() {
    const auto take = [&](const std::string& piece, std::size_t number) {
      auto found = keeper_.kept ? keeper_.kept(piece) : std::nullopt;
      if (!found) return;
      pieces_.by_name[piece] = std::move(*found);
      runner_.done(number);
    };
    for (std::size_t s = 1; s <= prepared_.specimens.size(); ++s) {
      for (std::size_t point = 0; point <= points(); ++point) {
        for (std::size_t r = 1; r <= repeats(); ++r) take(path_piece(point, s, r), path_number(point, s, r));
        if (study_.increments > 0) take(increments_piece(point, s), increments_number(point, s));
      }
    }
  }

  void put(const std::string& piece_name, Piece piece, std::size_t number) {
    {
      const std::lock_guard lock(mutex_);
      if (keeper_.keep) keeper_.keep(piece_name, piece);
      pieces_.by_name[piece_name] = std::move(piece);
    }
    runner_.done(number);
  }

  bool increments_missing(std::size_t s) const {
    if (study_.increments == 0) return false;
    for (std::size_t point = 0; point <= points(); ++point) {
      if (!there(increments_piece(point, s))) return true;
    }
    return false;
  }

  /// The path with the reference settings: its states, and its piece as the first repeat of the reference.
  void run_reference_path(std::size_t s) {
    const std::size_t number = repeats() > 0 ? path_number(0, s, 1) : increments_number(0, s);
    const double begin = processor_seconds();
    ReferencePath path;
    try {
      path = reference_path(prepared_.reference, prepared_.specimens[s - 1], std::size_t(study_.increments), spans_,
                            runner_.watch(number, name(0)));
    } catch (const InputError&) {
      throw;
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      throw Error(std::string("the reference path cannot be carried out: ") + error.what());
    }
    states_ = std::move(path.states);
    if (repeats() == 0 || there(path_piece(0, s, 1))) return;
    put(path_piece(0, s, 1), measured_path(path.run, processor_seconds() - begin), number);
  }

  void run_path(std::size_t point, std::size_t s, std::size_t repeat) {
    const std::size_t number = path_number(point, s, repeat);
    try {
      const Specimen specimen = perturbed(prepared_.specimens[s - 1], repeat);
      put(path_piece(point, s, repeat), whole_path(protocol(point), specimen, runner_.watch(number, name(point))),
          number);
    } catch (const InputError& error) {
      throw InputError(name(point) + ": " + error.what());
    }
  }

  void run_specimen(std::size_t s) {
    states_.clear();
    std::vector<std::function<void()>> paths;
    const bool with_states = increments_missing(s);
    if (with_states) paths.emplace_back([this, s] { run_reference_path(s); });
    for (std::size_t point = 0; point <= points(); ++point) {
      for (std::size_t r = 1; r <= repeats(); ++r) {
        const bool by_reference_path = with_states && point == 0 && r == 1;
        if (by_reference_path || there(path_piece(point, s, r))) continue;
        paths.emplace_back([this, point, s, r] { run_path(point, s, r); });
      }
    }
    each(paths.size(), [&](std::size_t k) { paths[k](); });
    if (!with_states) return;
    if (!there(increments_piece(0, s))) answer(s);
    for (std::size_t point = 1; point <= points(); ++point) {
      if (!there(increments_piece(point, s))) measure(point, s);
    }
  }

  /// Does something with each state on the team; the failures of single states are noted, the first one as the piece's.
  template <class Make>
  void for_states(Piece& piece, std::size_t point, std::size_t s, Make make) {
    for (const std::string& column : increment_columns) piece.columns[column].assign(states_.size(), no_value);
    std::vector<std::string> failures(states_.size());
    std::size_t done = 0;
    double grain_steps = 0;
    each(states_.size(), [&](std::size_t k) {
      double made = 0;
      try {
        made = make(k);
      } catch (const Interrupted&) {
        throw;
      } catch (const Error& error) {
        failures[k] = error.what();
      }
      std::unique_lock lock(mutex_);
      grain_steps += made;
      const double part = 0.999 * double(++done) / double(states_.size());
      const double so_far = grain_steps;
      lock.unlock();
      runner_.show(increments_number(point, s), name(point), part, so_far);
    });
    for (const std::string& failure : failures) {
      if (piece.failure.empty()) piece.failure = failure;
    }
    put(increments_piece(point, s), std::move(piece), increments_number(point, s));
  }

  Opening opening(std::size_t point, std::size_t s, const PathState& from) const {
    return {protocol(point), prepared_.specimens[s - 1],
            parts_of(protocol(point), prepared_.reference, from.stage, from.records), keeper_.stop};
  }

  static void note(Piece& piece, std::size_t k, double error, double pressure, double increment, const Made& made) {
    piece.columns.at("error_Pa")[k] = error;
    piece.columns.at("pressure_Pa")[k] = pressure;
    piece.columns.at("increment_Pa")[k] = increment;
    piece.columns.at("estimate_Pa")[k] = made.estimate;
    piece.columns.at("allowed_Pa")[k] = made.allowed;
    piece.columns.at("seconds")[k] = made.seconds;
    piece.columns.at("grain_steps")[k] = made.grain_steps;
  }

  /// The reference's answers; its own error is what the relaxation still changes.
  void answer(std::size_t s) {
    Piece piece;
    auto& stress = piece.columns["stress_Pa"];
    auto& at_rest = piece.columns["at_rest"];
    auto &stage = piece.columns["stage"], &strain = piece.columns["strain"];
    stress.assign(9 * states_.size(), no_value);
    for (auto* column : {&at_rest, &stage, &strain}) column->assign(states_.size(), no_value);
    for_states(piece, 0, s, [&](std::size_t k) {
      const PathState& from = states_[k];
      const Answer answer = reference_answer(from, opening(0, s, from), study_.relaxation);
      for (int c = 0; c < 9; ++c) stress[9 * k + std::size_t(c)] = answer.stress(c / 3, c % 3);
      at_rest[k] = answer.at_rest ? 1 : 0;
      stage[k] = from.stage;
      strain[k] = from.strain;
      note(piece, k, (answer.made.stress - answer.stress).norm(), answer.pressure, answer.increment, answer.made);
      return answer.made.grain_steps;
    });
  }

  void measure(std::size_t point, std::size_t s) {
    const Piece& answers = pieces_.by_name.at(increments_piece(0, s));
    if (answers.column("error_Pa").size() != states_.size()) {
      throw InputError(increments_piece(0, s) + " holds " + std::to_string(answers.column("error_Pa").size()) +
                       " increments where the path has " + std::to_string(states_.size()) +
                       "; allowed: pieces of this study; start it again with --force");
    }
    Piece piece;
    for_states(piece, point, s, [&](std::size_t k) {
      const Made made = made_increment(states_[k], opening(point, s, states_[k]));
      Matrix3 stress;
      for (int c = 0; c < 9; ++c) stress(c / 3, c % 3) = answers.column("stress_Pa")[9 * k + std::size_t(c)];
      note(piece, k, (made.stress - stress).norm(), answers.column("pressure_Pa")[k], answers.column("increment_Pa")[k],
           made);
      return made.grain_steps;
    });
  }

  const Study& study_;
  const Prepared& prepared_;
  const Keeper& keeper_;
  protocol::Runner runner_;
  std::vector<long> spans_;
  std::vector<PathState> states_;  ///< of the specimen under way
  Pieces pieces_;
  std::mutex mutex_;
};

}  // namespace

std::size_t planned_pieces(const Study& study, const Prepared& prepared) {
  const auto a_point = std::size_t(study.repeats + (study.increments > 0 ? 1 : 0));
  return prepared.specimens.size() * (prepared.points.size() + 1) * a_point;
}

Pieces run_study(const Study& study, const Prepared& prepared, const Keeper& keeper) {
  return Running(study, prepared, keeper).run();
}

}  // namespace rvelab::study
