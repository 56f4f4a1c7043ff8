#include "tools/mpm/app/changes.hpp"

namespace mpm {
namespace {

template <int D>
bool is_in(const ChangeOfScene& change, const Vec<D>& position) {
  for (std::size_t i = 0; i < change.lower.size(); ++i)
    if (position[int(i)] < change.lower[i] || position[int(i)] > change.upper[i]) return false;
  return true;
}

}  // namespace

template <int D>
void expect_good_changes(const Scene& scene, const Model<D>& model) {
  for (const auto& change : scene.changes) {
    rvelab_pool* pool = model.pools.at(change.material)->get();
    if (rvelab_run_stages(pool, 0, nullptr, change.stages.c_str(), nullptr, nullptr) < RVELAB_OK)
      throw InputError("change." + change.name + ".stages: " + rvelab_last_error());
  }
}

template <int D>
void make_changes(const Scene& scene, Model<D>& model, std::ostream& report) {
  auto& solver = model.solver;
  for (const auto& group : solver.groups) {
    const auto found = model.grains.find(group.name);
    if (found == model.grains.end()) continue;
    Grains<D>& grains = *found->second;
    long number = 0;
    for (const auto& change : scene.changes) {
      if (change.material != group.name || number++ < grains.changes_made || solver.time < change.at) continue;
      Point<D>* points = solver.points.data() + group.first;
      std::vector<long> chosen;
      for (long k = 0; k < group.count; ++k)
        if (is_in<D>(change, points[k].position)) chosen.push_back(k);
      const double before = grains.seconds;
      try {
        grains.run_stages(points, chosen, change.stages);
      } catch (const std::runtime_error& error) {
        throw std::runtime_error("change." + change.name + ": " + error.what());
      }
      ++grains.changes_made;
      solver.material_seconds += grains.seconds - before;
      report << "change " << change.name << " at " << solver.time << " s: " << chosen.size() << " RVEs\n";
    }
  }
}

template void expect_good_changes<2>(const Scene&, const Model<2>&);
template void expect_good_changes<3>(const Scene&, const Model<3>&);
template void make_changes<2>(const Scene&, Model<2>&, std::ostream&);
template void make_changes<3>(const Scene&, Model<3>&, std::ostream&);

}  // namespace mpm
