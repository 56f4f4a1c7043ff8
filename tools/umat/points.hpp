// The RVEs of a host's material points: one pool, spawned into when a point is seen for the first time.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <shared_mutex>
#include <string>

#include "tools/umat/kinematics.hpp"
#include "tools/umat/settings.hpp"

namespace umat {

/// NOEL, NPT, LAYER, KSPT. A host that leaves NOEL or NPT at 0 does not say which point it is.
using PointName = std::array<int, 4>;

/// The state that a step begins in, as STATEV holds it.
struct Start {
  std::int64_t id = 0, token = 0;
};

struct Step {
  std::int32_t status = 0;
  Matrix3 sigma;    ///< Pa, laboratory frame
  Matrix6 tangent;  ///< Pa, order of the host
  double dt_scale = 1;
  std::int64_t token = 0;
  std::string text;  ///< of a status that is not RVELAB_OK
};

class Points {
 public:
  explicit Points(const Settings& settings);

  /// The settings of a material. Throws std::runtime_error if there is none of that number, which the host calls
  /// `property`.
  const Material& material(int number, const char* property = "PROPS(1)") const;

  /// Stress of the specimen of a material, Pa.
  Matrix3 first_stress(int material);

  /// Elastic tangent of the specimen of a material, Pa, order of the host. It is made once.
  Matrix6 first_tangent(int material);

  /// A new RVE, or, while its first step is not committed, the one that this point got before.
  Start spawn(int material, const PointName& name);

  /// The same for a host that names no points and keeps what a try of the first step returned: the RVE with that id, if
  /// it is of this material and still where it began, else a new one.
  Start spawn_again(int material, std::int64_t tried);

  /// One trial; on any thread.
  Step step(const Start& start, const Matrix3& dH, double dt, bool with_tangent);

 private:
  struct Loaded {
    std::int64_t number = 0;
    Matrix3 stress;
    std::optional<Matrix6> tangent;
  };
  Loaded& loaded(int material);
  std::int64_t token_of(std::int64_t id);

  Settings settings_;
  rvelab_pool* pool_ = nullptr;   ///< lives as long as the process: hosts have no last call
  std::shared_mutex population_;  ///< exclusive for spawning, which no work may stand beside
  std::map<int, Loaded> templates_;
  std::map<std::pair<int, PointName>, Start> first_steps_;  ///< points whose first step may come again
  std::map<std::pair<int, std::int64_t>, Start> unnamed_;   ///< of spawn_again, by material and id
};

/// Appends a text to rvelab_umat.log in the working directory: each once, a hundred at most.
void log_failure(const std::string& text);

}  // namespace umat
