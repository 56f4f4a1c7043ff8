// The laboratory as a page calls it: a specimen is packed or opened, tested, changed in friction and tested on, or
// strained by hand. A few calls over the classes of the library; the laws, the tests and the keys are theirs.
//
// Each call answers an object. Where something was wrong it has the member `error`, a sentence, and nothing changed.
// Stress: Pa, laboratory frame, tension positive, as [xx, yy, zz, yz, xz, xy]. Lengths in m.
#include <emscripten/bind.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rvelab/calibrate/mohr.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/pack/read_recipe.hpp"
#include "rvelab/pack/search.hpp"
#include "rvelab/protocol/run.hpp"
#include "rvelab/solver/snapshot.hpp"

using emscripten::val;

namespace rvelab::web {
namespace {

/// The answer of `call`, or its error.
template <class Call>
val answer(const Call& call) {
  val told = val::object();
  try {
    call(told);
  } catch (const std::exception& error) {
    told = val::object();
    told.set("error", std::string(error.what()));
  }
  return told;
}

val numbers(const std::vector<double>& values) {
  return val::global("Float64Array").new_(emscripten::typed_memory_view(values.size(), values.data()));
}
/// Single precision: what is drawn.
val drawn_numbers(const std::vector<float>& values) {
  return val::global("Float32Array").new_(emscripten::typed_memory_view(values.size(), values.data()));
}
val stress_of(const Matrix3& s) {
  return numbers(
      {s(0, 0), s(1, 1), s(2, 2), 0.5 * (s(1, 2) + s(2, 1)), 0.5 * (s(0, 2) + s(2, 0)), 0.5 * (s(0, 1) + s(1, 0))});
}

std::vector<std::string> texts(const val& list) { return emscripten::vecFromJSArray<std::string>(list); }

/// x, y, z, angle, a, b and the sum of the pressing forces (N) of each grain that is drawn, laboratory frame; a round
/// one has a = b = r.
std::vector<float> grains_of(const Network& network) {
  std::vector<double> pressed(network.grains.size());
  for (const ContactState& contact : network.contacts)
    for (const auto grain : {contact.i, contact.j}) pressed[std::size_t(grain)] += contact.normal_force;
  std::vector<float> rows;
  for (std::size_t g = 0; g < network.grains.size(); ++g) {
    const GrainState& grain = network.grains[g];
    const Vector3 at = network.cell.rotation * grain.position;
    const Vector3 along = network.cell.rotation * grain.orientation;
    double a = grain.radius, b = grain.radius;
    int column = 0;
    with_shape(network.shape, [&](auto is) {
      each_column_of<typename decltype(is)::By>(
          [&](const auto&, const double& value) { (column++ == 0 ? a : b) = value; },
          static_cast<const OwnValues&>(grain));
    });
    for (const double value : {at[0], at[1], at[2], std::atan2(along[1], along[0]), a, b, pressed[g]})
      rows.push_back(float(value));
  }
  return rows;
}

/// x, y, z of grain i, branch, normal force (N) of each contact, laboratory frame.
std::vector<float> contacts_of(const Network& network) {
  std::vector<float> rows;
  for (const ContactState& contact : network.contacts) {
    const Vector3 from = network.cell.rotation * network.grains[std::size_t(contact.i)].position;
    const Vector3 branch = network.cell.rotation * contact.branch;
    for (const double value : {from[0], from[1], from[2], branch[0], branch[1], branch[2], contact.normal_force})
      rows.push_back(float(value));
  }
  return rows;
}

}  // namespace

class Laboratory {
 public:
  /// Packs by a recipe in TOML; on_draw(draw, void ratio) after each trial packing.
  val pack(const std::string& recipe, const val& settings, const val& on_draw) {
    return answer([&](val& told) {
      const pack::RecipeFile file = pack::parse_recipe(recipe, "soil", texts(settings));
      Workers alone(1);
      pack::PackWatch watch;
      watch.on_draw = [&](long draw, double void_ratio) { on_draw(double(draw), void_ratio); };
      const pack::Packing packing = pack::pack(file.recipe, alone, watch);
      open_specimen(packing.specimen);
      told.set("void_ratio", packing.void_ratio);
      told.set("draw", double(packing.draw));
      told.set("preparation_friction", packing.preparation_friction);
      told.set("recipe", file.resolved);
    });
  }

  /// The bytes of the state, which `rvelab import S.rvesnap` reads; and the way back.
  val save() const {
    return answer([&](val& told) {
      const auto bytes = to_bytes(state());
      const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
      told.set("bytes", val::global("Uint8Array").new_(emscripten::typed_memory_view(bytes.size(), from)));
    });
  }
  val open(const val& given) {
    return answer([&](val& told) {
      const auto bytes = emscripten::convertJSArrayToNumberVector<unsigned char>(given);
      open_specimen(from_bytes(std::as_bytes(std::span(bytes))));
      told.set("grains", double(rve_->size()));
    });
  }

