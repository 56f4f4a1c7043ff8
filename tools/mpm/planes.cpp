#include "tools/mpm/planes.hpp"

#include <algorithm>

namespace mpm {

template <int D>
bool Planes<D>::changed(double time) const {
  return std::any_of(all.begin(), all.end(),
                     [&](const auto& plane) { return built_ < plane.removed_at && time >= plane.removed_at; });
}

template <int D>
void Planes<D>::rebuild(const Grid<D>& grid, double time) {
  built_ = time;
  ties_.clear();
  on_plane_.clear();
  specials_.clear();
  behind_.assign(all.empty() ? 0 : grid.nodes.size(), 0);
  held_ = behind_;
  if (all.empty()) return;
  special_of_.assign(grid.nodes.size(), -1);
  const auto touch = [&](long node, int plane) {
    int& at = special_of_[std::size_t(node)];
    if (at < 0) {
      at = int(specials_.size());
      specials_.push_back({node, {}});
    }
    auto& planes = specials_[std::size_t(at)].planes;
    const auto axis = all[plane].axis;
    const bool on = grid.index(node)[axis] == all[plane].node;
    planes.insert(on ? planes.begin() : planes.end(), plane);
  };
  for (long flat = 0; flat < long(grid.nodes.size()); ++flat) {
    auto node = grid.index(flat);
    Tie tie{flat, flat, Vec<D>::Ones(), {}};
    // Two planes may face each other one cell apart: a node may need more than one reflection.
    for (bool again = true; again && tie.planes.size() < 8;) {
      again = false;
      for (int k = 0; k < int(all.size()); ++k) {
        const auto& plane = all[k];
        if (!active(k, time) || (node[plane.axis] - plane.node) * plane.inside >= 0) continue;
        node[plane.axis] = 2 * plane.node - node[plane.axis];
        for (int i = 0; i < D; ++i) {
          if (plane.holds(i)) tie.sign[i] = -tie.sign[i];
        }
        tie.planes.push_back(k);
        again = true;
      }
    }
    bool there = true;
    for (int i = 0; i < D; ++i) there = there && node[i] >= grid.low[i] && node[i] < grid.low[i] + grid.count[i];
    if (!tie.planes.empty()) behind_[flat] = 1;
    if (!there) continue;
    tie.before = grid.flat(node);
    if (!tie.planes.empty()) {
      for (const int k : tie.planes) {
        touch(tie.behind, k);
        touch(tie.before, k);
      }
      ties_.push_back(tie);
      continue;
    }
    for (const bool fixed : {false, true}) {
      for (int k = 0; k < int(all.size()); ++k) {
        if (!active(k, time) || all[k].fixed != fixed || node[all[k].axis] != all[k].node) continue;
        on_plane_.push_back({flat, k});
        for (int i = 0; i < D; ++i) held_[flat] |= char(all[k].holds(i) << i);
        touch(flat, k);
      }
    }
  }
  // A node behind one plane may follow a node that lies on another, which then holds both.
  for (const auto& tie : ties_) {
    auto& behind = special(tie.behind).planes;
    for (const int k : special(tie.before).planes) {
      if (std::find(behind.begin(), behind.end(), k) == behind.end()) behind.push_back(k);
    }
  }
}

template <int D>
std::vector<Vec<D>> Planes<D>::speeds(double time) const {
  std::vector<Vec<D>> speeds;
  for (const auto& plane : all) speeds.push_back(plane.velocity.at(time));
  return speeds;
}

template <int D>
Vec<D> Planes<D>::shift(const Tie& tie, const std::vector<Vec<D>>& speeds) const {
  Vec<D> c = Vec<D>::Zero();
  for (auto k = tie.planes.rbegin(); k != tie.planes.rend(); ++k) {
    for (int i = 0; i < D; ++i) {
      if (all[*k].holds(i)) c[i] = 2 * speeds[*k][i] - c[i];
    }
  }
  return c;
}

template <int D>
void Planes<D>::fold_momentum(Grid<D>& grid, double time) {
  for (auto& special : specials_) {
    const auto& node = grid.nodes[special.node];
    special.mass = node.mass;
    for (int i = 0; i < D; ++i) special.velocity[i] = node.a[i];
  }
  const auto now = speeds(time);
  for (const auto& tie : ties_) {
    const auto& behind = grid.nodes[tie.behind];
    auto& before = grid.nodes[tie.before];
    if (!(behind.mass > 0)) continue;
    const Vec<D> c = shift(tie, now);
    const double total = before.mass + behind.mass;
    for (int i = 0; i < D; ++i) {
      before.v[i] = (before.mass * before.v[i] + behind.mass * tie.sign[i] * (behind.v[i] - c[i])) / total;
    }
    before.mass = total;
  }
}

template <int D>
void Planes<D>::fold_force(Grid<D>& grid) {
  for (auto& special : specials_) {
    for (int i = 0; i < D; ++i) special.force[i] = grid.nodes[special.node].w[i];
  }
  for (const auto& tie : ties_) {
    for (int i = 0; i < D; ++i) grid.nodes[tie.before].w[i] += tie.sign[i] * grid.nodes[tie.behind].w[i];
  }
}

template <int D>
void Planes<D>::set(Grid<D>& grid, double time, bool end) const {
  const auto now = speeds(time);
  for (const auto& on : on_plane_) {
    auto& node = grid.nodes[on.node];
    for (int i = 0; i < D; ++i) {
      if (all[on.plane].holds(i)) (end ? node.w : node.v)[i] = now[on.plane][i];
    }
  }
  for (const auto& tie : ties_) {
    auto& behind = grid.nodes[tie.behind];
    const auto& before = grid.nodes[tie.before];
    if (!(behind.mass > 0)) continue;
    const Vec<D> c = shift(tie, now);
    for (int i = 0; i < D; ++i) {
      (end ? behind.w : behind.v)[i] = c[i] + tie.sign[i] * (end ? before.w : before.v)[i];
    }
  }
}

template <int D>
void Planes<D>::unfold(Grid<D>& grid) const {
  for (const auto& special : specials_) grid.nodes[special.node].mass = special.mass;
}

/// The plane across a component has its reaction; a tangential one belongs to a plane that holds it.
template <int D>
int Planes<D>::owner(const std::vector<int>& planes, int component) const {
  for (const int k : planes) {
    if (all[k].axis == component) return k;
  }
  for (const int k : planes) {
    if (all[k].holds(component)) return k;
  }
  return -1;
}

template <int D>
void Planes<D>::book(int plane, int component, const Node<D>& node, double impulse) {
  all[plane].reaction.impulse[component] += impulse;
  all[plane].reaction.work += impulse * (node.w[component] - 0.5 * node.a[component]);
}

template <int D>
void Planes<D>::keep_brought(Grid<D>& grid) const {
  for (const auto& special : specials_) {
    auto& node = grid.nodes[special.node];
    for (int i = 0; i < D; ++i) node.a[i] = node.v[i];
  }
}

template <int D>
void Planes<D>::react(const Grid<D>& grid, double dt, double pic_fraction) {
  for (auto& each : specials_) {
    each.given.setZero();
    const auto& node = grid.nodes[each.node];
    for (int i = 0; i < D; ++i) {
      const int plane = owner(each.planes, i);
      if (plane < 0) continue;
      const double brought = node.w[i] - node.a[i];
      all[plane].reaction.impulse[i] += pic_fraction * each.mass * (brought - each.velocity[i]);
    }
  }
  // What a tie did to the node behind and to the one before it.
  for (const auto& tie : ties_) {
    const auto& behind = special(tie.behind);
    auto& before = special(tie.before);
    if (!(behind.mass > 0)) continue;
    const auto& ghost = grid.nodes[tie.behind];
    const auto& mirrored = grid.nodes[tie.before];
    for (int i = 0; i < D; ++i) {
      const int plane = owner(tie.planes, i);
      const double passed = tie.sign[i] * behind.force[i] * dt - behind.mass * mirrored.a[i];
      before.given[i] += passed;
      if (plane < 0) continue;
      book(plane, i, ghost, behind.mass * ghost.a[i] - behind.force[i] * dt);
      book(plane, i, mirrored, passed);
    }
  }
  // The rest, on a plane, is of that plane.
  for (const auto& on : on_plane_) {
    auto& at = special(on.node);
    for (int i = 0; i < D; ++i) {
      if (!all[on.plane].holds(i)) continue;
      const double rest = at.mass * grid.nodes[on.node].a[i] - at.force[i] * dt - at.given[i];
      book(on.plane, i, grid.nodes[on.node], rest);
      at.given[i] += rest;  // a second plane through this node finds nothing left
    }
  }
}

template class Planes<2>;
template class Planes<3>;

}  // namespace mpm
