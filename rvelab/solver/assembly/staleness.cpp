#include "rvelab/solver/assembly/staleness.hpp"

#include <algorithm>
#include <cmath>

#include "rvelab/solver/assembly/oriented_bounds.hpp"

namespace rvelab {

namespace {

/// Sub-steps after which a list is too old for its skin, or too young. A build takes the time of 18 sub-steps of 400
/// discs, 10 of 1000 spheres; a listed pair that does not touch costs a third of a contact. Lists of 400 to 900 steps
/// were 4 to 5 % slower for both, though their builds are fewer.
constexpr std::int64_t old_list = 500, young_list = 200;
constexpr double smallest_skin = 0.01;  ///< mean radii

/// Sum of the two largest displacements of grains since the list was built, beside the affine motion, m. Of grains
/// that are not round that of their outlines: what the turn moves them is added to what the centre moved.
enum class Outlines { round, in_plane, in_space };
template <Outlines outlines>
double measured_displacements(const Model& model, const Assembly& assembly, const Matrix3& f_since) {
  struct Largest {
    double most = 0, second = 0;
    void add(double squared) {
      second = std::max(second, std::min(squared, most));
      most = std::max(most, squared);
    }
  };
  const UpperTriangle m = upper_triangle(f_since);
  std::vector<Largest> of_piece(pieces_in(model.size()));
  in_pieces(model.size(), model.sharing(), [&](std::size_t piece, std::size_t first, std::size_t last) {
    Largest here;
    for (std::size_t g = first; g < last; ++g) {
      const double* x = assembly.rows.data() + g * model.row_length();
      const Vector3& from = assembly.state.list.positions[g];
      if constexpr (outlines == Outlines::in_plane) {
        const double dx = x[0] - (m.xx * from[0] + m.xy * from[1]), dy = x[1] - m.yy * from[1];
        const double moved = std::sqrt(dx * dx + dy * dy) + outline_moved_by_turn(from[2], x);
        here.add(moved * moved);
      } else {
        const double dx = x[0] - (m.xx * from[0] + m.xy * from[1] + m.xz * from[2]);
        const double dy = x[1] - (m.yy * from[1] + m.yz * from[2]);
        const double dz = model.dimension() == 2 ? 0 : x[2] - m.zz * from[2];
        if constexpr (outlines == Outlines::in_space) {
          const double moved =
              std::sqrt(dx * dx + dy * dy + dz * dz) + solid_moved_by_turn(assembly.state.list.orientations[g], x);
          here.add(moved * moved);
        } else {
          here.add(dx * dx + dy * dy + dz * dz);
        }
      }
    }
    of_piece[piece] = here;
  });
  Largest all;
  for (const Largest& piece : of_piece) {
    all.add(piece.most);
    all.add(piece.second);
  }
  return std::sqrt(all.most) + std::sqrt(all.second);
}

}  // namespace

double next_skin(const Model& model, const ListState& list) {
  double skin = list.skin;
  if (list.steps >= old_list) skin *= 0.7;
  if (list.steps < young_list) skin *= 1.4;
  return std::clamp(skin, std::min(smallest_skin * model.mean_radius, model.largest_skin), model.largest_skin);
}

Vector3 listed_place(const Model& model, const Assembly& assembly, std::size_t g) {
  Vector3 position = assembly.position(model, g);
  if (keeps_axis(model.shape)) position[2] = noted_axis(assembly.orientation(model, g));
  return position;
}

double listed_gap(const Model& model, const Assembly& assembly) {
  const Matrix3 f_since = assembly.cell.lattice * upper_inverse(assembly.state.list.lattice);
  const double strain = (f_since - Matrix3::Identity()).norm(), reach = 2 * model.largest_reach;
  return (1 - strain) * (reach + assembly.state.list.skin) - reach - 2 * (1 + strain) * assembly.state.list.travel;
}

bool list_is_stale(const Model& model, Assembly& assembly, double margin) {
  // A pair beyond reach r_i + r_j + skin when listed is, after the affine map F and two displacements of at most
  // `travel`, still beyond sigma_min(F) reach - 2 |F| travel, with sigma_min >= 1 - |F - I|, |F| <= 1 + |F - I|. The
  // same is allowed of outlines that are nearer but apart by the skin along some direction (oriented_bounds.hpp).
  const Matrix3 f_since = assembly.cell.lattice * upper_inverse(assembly.state.list.lattice);
  const double strain = (f_since - Matrix3::Identity()).norm();
  const double reach = 2 * model.largest_reach;
  const double skin = assembly.state.list.skin, allowed = (1 - strain) * (reach + skin) - reach - margin;
  if (assembly.state.list.steps >= old_list && next_skin(model, assembly.state.list) < skin) return true;
  if (2 * (1 + strain) * assembly.state.list.travel < allowed) return false;
  if (assembly.state.list.positions.size() != model.size()) return true;
  // The bound sums the fastest grain of every step; what the grains really moved is a fifth of it (measured: a third of
  // the rebuilds). Looking is worth it while a tenth of the skin is left.
  const bool solid = moves_as_body(model.shape);
  if (solid && assembly.state.list.orientations.size() != model.size()) return true;
  const double moved = model.round() ? measured_displacements<Outlines::round>(model, assembly, f_since)
                       : solid       ? measured_displacements<Outlines::in_space>(model, assembly, f_since)
                                     : measured_displacements<Outlines::in_plane>(model, assembly, f_since);
  if (!(moved < allowed - 0.1 * skin)) return true;
  assembly.state.list.travel = moved / (2 * (1 + strain));
  return false;
}

}  // namespace rvelab