  /// The grains as they are now, during a test too.
  val picture() const {
    return answer([&](val& told) {
      const Network network = shown().network();
      const Matrix3 cell = network.cell.rotation * network.cell.lattice;
      told.set("dimension", network.dimension());
      told.set("cell", numbers({cell.data(), cell.data() + 9}));
      told.set("grains", drawn_numbers(grains_of(network)));
      told.set("contacts", drawn_numbers(contacts_of(network)));
      told.set("void_ratio", void_ratio(network));
      told.set("coordination", coordination_number(network));
      told.set("stress", stress_of(shown().stress()));
    });
  }

  /// Runs a protocol in TOML on the specimen. on_record(row) at each record, row = [stage, strain, stress, p, q,
  /// volumetric strain since the start of the stage (compression positive), 1 if it is an equilibrium]; on_step() after
  /// each increment. States are kept `forks` times over the records, from which fork() goes on.
  val run(const std::string& text, const val& settings, int forks, const val& on_record, const val& on_step) {
    return answer([&](val& told) {
      const protocol::Protocol read = protocol::parse_protocol(text, "test", texts(settings));
      const Specimen specimen = state();
      protocol_ = read;
      kept_.clear();
      const std::size_t every = std::max<std::size_t>(1, planned_records(read) / std::size_t(std::max(1, forks)));
      result_ = finish(
          told, [&](const protocol::Watch& watch) { return protocol::run_protocol(read, specimen, watch); }, every,
          on_record, on_step);
      told.set("protocol", read.resolved);
    });
  }

  /// Strains (of the driving strain) at which states were kept.
  val kept() const {
    std::vector<double> strains;
    for (const auto& checkpoint : kept_) strains.push_back(strain_at(checkpoint));
    return numbers(strains);
  }

  /// The test again from the kept state number `from`, with another friction of all materials.
  val fork(int from, double friction, const val& on_record, const val& on_step) {
    return answer([&](val& told) {
      if (!protocol_ || from < 0 || std::size_t(from) >= kept_.size())
        throw InputError("state " + std::to_string(from) + " was not kept; allowed: 0 to " +
                         std::to_string(int(kept_.size()) - 1) + "; run a test first");
      if (!(friction >= 0)) throw InputError("friction = " + in_words(friction) + "; allowed: 0 or more");
      records::Checkpoint start = kept_[std::size_t(from)];
      for (Material& material : start.specimen.materials) material.friction = friction;
      told.set("strain", strain_at(start));
      finish(
          told,
          [&](const protocol::Watch& watch) { return protocol::resume_protocol(*protocol_, start, result_, watch); }, 0,
          on_record, on_step);
    });
  }

  /// One increment of the displacement gradient by hand, quasi-static.
  val strain(double xx, double yy, double xy, double yx) {
    return answer([&](val& told) {
      const Response response = opened().apply(gradient(xx, yy, xy, yx), 0);
      told.set("stress", stress_of(response.stress));
      told.set("in_equilibrium", response.report.in_equilibrium);
    });
  }

  /// Change of stress by strains of one length (Frobenius) in `count` directions of the plane of e_xx and e_yy, each
  /// from the present state, which stays as it is. Answers xx, yy of each.
  val envelope(double length, int count) {
    return answer([&](val& told) {
      const Matrix3 before = opened().stress();
      std::vector<double> changes;
      for (int k = 0; k < count; ++k) {
        const double angle = 2 * 3.14159265358979323846 * k / count;
        const Response response = rve_->attempt(gradient(length * std::cos(angle), length * std::sin(angle), 0, 0), 0);
        rve_->revert();
        changes.insert(changes.end(), {response.stress(0, 0) - before(0, 0), response.stress(1, 1) - before(1, 1)});
      }
      told.set("changes", numbers(changes));
    });
  }

 private:
  static Matrix3 gradient(double xx, double yy, double xy, double yx) {
    Matrix3 h = Matrix3::Zero();
    h(0, 0) = xx;
    h(1, 1) = yy;
    h(0, 1) = xy;
    h(1, 0) = yx;
    return h;
  }
  /// The driving strain of the last record before a kept state.
  double strain_at(const records::Checkpoint& checkpoint) const {
    const auto made = std::size_t(checkpoint.progress.records);
    return made > 0 ? result_.records[made - 1].strain : 0;
  }

