// The RVEs of a host's material points: one pool; an RVE is made when the first increment of a point is accepted.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "tools/umat/kinematics.hpp"
#include "tools/umat/settings.hpp"

namespace umat {

/// State at the start or end of a step, as two state variables of the host. id 0: the specimen; below 0: the end of a
/// first increment, for which an RVE is made when a call continues from it.
struct State {
  std::int64_t id = 0, token = 0;
};

struct Step {
  std::int32_t status = 0;
  Matrix3 sigma;    ///< Pa, laboratory frame
  Matrix6 tangent;  ///< Pa, order of the host
  double dt_scale = 1;
  State end;
  std::string text;  ///< of a status other than RVELAB_OK
};

class Points {
 public:
  explicit Points(const Settings& settings);

  /// The settings of a material. Throws std::runtime_error for an unknown number; `property`: its name in the host.
  const Material& material(int number, const char* property = "PROPS(1)") const;

  /// Path of the settings, as given by the host.
  const std::string& file() const { return settings_.path; }

  /// Stress of the specimen of a material, Pa.
  Matrix3 first_stress(int material);

  /// Elastic tangent of the specimen of a material, Pa, order of the host. Computed once.
  Matrix6 first_tangent(int material);

  /// Stress of the committed state of an RVE, Pa.
  Matrix3 stress(std::int64_t id);

  /// A new RVE, for a host that accepts every call.
  State spawn(int material);
  void release(const State& state) noexcept;

  /// One trial; on any thread. First increments use RVEs that all points share, since hosts may repeat them, do not
  /// identify their points, and accept one of many.
  Step step(int material, const State& from, const Matrix3& dH, double dt, bool with_tangent);

  /// A separate state for a point whose first increment failed: that of the specimen.
  State unmoved(int material) { return remembered({material, 0, Matrix3::Zero(), false}); }

 private:
  struct Loaded {
    std::int64_t number = 0;
    Matrix3 stress;
    std::optional<Matrix6> tangent;
  };
  /// A first increment.
  struct Try {
    int material = 0;
    double dt = 0;
    Matrix3 dH;
    bool moved = true;  ///< false: the unchanged specimen
  };
  struct Borrowed;
  Loaded& loaded(int material);
  State state_of(std::int64_t id);
  Step trial(const State& from, const Matrix3& dH, double dt, bool with_tangent);
  State remembered(const Try& made);
  State claimed(const State& first);

  Settings settings_;
  rvelab_pool* pool_ = nullptr;   ///< exists as long as the process: hosts have no last call
  std::shared_mutex population_;  ///< exclusive for spawning, which excludes all other work
  std::map<int, Loaded> templates_;

  std::mutex first_;                          ///< of the members below; not held while waiting for population_
  std::int64_t tag_ = 0;                      ///< random: the token of all first increments of this process
  std::deque<Try> tries_;                     ///< the newest last
  std::int64_t forgotten_ = 0;                ///< number of removed ones
  std::map<std::int64_t, State> claimed_;     ///< RVEs of accepted first increments
  std::map<int, std::vector<State>> shared_;  ///< at rest in the state of the specimen, by material
};

}  // namespace umat
