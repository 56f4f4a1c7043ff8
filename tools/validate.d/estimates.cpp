// What the estimate of an increment's error is worth (tools/validate estimates), on packings drawn by seed: discs,
// ellipses and spheres of radii up to 1:10, friction 0 to 10, with and without rolling, linear and Hertz, kn/(p t) of
// 1e2 to 1e6. From each, at rest and after 1 % and 5 % of drained compression, increments of 1e-6 to 1e-2: on, back,
// turned, on with a rotation, anyhow. The constants of quasi_static/constants.hpp were fitted to packings of even
// seeds from 2 to 36. Seeds from 101 on are of five kinds and most of their increments long (first_of_kinds): 101 to
// 110 were looked at when the error of the way was chosen (add_error_of_path), 111 to 120 afterwards. Those from 201 on
// are cemented or moist: 201 to 220 were looked at when events.hpp was made, 221 to 270 afterwards. Those from 321 on
// are clumps and superellipsoids: 371 to 400 were looked at when the factor of starts of clumps was chosen. Those from
// 501 on are of the seven kinds of an outside check, and all errors count: 501 to 549 were looked at when lags_left and
// isostatic_creep were chosen, 620 to 689 afterwards.
//
// The truth is 2,000 to 20,000 sub-steps and relaxation to an unbalanced ratio of 1e-8. It is known where half as many
// sub-steps of a copy whose grains are moved by the last bit change it by less than a third of what the tolerance
// allows; the others (chaotic) are counted apart: their estimate must be at least that change.
//
//   rvelab-estimates FIRST LAST EACH FOLDER   seeds; increments of each state; prints a line of each class
//
// FOLDER keeps states and truths: made once, so that a change of the estimate is judged by the same.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "rvelab/io/hdf5/specimen_file.hpp"
#include "tools/validate.d/estimates_packings.hpp"

using namespace rvelab;
using namespace rvelab::estimates;

namespace {

constexpr const char* directions[] = {"on", "back", "turned", "on, rotated", "random"};

/// Of unit length, but for the rotation.
Matrix3 way(int dimension, std::size_t direction, Random& random) {
  const int axis = dimension - 1;
  Matrix3 w = Matrix3::Zero();
  w(axis, axis) = -1;
  for (int i = 0; i < axis; ++i) w(i, i) = 0.4;
  if (direction == 1) w = -w;
  if (direction == 2) {
    w.setZero();
    if (random.chance(0.5)) {
      w(0, axis) = w(axis, 0) = random.chance(0.5) ? 1 : -1;
    } else {
      w(0, 0) = -1;
      w(axis, axis) = random(0.3, 1);
    }
  }
  if (direction == 4)
    for (int i = 0; i < dimension; ++i)
      for (int j = 0; j < dimension; ++j)
        for (int k = 0; k < 6; ++k) w(i, j) += random(-1, 1);
  w /= (0.5 * (w + w.transpose())).norm();
  if (direction == 3) {
    w(0, axis) += 0.7;
    w(axis, 0) -= 0.7;
  }
  return w;
}

struct Increment {
  std::uint64_t seed = 0;
  int state = 0;
  std::size_t direction = 0;
  double length = 0;
  Matrix3 gradient = Matrix3::Zero();
  Matrix3 before = Matrix3::Zero(), truth = Matrix3::Zero();  ///< Pa
  double spread = 0;                                          ///< of the truth, Pa
  bool known = false;
  Response made;
  std::uint64_t substeps = 0;  ///< that it took, those of copies too
  std::size_t events = 0;      ///< interactions that ended or formed in it
  double jump = 0;             ///< root of the sum of squares of what each of them gave to the stress, Pa
  bool failed = false;
  std::string why;