  /// Runs with a watch of the page's calls, and keeps the end state; `every` records a state is kept, never if 0.
  template <class Run>
  records::TestResult finish(val& told, const Run& run, std::size_t every, const val& on_record, const val& on_step) {
    protocol::Watch watch;
    watch.on_record = [&, dimension = opened().cell().dimension](const records::Record& record) {
      on_record(row_of(record, dimension));
    };
    std::size_t last_kept = 0;
    watch.on_path_point = [&](const protocol::PathPoint& point) {
      running_ = &point.rve;
      const std::size_t made = point.result.records.size();
      if (every > 0 && made >= last_kept + every) {
        kept_.push_back(point.checkpoint());
        last_kept = made;
      }
      on_step();
    };
    struct Ended {
      const Rve*& running;
      ~Ended() { running = nullptr; }
    } ended{running_};
    const protocol::TestRun made = run(watch);
    running_ = nullptr;
    rve_.emplace(made.end_state);
    val events = val::array();
    for (std::size_t k = 0; k < made.events.size(); ++k) events.set(k, made.events[k]);
    told.set("events", events);
    told.set("records", double(made.result.records.size()));
    const calibrate::PrincipalStresses failure = failure_of(made.result, rve_->cell().dimension);
    told.set("peak_s", failure.s());
    told.set("peak_t", failure.t());
    return made.result;
  }

  /// The stresses of the largest circle where a stress is held. At constant volume both stresses change and the largest
  /// deviator says little of the strength: those of the largest ratio, of means over 1 % of strain (NaN of a shorter
  /// test).
  calibrate::PrincipalStresses failure_of(const records::TestResult& result, int dimension) const {
    const auto records = calibrate::last_stage(result);
    return protocol::role_of(protocol_->stages.back()).gives == protocol::StageRole::Gives::strength
               ? calibrate::peak(records, dimension).stresses
               : calibrate::peak_of_moving_mean(records, dimension);
  }

  static val row_of(const records::Record& record, int dimension) {
    const Matrix3& s = record.stress;
    const double pressure = -(dimension == 2 ? 0.5 * (s(0, 0) + s(1, 1)) : s.trace() / 3);
    return numbers({double(record.stage), record.strain, s(0, 0), s(1, 1), s(2, 2), 0.5 * (s(1, 2) + s(2, 1)),
                    0.5 * (s(0, 2) + s(2, 0)), 0.5 * (s(0, 1) + s(1, 0)), pressure, deviatoric_stress(s, dimension),
                    1 - record.deformation_gradient.determinant(), double(record.quasi_static && record.target_held)});
  }

  void open_specimen(const Specimen& specimen) {
    rve_.emplace(specimen);
    protocol_.reset();
    kept_.clear();
  }
  Rve& opened() {
    if (!rve_) throw InputError("there is no specimen yet; pack one");
    return *rve_;
  }
  Specimen state() const {
    if (!rve_) throw InputError("there is no specimen yet; pack one");
    return rve_->specimen();
  }
  const Rve& shown() const {
    if (running_ == nullptr && !rve_) throw InputError("there is no specimen yet; pack one");
    return running_ != nullptr ? *running_ : *rve_;
  }

  std::optional<Rve> rve_;
  const Rve* running_ = nullptr;  ///< of the test under way
  std::optional<protocol::Protocol> protocol_;
  records::TestResult result_;  ///< of the last run; forks go on from its records
  std::vector<records::Checkpoint> kept_;
};

/// Strength from the largest circles of several tests, s and t of each in turn, Pa. The error is that of the mean angle
/// of the tests.
val strength(const val& given) {
  return answer([&](val& told) {
    const auto values = emscripten::convertJSArrayToNumberVector<double>(given);
    std::vector<calibrate::PrincipalStresses> circles;
    for (std::size_t k = 0; k + 1 < values.size(); k += 2)
      circles.push_back({values[k] + values[k + 1], values[k] - values[k + 1]});
    const double angle = calibrate::friction_angle_through_origin_deg(circles);
    double mean = 0, squares = 0;
    for (const auto& circle : circles) mean += calibrate::friction_angle_deg(circle) / double(circles.size());
    for (const auto& circle : circles) squares += std::pow(calibrate::friction_angle_deg(circle) - mean, 2);
    const double n = double(circles.size());
    told.set("friction_angle", angle);
    told.set("standard_error", n > 1 ? std::sqrt(squares / (n - 1) / n) : std::nan(""));
    told.set("Nq", calibrate::bearing_capacity_Nq(angle));
  });
}

EMSCRIPTEN_BINDINGS(laboratory) {
  emscripten::class_<Laboratory>("Laboratory")
      .constructor<>()
      .function("pack", &Laboratory::pack)
      .function("save", &Laboratory::save)
      .function("open", &Laboratory::open)
      .function("picture", &Laboratory::picture)
      .function("run", &Laboratory::run)
      .function("kept", &Laboratory::kept)
      .function("fork", &Laboratory::fork)
      .function("strain", &Laboratory::strain)
      .function("envelope", &Laboratory::envelope);
  emscripten::function("strength", &strength);
}

}  // namespace rvelab::web
