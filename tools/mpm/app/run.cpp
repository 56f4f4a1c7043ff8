#include "tools/mpm/app/run.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <iomanip>
#include <iostream>

#include "rvelab/io/utf8.hpp"
#include "tools/mpm/app/changes.hpp"
#include "tools/mpm/output/checkpoint.hpp"
#include "tools/mpm/output/output.hpp"
#include "tools/mpm/output/rocks.hpp"
#include "tools/mpm/rocks/rocks.hpp"
#include "tools/mpm/scene/checks.hpp"
#include "tools/mpm/step/watch.hpp"

namespace mpm {
namespace {

constexpr long steps_between_balances = 64;  // a balance takes a hundredth of a step
volatile std::sig_atomic_t interrupted = 0;
void interrupt(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);  // a second one ends the run at once
}

using Clock = std::chrono::steady_clock;

/// One line on a terminal, over itself.
class ProgressLine {
 public:
  ProgressLine(bool quiet, double from, double to) : shown_(!quiet && isatty(2) != 0), from_(from), to_(to) {}
  void show(double time, long steps) {
    const auto now = Clock::now();
    if (!shown_ || std::chrono::duration<double>(now - last_).count() < 0.5) return;
    last_ = now;
    const double spent = std::chrono::duration<double>(now - begin_).count();
    const double left = time > from_ ? spent * (to_ - time) / (time - from_) : 0;
    std::fprintf(stderr, "\r%6.2f %% of %g s, %ld steps, %.0f s left   ", 100 * time / to_, to_, steps, left);
  }
  ~ProgressLine() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }

 private:
  bool shown_;
  double from_, to_;
  Clock::time_point begin_ = Clock::now(), last_ = begin_;
};

/// s of all threads of this process.
double processor_time() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
         1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

template <int D>
double grain_steps_of(const Model<D>& model) {
  double sum = 0;
  for (const auto& group : model.solver.groups) sum += group.material->grain_steps();
  return sum;
}

/// What the loop takes, and makes, from here on.
template <int D>
class Cost {
 public:
  explicit Cost(const Model<D>& model)
      : model_(model), steps_(model.solver.steps), processor_(processor_time()), grain_steps_(grain_steps_of(model)) {}

  void print(std::ostream& report) const {
    const auto& solver = model_.solver;
    const double wall = seconds_since(begin_), processor = processor_time() - processor_;
    const double grain_steps = grain_steps_of(model_), whole = solver.grid_seconds + solver.material_seconds;
    const long steps = solver.steps - steps_;
    double grains = 0;
    for (const auto& group : solver.groups) grains += group.material->seconds;
    report << std::setprecision(4) << "points " << solver.points.size() << ", steps " << solver.steps << " (" << steps
           << " now), threads " << solver.workers.count() << ", wall " << wall << " s, processor " << processor
           << " s\n"
           << "continuum " << whole - grains << " s, grains " << grains << " s ("
           << 100 * grains / std::max(whole, 1e-12) << " %)";
    if (solver.fluid) {
      report << ", pore pressure " << solver.fluid->seconds << " s ("
             << 100 * solver.fluid->seconds / std::max(whole, 1e-12) << " %)";
    }
    if (solver.rocks) {
      report << ", rocks " << solver.rocks->seconds << " s, soil on rocks " << solver.rocks->soil_seconds << " s ("
             << 100 * (solver.rocks->seconds + solver.rocks->soil_seconds) / std::max(whole, 1e-12) << " %)";
    }
    report << "\n";
    if (grains > 0) {
      report << "grain-steps " << grain_steps << ", " << (grain_steps - grain_steps_) / grains / 1e6 << " M a second";
      for (const auto& [name, each] : model_.grains) {
        report << "; " << name << ": " << each->called << " of " << each->asked << " increments called, " << each->split
               << " in parts, " << each->warned << " with a warning";
      }
      report << "\n";
    } else if (steps > 0 && !solver.points.empty()) {
      report << double(solver.points.size()) * double(steps) / wall / 1e6 << " M point-steps a second\n";
    }
  }

 private:
  const Model<D>& model_;
  Clock::time_point begin_ = Clock::now();
  long steps_;
  double processor_, grain_steps_;
};

/// The first multiple of `every` above `now`, from `next` on.
void advance_past(double now, double every, double& next) {
  while (next <= now) next += every;
}

/// The outputs of a run, each at its time.
template <int D>
class Outputs {
 public:
  Outputs(const Scene& scene, const RunOptions& options, Model<D>& model, Progress& progress)
      : scene_(scene),
        folder_(options.folder),
        model_(model),
        progress_(progress),
        history_(path("history.csv"), progress.history),
        watched_(path("watched.csv"), progress.watched),
        saved_(options.resume ? model.solver.time : -1) {
    if (!options.scene_text.empty()) write_scene(folder_, options.scene_text);
  }

