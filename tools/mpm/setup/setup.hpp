// A scene becomes material points, materials, boundaries and a grid.
#pragma once

#include <map>

#include "tools/mpm/materials/grains.hpp"
#include "tools/mpm/scene/scene.hpp"
#include "tools/mpm/step/solver.hpp"

namespace mpm {

/// A scene at work.
template <int D>
struct Model {
  explicit Model(int threads) : solver(threads) {}
  Solver<D> solver;
  std::map<std::string, std::shared_ptr<GrainPool>> pools;  ///< by the name of the material
  std::map<std::string, std::shared_ptr<Grains<D>>> grains;
  std::vector<long> watched;      ///< numbers of the points nearest to those asked for
  std::vector<std::string> told;  ///< what the user should know of the rocks
  long pressure_classes = 0;      ///< prepared states that points share
};

/// `specimens`: folder in which specimen files are looked for. `populate`: false leaves points and RVEs to a
/// checkpoint. Over ranks: InputError if the scene needs more than one pool.
template <int D>
std::unique_ptr<Model<D>> set_up(const Scene& scene, int threads, const std::string& specimens, bool populate = true,
                                 const PoolSource& source = {});

}  // namespace mpm