  bool long_one() const { return length >= 1e-3; }
  /// Cells that came apart have no stress, which anyone finds.
  bool stands() const { return truth.norm() > 0.01 * before.norm(); }
  double error() const { return (made.stress - truth).norm(); }
  bool chaotic() const { return seed < first_of_all_errors && spread > made.report.allowed_error / 3; }
};

long resolved_substeps(double strain_over_overlap) {
  return strain_over_overlap < 0.03  ? 2000
         : strain_over_overlap < 0.3 ? 5000
         : strain_over_overlap < 2   ? 10'000
                                     : 20'000;
}

Matrix3 resolved(Specimen s, const Matrix3& gradient, long substeps, bool nudged) {
  if (nudged) {
    for (Vector3& x : s.grains.position) x[0] = std::nextafter(x[0], 1e9);
    for (Body& body : s.bodies) body.position[0] = std::nextafter(body.position[0], 1e9);
  }
  s.solver.fixed_substeps = substeps;
  s.solver.target_unbalanced = 0;
  Rve rve(s);
  rve.apply(gradient, 0);
  if (!rve.relax(1e-8, 300'000).target_held) throw Error("the truth does not come to rest");
  return rve.stress();
}

/// Draws the increments of a state; truths from the file, where they are there, else made and put there.
std::vector<Increment> increments_of(std::uint64_t seed, int state, std::size_t each, const Specimen& s,
                                     const std::string& file) {
  std::vector<Increment> all(each);
  Random random(seed, 10 + std::uint64_t(state));
  const int dimension = dimension_of(s.shape);
  const double kappa = drawn(seed).kappa;
  std::ifstream kept(file);
  std::ofstream more(file, std::ios::app);
  for (std::size_t k = 0; k < each; ++k) {
    Increment& i = all[k];
    i.seed = seed;
    i.state = state;
    const bool spread_out = seed >= first_with_interactions;  // directions and lengths
    i.direction = (spread_out ? k + seed / 5 + std::size_t(state) : k) % 5;
    const double shortest = seed >= first_of_kinds && !spread_out && k % 7 != 6 ? -3 : -6;
    i.length = random.power(shortest, std::min(-2.0, 2 - std::log10(kappa)));  // beyond, no truth can be known
    i.gradient = i.length * way(dimension, i.direction, random);
    double value[11];
    std::size_t found = 0;
    std::string word;
    while (found < 11 && kept >> word) value[found++] = std::strtod(word.c_str(), nullptr);
    if (found < 11) {
      value[0] = 1;
      try {
        i.before = Rve(s).stress();
        const long n = resolved_substeps(i.length * kappa);
        i.truth = resolved(s, i.gradient, n, false);
        i.spread = (resolved(s, i.gradient, n / 2, true) - i.truth).norm();
      } catch (const Error& error) {
        value[0] = 0;
      }
      value[1] = i.spread;
      for (int c = 0; c < 9; ++c) value[2 + c] = i.truth(c / 3, c % 3);
      char text[32];
      for (const double v : value) more << (std::snprintf(text, sizeof text, "%.17g ", v), text);
      more << '\n' << std::flush;
    }
    i.known = value[0] != 0;
    i.spread = value[1];
    for (int c = 0; c < 9; ++c) i.truth(c / 3, c % 3) = value[2 + c];
  }
  return all;
}

/// Interactions that act, and what each gives to the stress, Pa.
using Acting = std::map<std::tuple<int, std::int32_t, std::int32_t>, double>;
Acting acting_in(const Rve& rve) {
  Acting all;
  const Network net = rve.network();
  for (const InteractionState& i : net.interactions)
    all[{i.kind, i.i, i.j}] += i.force().norm() * i.branch.norm() / net.cell.volume();
  return all;
}
/// Notes those that ended and formed.
void note_events(const Acting& before, const Acting& after, Increment& i) {
  double squares = 0;
  for (const auto& [from, to] : {std::pair{&before, &after}, {&after, &before}})
    for (const auto& [pair, stress] : *from)
      if (!to->contains(pair)) ++i.events, squares += stress * stress;
  i.jump = std::sqrt(squares);
}

std::mutex files;  // of HDF5

std::vector<Increment> judged(std::uint64_t seed, std::size_t each, const std::string& folder) {
  std::vector<Increment> all;
  std::vector<Specimen> states;
  const std::string name = folder + "/" + std::to_string(seed);
  const auto file = [&](int k, const char* end) { return name + "_" + std::to_string(percents[k]) + end; };
  if (!std::filesystem::exists(file(2, ".h5"))) {
    states = states_of(seed);
    const std::lock_guard<std::mutex> lock(files);
    for (int k = 0; k < 3; ++k) io::write_specimen(states[std::size_t(k)], file(k, ".h5"));
  }
  for (int k = 0; k < 3; ++k) {
    const Specimen s = [&] {
      const std::lock_guard<std::mutex> lock(files);
      return io::read_specimen(file(k, ".h5"));
    }();
    std::vector<Increment> of = increments_of(seed, k, each, s, file(k, ".txt"));
    for (Increment& i : of) {
      try {
        Rve rve(s);
        i.before = rve.stress();
        const Acting acting = acting_in(rve);
        i.made = rve.apply(i.gradient, 0);
        note_events(acting, acting_in(rve), i);
        i.substeps = rve.grain_steps_made() / rve.size();
      } catch (const Error& error) {
        i.failed = true;
        i.why = error.what();
      }
    }
    all.insert(all.end(), of.begin(), of.end());
  }
  return all;
}

double middle(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print(const std::string& name, const std::vector<Increment>& all,
           const std::function<bool(const Increment&)>& of) {
  long failed = 0, unknown = 0, chaotic = 0, covered = 0, counted = 0, within = 0, kept = 0, met = 0, met_kept = 0;
  std::vector<double> ratios, steps;
  for (const Increment& i : all) {
    if (!of(i)) continue;
    failed += i.failed;
    unknown += !i.failed && !i.known;
    if (i.failed || !i.known) continue;
    const Report& r = i.made.report;
    if (i.chaotic()) {
      ++chaotic;
      covered += r.error_estimate >= i.spread;
      continue;
    }
    ++counted;
    within += i.error() <= r.error_estimate;
    kept += i.error() <= r.allowed_error;
    met += r.tolerance_met;
    met_kept += r.tolerance_met && i.error() <= r.allowed_error;
    ratios.push_back(r.error_estimate / std::max(i.error(), 1e-300));
    steps.push_back(double(r.substeps));
  }
  const auto share = [](long part, long whole) { return whole > 0 ? 100.0 * double(part) / double(whole) : 100.0; };
  std::printf("%-58s %5ld %8.1f %8.2f %9.1f %7.1f %8.1f %8.0f %8ld %8.1f %7ld\n", name.c_str(), counted,
              share(within, counted), middle(ratios), share(kept, counted), share(met, counted), share(met_kept, met),
              middle(steps), chaotic, share(covered, chaotic), failed + unknown);
  std::fflush(stdout);
}

void write_lines(const std::vector<Increment>& all, const std::string& path) {
  std::FILE* out = std::fopen(path.c_str(), "w");
  if (out == nullptr) return;
  for (const Increment& i : all) {
    const Report& r = i.made.report;
    std::fprintf(out, "%llu %d %zu %.4e %d %d %.6e %.6e %.6e %.6e %.6e %ld %d %.6e %.6e %zu %.6e %llu\n",
                 (unsigned long long)i.seed, percents[i.state], i.direction, i.length, int(i.known), int(i.failed),
                 i.error(), r.error_estimate, r.allowed_error, i.spread, r.unbalanced_ratio, r.substeps,
                 int(r.tolerance_met), (i.truth - i.before).norm(), -i.before.trace(), i.events, i.jump,
                 (unsigned long long)i.substeps);
    if (i.failed)
      std::fprintf(stderr, "seed %llu, %d %%, %s, %.2e: %s\n", (unsigned long long)i.seed, percents[i.state],
                   directions[i.direction], i.length, i.why.c_str());
  }
  std::fclose(out);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fputs("usage: rvelab-estimates FIRST LAST EACH FOLDER\n", stderr);
    return 2;
  }
  const std::uint64_t first = std::strtoull(argv[1], nullptr, 10), last = std::strtoull(argv[2], nullptr, 10);
  const std::size_t each = std::strtoull(argv[3], nullptr, 10);
  const std::string folder = argv[4];
  std::filesystem::create_directories(folder);
  std::map<std::uint64_t, std::vector<Increment>> of_seed;
  std::atomic<std::uint64_t> next = first;
  std::mutex guard;
  const auto work = [&] {
    for (std::uint64_t seed = next++; seed <= last; seed = next++) {
      std::vector<Increment> made;
      try {
        made = judged(seed, each, folder);
      } catch (const Error& error) {
        std::fprintf(stderr, "seed %llu (%s): %s\n", (unsigned long long)seed, in_words(seed).c_str(), error.what());
      }
      const std::lock_guard<std::mutex> lock(guard);
      of_seed[seed] = std::move(made);
    }
  };
  std::thread other(work);
  work();
  other.join();

  std::vector<Increment> all;
  for (const auto& [seed, of] : of_seed) all.insert(all.end(), of.begin(), of.end());
  write_lines(all, folder + "/increments.txt");
  std::printf("%-58s %5s %8s %8s %9s %7s %8s %8s %8s %8s %7s\n", "", "", "% within", "median", "% within", "% told",
              "% of it", "median", "", "% spread", "not");
  std::printf("%-58s %5s %8s %8s %9s %7s %8s %8s %8s %8s %7s\n", "increments", "n", "estimate", "est/err", "tolerance",
              "met", "truly", "steps", "chaotic", "covered", "known");
  for (const auto& [seed, of] : of_seed)
    print(std::to_string(seed) + ": " + in_words(seed), of, [](const Increment&) { return true; });
  for (int k = 0; k < 3 && !is_interacting(first); ++k)
    print("after " + std::to_string(percents[k]) + " %", all, [&](const Increment& i) { return i.state == k; });
  for (std::size_t k = 0; k < 5; ++k) print(directions[k], all, [&](const Increment& i) { return i.direction == k; });
  for (int k = -6; k < -2; ++k)
    print("lengths 1e" + std::to_string(k) + " to 1e" + std::to_string(k + 1), all,
          [&](const Increment& i) { return std::floor(std::log10(i.length)) == k; });
  if (first < first_of_kinds) {
    print("fitted (even seeds)", all, [](const Increment& i) { return i.seed % 2 == 0; });
    print("held out (odd seeds)", all, [](const Increment& i) { return i.seed % 2 == 1; });
  } else if (first >= first_of_all_errors) {
    for (std::size_t k = 0; k < 7; ++k)
      for (const bool longer : {false, true})
        print(std::string(drawn_kinds[k]) + (longer ? ", from 1e-3 on" : ", below 1e-3"), all,
              [&](const Increment& i) { return i.seed % 7 == k && i.long_one() == longer; });
    for (const bool longer : {false, true})
      print(longer ? "from 1e-3 on" : "below 1e-3", all, [&](const Increment& i) { return i.long_one() == longer; });
  } else if (first >= first_of_shapes) {
    for (std::size_t k = 0; k < 5; ++k) print(shape_kinds[k], all, [&](const Increment& i) { return i.seed % 5 == k; });
  } else if (first >= first_with_interactions) {
    for (std::size_t k = 0; k < 5; ++k) {
      const std::string kind = interacting_kinds[k];
      print(kind, all, [&](const Increment& i) { return i.seed % 5 == k; });
      for (int state = 0; state < 3; ++state)
        print(kind + ", " + (is_cemented(k) ? cemented_states : moist_states)[state], all,
              [&](const Increment& i) { return i.seed % 5 == k && i.state == state; });
      print(kind + (is_cemented(k) ? ", bonds break" : ", bridges form or rupture"), all,
            [&](const Increment& i) { return i.seed % 5 == k && i.events > 0; });
    }
    print("events in the increment", all, [](const Increment& i) { return i.events > 0; });
    print("none", all, [](const Increment& i) { return i.events == 0; });
  } else {
    constexpr const char* kinds[] = {"discs of little friction", "Hertz spheres of 1:4", "stiff spheres", "ellipses",
                                     "rolling discs"};
    for (std::size_t k = 0; k < 5; ++k)
      print(std::string(kinds[k]) + ", long", all, [&](const Increment& i) { return i.seed % 5 == k && i.long_one(); });
    print("long (1e-3 to 1e-2)", all, [](const Increment& i) { return i.long_one(); });
    for (std::size_t k = 0; k < 5; ++k)
      print(std::string(kinds[k]) + ", long, stress left", all,
            [&](const Increment& i) { return i.seed % 5 == k && i.long_one() && i.stands(); });
    for (int k = 0; k < 3; ++k)
      print("long, stress left, after " + std::to_string(percents[k]) + " %", all,
            [&](const Increment& i) { return i.state == k && i.long_one() && i.stands(); });
    print("long, stress left", all, [](const Increment& i) { return i.long_one() && i.stands(); });
  }
  print("all", all, [](const Increment&) { return true; });
  return 0;
}