  void row() {
    const auto& solver = model_.solver;
    history_.add(history_row<D>(solver, progress_.start, solver.time - progress_.last_row, progress_.impulses));
    watched_.add(watched_row<D>(model_));
    progress_.last_row = solver.time;
    advance_past(solver.time, scene_.history_every, progress_.next_row);
  }
  void frame() {
    const auto& solver = model_.solver;
    auto& times = progress_.frame_times;
    times.push_back(solver.time);
    write_frame<D>(model_, folder_, times);
    if (scene_.networks) write_networks<D>(model_, folder_, long(times.size()) - 1);
    if (solver.rocks) {
      write_rock_frame<D>(solver, folder_, times);
      write_rock_tables<D>(solver, folder_);
    }
    advance_past(solver.time, scene_.frame_every, progress_.next_frame);
  }
  void save() {
    progress_.history = history_.written();
    progress_.watched = watched_.written();
    write_checkpoint<D>(model_, progress_, folder_);
    saved_ = model_.solver.time;
  }
  /// What is due after a step.
  void after_step(bool last) {
    if (model_.solver.time >= progress_.next_row || last) row();
    if (model_.solver.time >= progress_.next_frame || last) frame();
  }
  void checkpoint_if_due(bool now) {
    if (model_.solver.time < progress_.next_checkpoint && !now) return;
    advance_past(model_.solver.time, scene_.checkpoint_every, progress_.next_checkpoint);
    save();
  }
  /// A run that a check ends keeps a checkpoint.
  template <class Check>
  void checked(const Check& check) {
    try {
      check();
    } catch (const std::runtime_error& reason) {
      if (saved_ < 0) save();
      throw std::runtime_error(reason.what() + ("; " + folder_) + " keeps the checkpoint of " + in_words(saved_) +
                               " s");
    }
  }

 private:
  std::string path(const char* name) const { return (std::filesystem::path(folder_) / name).string(); }

  const Scene& scene_;
  const std::string& folder_;
  Model<D>& model_;
  Progress& progress_;
  Rows history_, watched_;
  double saved_;  ///< s, the time of the checkpoint; below 0: there is none
};

/// Steps to the end of the scene, or until the run is stopped; whether it was.
template <int D>
bool step_to_end(const Scene& scene, const RunOptions& options, Model<D>& model, Progress& progress,
                 Outputs<D>& outputs, std::ostream& report) {
  Solver<D>& solver = model.solver;
  ProgressLine line(options.quiet, solver.time, scene.duration);
  bool stopped = false;
  while (solver.time < scene.duration && !stopped) {
    outputs.checked([&] { make_changes<D>(scene, model, report); });
    double dt = solver.stable_step();
    if (solver.points.empty()) dt = std::min(dt, scene.history_every);  // rocks alone have sub-steps
    outputs.checked([&] {
      watch_step<D>(solver, dt, progress.seen, std::cerr);
      watch_length<D>(solver, dt, 1, scene.duration);
    });
    const double before = solver.rocks ? double(solver.rocks->sub_steps) : 0;
    const bool last = solver.time + dt >= scene.duration;
    if (last) dt = scene.duration - solver.time;
    solver.step(dt);
    if (last) solver.time = scene.duration;
    if (solver.rocks && !last) {
      const double sub_steps = double(solver.rocks->sub_steps) - before;
      outputs.checked([&] { watch_length<D>(solver, dt, sub_steps, scene.duration); });
    }
    outputs.after_step(last);
    stopped = !last && (interrupted != 0 || solver.time >= options.stop_at);
    if (solver.steps % steps_between_balances == 0 || last) {
      outputs.checked([&] { watch_energy<D>(solver, progress.start, progress.seen, std::cerr); });
    }
    outputs.checkpoint_if_due(last || stopped);
    line.show(solver.time, solver.steps);
  }
  return stopped;
}

template <int D>
int run_model(const Scene& scene, const RunOptions& options, std::ostream& report) {
  const auto begin = Clock::now();
  expect_memory(scene);
  auto model = set_up<D>(scene, options.threads, options.specimens, !options.resume, options.source);
  auto& solver = model->solver;
  expect_good_changes<D>(scene, *model);
  Progress progress;
  if (options.resume) {
    read_checkpoint<D>(*model, progress, options.folder);
  } else {
    progress.start = energy_start<D>(solver);
    progress.next_checkpoint = scene.checkpoint_every;
  }
  if (!options.resume) watch_length<D>(solver, solver.stable_step(), 1, scene.duration);
  // The time of grains is that of this call; so is that of the continuum.
  solver.grid_seconds = solver.material_seconds = 0;
  if (options.resume && solver.time >= scene.duration) {
    report << "the run is at " << solver.time << " s, and ends at time.duration_s = " << scene.duration
           << "; give a longer one by --set to go on\n";
  }
  Outputs<D> outputs(scene, options, *model, progress);
  if (model->pressure_classes > 0) {
    report << model->pressure_classes << " states of specimens prepared for " << solver.points.size() << " points\n";
  }
  for (const auto& line : model->told) report << line << "\n";
  const double setup = seconds_since(begin);
  const Cost<D> cost(*model);
  if (!options.resume) {
    outputs.row();
    outputs.frame();
  }
  const bool stopped = step_to_end(scene, options, *model, progress, outputs, report);
  report << std::setprecision(3) << "setup " << setup << " s\n";
  cost.print(report);
  if (stopped)
    report << "stopped at " << solver.time << " s; go on with: rvelab-mpm --resume "
           << rvelab::io::printable(options.folder) << "\n";
  return stopped && interrupted != 0 ? 130 : 0;
}

}  // namespace

int run_scene(const Scene& scene, const RunOptions& options, std::ostream& report) {
  interrupted = 0;
  const auto before_int = std::signal(SIGINT, interrupt), before_term = std::signal(SIGTERM, interrupt);
  const int code = scene.dimension == 2 ? run_model<2>(scene, options, report) : run_model<3>(scene, options, report);
  std::signal(SIGINT, before_int);
  std::signal(SIGTERM, before_term);
  return code;
}

}  // namespace mpm
