#include "tools/mpm/bodies/planes.hpp"

#include <algorithm>

namespace mpm {

template <int D>
bool Planes<D>::changed(double time) const {
  return std::any_of(all.begin(), all.end(),
                     [&](const auto& plane) { return built_ < plane.removed_at && time >= plane.removed_at; });
}

template <int D>
void Planes<D>::add_touched(const Grid<D>& grid, long node, int plane) {
  int& at = touched_of_[std::size_t(node)];
  if (at < 0) {
    at = int(touched_.size());
    touched_.push_back({node, {}});
  }
  auto& planes = touched_[std::size_t(at)].planes;
  const bool on = grid.index(node)[all[plane].axis] == all[plane].node;
  planes.insert(on ? planes.begin() : planes.end(), plane);
}

/// The reflections of a node that bring it to the soil's side of every plane; without any, it is no mirror node. Two
/// planes may face each other one cell apart: a node may need more than one reflection.
template <int D>
MirrorNode<D> Planes<D>::reflected(const Grid<D>& grid, long node, typename Grid<D>::Index& image, double time) const {
  MirrorNode<D> mirror{node, node, Vec<D>::Ones(), {}};
  image = grid.index(node);
  for (bool again = true; again && mirror.planes.size() < 8;) {
    again = false;
    for (int k = 0; k < int(all.size()); ++k) {
      const auto& plane = all[k];
      if (!active(k, time)) continue;
      const int beyond = (image[plane.axis] - plane.node) * plane.inside;
      if (plane.period > 0 ? beyond >= 0 && beyond < plane.period : beyond >= 0) continue;
      if (plane.period > 0)
        image[plane.axis] += beyond < 0 ? plane.period : -plane.period;
      else
        image[plane.axis] = 2 * plane.node - image[plane.axis];
      for (int i = 0; i < D; ++i) {
        if (plane.holds(i)) mirror.sign[i] = -mirror.sign[i];
      }
      mirror.planes.push_back(k);
      again = true;
    }
  }
  return mirror;
}

template <int D>
void Planes<D>::add_on_planes(const Grid<D>& grid, long node, double time) {
  const auto index = grid.index(node);
  for (const bool fixed : {false, true}) {
    for (int k = 0; k < int(all.size()); ++k) {
      if (!active(k, time) || all[k].fixed != fixed || index[all[k].axis] != all[k].node) continue;
      on_plane_.push_back({node, k});
      for (int i = 0; i < D; ++i) held_[node] |= char(all[k].holds(i) << i);
      add_touched(grid, node, k);
    }
  }
}

template <int D>
void Planes<D>::rebuild(const Grid<D>& grid, double time) {
  built_ = time;
  mirrors_.clear();
  on_plane_.clear();
  touched_.clear();
  is_mirror_.assign(all.empty() ? 0 : grid.nodes.size(), 0);
  held_ = is_mirror_;
  if (all.empty()) return;
  touched_of_.assign(grid.nodes.size(), -1);
  for (long node = 0; node < long(grid.nodes.size()); ++node) {
    typename Grid<D>::Index image;
    auto mirror = reflected(grid, node, image, time);
    if (mirror.planes.empty()) {
      add_on_planes(grid, node, time);
      continue;
    }
    is_mirror_[node] = 1;
    if (!grid.contains(image)) continue;
    mirror.image = grid.flat(image);
    for (const int k : mirror.planes) {
      add_touched(grid, mirror.node, k);
      add_touched(grid, mirror.image, k);
    }
    mirrors_.push_back(mirror);
  }
  // The image of a mirror node may lie on another plane, which then holds both.
  for (const auto& mirror : mirrors_) {
    auto& planes = touched(mirror.node).planes;
    for (const int k : touched(mirror.image).planes) {
      if (std::find(planes.begin(), planes.end(), k) == planes.end()) planes.push_back(k);
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
Vec<D> Planes<D>::shift(const MirrorNode<D>& mirror, const std::vector<Vec<D>>& speeds) const {
  Vec<D> c = Vec<D>::Zero();
  for (auto k = mirror.planes.rbegin(); k != mirror.planes.rend(); ++k) {
    for (int i = 0; i < D; ++i) {
      if (all[*k].holds(i)) c[i] = 2 * speeds[*k][i] - c[i];
    }
  }
  return c;
}

template <int D>
void Planes<D>::fold_momentum(Grid<D>& grid, double time) {
  for (auto& each : touched_) {
    const auto& node = grid.nodes[each.node];
    each.mass = node.mass;
    for (int i = 0; i < D; ++i) each.velocity[i] = node.a[i];
  }
  const auto now = speeds(time);
  for (const auto& mirror : mirrors_) {
    const auto& node = grid.nodes[mirror.node];
    auto& image = grid.nodes[mirror.image];
    if (!(node.mass > 0)) continue;
    const Vec<D> c = shift(mirror, now);
    const double total = image.mass + node.mass;
    for (int i = 0; i < D; ++i) {
      image.v[i] = (image.mass * image.v[i] + node.mass * mirror.sign[i] * (node.v[i] - c[i])) / total;
    }
    image.mass = total;
  }
}

template <int D>
void Planes<D>::fold_force(Grid<D>& grid) {
  for (auto& each : touched_) {
    for (int i = 0; i < D; ++i) each.force[i] = grid.nodes[each.node].w[i];
  }
  for (const auto& mirror : mirrors_) {
    for (int i = 0; i < D; ++i) grid.nodes[mirror.image].w[i] += mirror.sign[i] * grid.nodes[mirror.node].w[i];
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
  for (const auto& mirror : mirrors_) {
    auto& node = grid.nodes[mirror.node];
    const auto& image = grid.nodes[mirror.image];
    if (!(node.mass > 0)) continue;
    const Vec<D> c = shift(mirror, now);
    for (int i = 0; i < D; ++i) {
      (end ? node.w : node.v)[i] = c[i] + mirror.sign[i] * (end ? image.w : image.v)[i];
    }
  }
}

template <int D>
void Planes<D>::unfold(Grid<D>& grid) const {
  for (const auto& each : touched_) grid.nodes[each.node].mass = each.mass;
}

/// The plane across a component has its reaction; a tangential one belongs to a plane that holds it.
template <int D>
int Planes<D>::owner(const std::vector<int>& planes, int component) const {
  for (const int k : planes) {
    if (all[k].axis == component && all[k].holds(component)) return k;
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
void Planes<D>::keep_mapped(Grid<D>& grid) const {
  for (const auto& each : touched_) {
    auto& node = grid.nodes[each.node];
    for (int i = 0; i < D; ++i) node.a[i] = node.v[i];
  }
}

template <int D>
void Planes<D>::react(const Grid<D>& grid, double dt, double pic_fraction) {
  for (auto& each : touched_) {
    each.folded.setZero();
    const auto& node = grid.nodes[each.node];
    for (int i = 0; i < D; ++i) {
      const int plane = owner(each.planes, i);
      if (plane < 0) continue;
      const double mapped = node.w[i] - node.a[i];
      all[plane].reaction.impulse[i] += pic_fraction * each.mass * (mapped - each.velocity[i]);
    }
  }
  // What mirroring did to the mirror node and to its image.
  for (const auto& mirror : mirrors_) {
    const auto& before = touched(mirror.node);
    auto& image_before = touched(mirror.image);
    if (!(before.mass > 0)) continue;
    const auto& node = grid.nodes[mirror.node];
    const auto& image = grid.nodes[mirror.image];
    for (int i = 0; i < D; ++i) {
      const int plane = owner(mirror.planes, i);
      const double folded = mirror.sign[i] * before.force[i] * dt - before.mass * image.a[i];
      image_before.folded[i] += folded;
      if (plane < 0) continue;
      book(plane, i, node, before.mass * node.a[i] - before.force[i] * dt);
      book(plane, i, image, folded);
    }
  }
  // The rest of the change at a node on a plane is that plane's.
  for (const auto& on : on_plane_) {
    auto& at = touched(on.node);
    for (int i = 0; i < D; ++i) {
      if (!all[on.plane].holds(i)) continue;
      const double rest = at.mass * grid.nodes[on.node].a[i] - at.force[i] * dt - at.folded[i];
      book(on.plane, i, grid.nodes[on.node], rest);
      at.folded[i] += rest;  // a second plane through this node finds nothing left
    }
  }
}

template class Planes<2>;
template class Planes<3>;

}  // namespace mpm
