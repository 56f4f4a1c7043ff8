#include "tools/mpm/run.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <iomanip>
#include <iostream>

#include "tools/mpm/checkpoint.hpp"
#include "tools/mpm/output.hpp"

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

/// What a loop took, and did.
struct Cost {
  double wall = 0, processor = 0;  ///< s
  long steps = 0;
  double grain_steps = 0;
};

template <int D>
double grain_steps_of(const Model<D>& model) {
  double sum = 0;
  for (const auto& range : model.solver.ranges) sum += range.material->grain_steps();
  return sum;
}

template <int D>
void tell_cost(const Model<D>& model, const Cost& cost, std::ostream& report) {
  const auto& solver = model.solver;
  const double points = double(solver.points.size());
  const double whole = solver.grid_seconds + solver.material_seconds;
  double grains = 0;
  for (const auto& range : solver.ranges) grains += range.material->seconds;
  report << std::setprecision(4) << "points " << solver.points.size() << ", steps " << solver.steps << " ("
         << cost.steps << " now), threads " << model.solver.workers.count() << ", wall " << cost.wall
         << " s, processor " << cost.processor << " s\n"
         << "continuum " << whole - grains << " s, grains " << grains << " s (" << 100 * grains / std::max(whole, 1e-12)
         << " %)\n";
  if (grains > 0) {
    report << "grain-steps " << grain_steps_of<D>(model) << ", " << cost.grain_steps / grains / 1e6 << " M a second";
    for (const auto& [name, each] : model.grains) {
      report << "; " << name << ": " << each->called << " of " << each->asked << " increments called, " << each->split
             << " in parts, " << each->warned << " with a warning";
    }
    report << "\n";
  } else if (cost.steps > 0) {
    report << points * double(cost.steps) / cost.wall / 1e6 << " M point-steps a second\n";
  }
}

template <int D>
int run_model(const Scene& scene, const RunOptions& options, std::ostream& report) {
  const auto begin = Clock::now();
  auto model = set_up<D>(scene, options.threads, options.specimens, !options.resume, options.source);
  auto& solver = model->solver;
  Progress progress;
  if (options.resume) {
    read_checkpoint<D>(*model, progress, options.folder);
  } else {
    progress.start = energy_start<D>(solver);
    progress.next_checkpoint = scene.checkpoint_every;
  }
  // The time of grains is that of this call; so is that of the continuum.
  solver.grid_seconds = solver.material_seconds = 0;
  if (options.resume && solver.time >= scene.duration) {
    report << "the run is at " << solver.time << " s, and ends at time.duration_s = " << scene.duration
           << "; give a longer one by --set to go on\n";
  }
  const std::filesystem::path place(options.folder);
  Rows history((place / "history.csv").string(), history_header<D>(solver), progress.history);
  Rows watched((place / "watched.csv").string(), watched_header<D>(*model), progress.watched);
  if (!options.scene_text.empty()) write_scene(options.folder, options.scene_text);
  if (model->pressure_classes > 0) {
    report << model->pressure_classes << " states of specimens prepared for " << solver.points.size() << " points\n";
  }
  const long first_steps = solver.steps;
  const double setup = std::chrono::duration<double>(Clock::now() - begin).count();
  const auto looped = Clock::now();
  const double used = processor_time(), made = grain_steps_of<D>(*model);
  ProgressLine line(options.quiet, solver.time, scene.duration);
  double saved = options.resume ? solver.time : -1;  // s, the time of the checkpoint; below 0: there is none
  const auto row = [&] {
    history.add(history_row<D>(solver, progress.start, solver.time - progress.last_row, progress.impulses));
    watched.add(watched_row<D>(*model));
    progress.last_row = solver.time;
    while (progress.next_row <= solver.time) progress.next_row += scene.history_every;
  };
  const auto frame = [&] {
    const long number = long(progress.frame_times.size());
    write_frame<D>(*model, options.folder, number);
    if (scene.networks) write_networks<D>(*model, options.folder, number);
    progress.frame_times.push_back(solver.time);
    write_xdmf(options.folder, progress.frame_times, long(solver.points.size()));
    while (progress.next_frame <= solver.time) progress.next_frame += scene.frame_every;
  };
  const auto save = [&] {
    progress.history = history.written();
    progress.watched = watched.written();
    write_checkpoint<D>(*model, progress, options.folder);
    saved = solver.time;
  };
  const auto watched_over = [&](const auto& watch) {
    try {
      watch();
    } catch (const std::runtime_error& reason) {
      if (saved < 0) save();
      throw std::runtime_error(reason.what() + ("; " + options.folder) + " keeps the checkpoint of " + text_of(saved) +
                               " s");
    }
  };
  if (!options.resume) {
    row();
    frame();
  }
  bool stopped = false;
  while (solver.time < scene.duration && !stopped) {
    double dt = solver.stable_step();
    watched_over([&] { watch_step<D>(solver, dt, progress.seen, std::cerr); });
    const bool last = solver.time + dt >= scene.duration;
    if (last) dt = scene.duration - solver.time;
    solver.step(dt);
    if (last) solver.time = scene.duration;
    if (solver.time >= progress.next_row || last) row();
    if (solver.time >= progress.next_frame || last) frame();
    stopped = !last && (interrupted != 0 || solver.time >= options.stop_at);
    if (solver.steps % steps_between_balances == 0 || last) {
      watched_over([&] { watch_energy<D>(solver, progress.start, progress.seen, std::cerr); });
    }
    if (solver.time >= progress.next_checkpoint || last || stopped) {
      while (progress.next_checkpoint <= solver.time) progress.next_checkpoint += scene.checkpoint_every;
      save();
    }
    line.show(solver.time, solver.steps);
  }
  const Cost cost{std::chrono::duration<double>(Clock::now() - looped).count(), processor_time() - used,
                  solver.steps - first_steps, grain_steps_of<D>(*model) - made};
  report << std::setprecision(3) << "setup " << setup << " s\n";
  tell_cost<D>(*model, cost, report);
  if (stopped)
    report << "stopped at " << solver.time << " s; go on with: rvelab-mpm --resume " << options.folder << "\n";
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
