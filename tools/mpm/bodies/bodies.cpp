#include "tools/mpm/bodies/bodies.hpp"

#include <algorithm>

namespace mpm {

template <int D>
void Bodies<D>::detect_contact(const Grid<D>& grid, const Planes<D>& planes, const std::vector<Point<D>>& soil,
                               double time, rvelab::Workers& workers) {
  contacts_.clear();
  surface.clear();
  sweeps = 1;
  bool at_nodes = false;
  for (int k = 0; k < int(all.size()); ++k) {
    const std::size_t first = surface.size();
    if (all[k].at_surface)
      detect_surface(grid, planes, soil, k, time, workers);
    else
      at_nodes = true;
    if (all[k].plate) all[k].plate->first = first, all[k].plate->last = surface.size();
  }
  if (at_nodes) detect_nodes(grid, planes, time, workers);
}

/// Nodes in bodies with contact at nodes, in the order of the grid.
template <int D>
void Bodies<D>::detect_nodes(const Grid<D>& grid, const Planes<D>& planes, double time, rvelab::Workers& workers) {
  const double touch = 1e-6 * grid.cell.minCoeff();
  std::vector<Vec<D>> centres;
  for (const auto& body : all) centres.push_back(body.centre_at(time));
  const long n = long(grid.nodes.size());
  std::vector<std::vector<Contact>> pieces((n + chunk - 1) / chunk);
  workers.for_each(std::int64_t(pieces.size()), [&](std::int64_t piece) {
    for (long flat = long(piece) * chunk; flat < std::min(n, long(piece + 1) * chunk); ++flat) {
      if (!(grid.nodes[flat].mass > 0) || planes.is_mirror(flat)) continue;
      const Vec<D> x = grid.position(grid.index(flat));
      for (int k = 0; k < int(all.size()); ++k) {
        Vec<D> outward;
        if (all[k].at_surface || all[k].distance(x - centres[k], outward) > touch) continue;
        pieces[piece].push_back({flat, k, outward, Vec<D>::Zero(), Vec<D>::Zero()});
      }
    }
  });
  for (const auto& piece : pieces) contacts_.insert(contacts_.end(), piece.begin(), piece.end());
}

template <int D>
Vec<D> Bodies<D>::stop(const Contact& contact, double time, double* velocity) const {
  const auto& body = all[contact.body];
  const Vec<D> speed = body.velocity_at(time);
  Vec<D> relative, jump;
  for (int i = 0; i < D; ++i) relative[i] = velocity[i] - speed[i];
  const double across = relative.dot(contact.normal);
  if (across >= 0) return Vec<D>::Zero();
  Vec<D> along = relative - across * contact.normal;
  if (body.rough) {
    along.setZero();
  } else if (const double slip = along.norm(); slip > 0) {
    along *= std::max(0.0, 1 + body.friction * across / slip);
  }
  for (int i = 0; i < D; ++i) {
    const double stopped = speed[i] + along[i];
    jump[i] = stopped - velocity[i];
    velocity[i] = stopped;
  }
  return jump;
}

template <int D>
void Bodies<D>::hold_nodes(Grid<D>& grid, double time, bool end) {
  if (!end) start_plates();
  for (auto& contact : contacts_) {
    if (end) {
      contact.at_end += stop(contact, time, grid.nodes[contact.node].w);
    } else {
      contact.at_start = stop(contact, time, grid.nodes[contact.node].v);
      contact.at_end.setZero();
    }
  }
}

template <int D>
void Bodies<D>::book(int body, const Node<D>& node, int component, double at_start, double at_end) {
  all[body].reaction.impulse[component] += at_start + at_end;
  all[body].reaction.work += work_at(node, component, at_start, at_end);
}

template <int D>
void Bodies<D>::book_reactions(const Grid<D>& grid, const Planes<D>& planes) {
  // A second body at a node may change its velocity once more.
  for (const auto& contact : contacts_) {
    const auto& node = grid.nodes[contact.node];
    for (int i = 0; i < D; ++i) {
      if (planes.holds(contact.node, i)) continue;
      book(contact.body, node, i, node.mass * contact.at_start[i], node.mass * contact.at_end[i]);
    }
  }
  for (const auto& point : surface) {
    for (int j = 0; j < point.count; ++j) {
      for (int i = 0; i < D; ++i) {
        if (planes.holds(point.node[j], i)) continue;
        const double weight = point.weight[j];
        book(point.owner, grid.nodes[point.node[j]], i, weight * point.at_start[i], weight * point.at_end[i]);
      }
    }
  }
}

template class Bodies<2>;
template class Bodies<3>;

}  // namespace mpm
