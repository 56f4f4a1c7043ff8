// Rigid bodies (clumps) beside the grains: their members are grains of the pair loop, which knows nothing of them;
// forces are gathered to the body, the body moves (loading/body_motion.hpp), and the members are placed from it.
//
// Member g of a body lies at x_g = c + R o_g + L n_g: the centre c, the arm R o_g, and an image n_g, since members wrap
// one by one. The images follow from positions and are no state. Pairs within a body are not listed, but a body may
// touch its own image. Stress is that of body branches: sum f (x) (b + R o_i - R o_j).
//
// Assembly::mass holds of each member its share of the body's mass (by its volume), so that sums over grains are right;
// Assembly::inverse_inertia the inverse of the body's least moment, or of its scaled one.
#pragma once

#include <vector>

#include "rvelab/cell/cell.hpp"
#include "rvelab/grains/rigid_motion.hpp"
#include "rvelab/solver/assembly/buffer.hpp"
#include "rvelab/specimen/specimen.hpp"

namespace rvelab {

struct Model;
struct Assembly;
struct ListedPair;
struct Resultant;
struct Network;

/// What an increment never changes.
struct BodyModel {
  std::vector<std::int64_t> id;
  std::vector<std::int32_t> first;   ///< by body, and the number of grains at the end, up to the padding
  std::vector<double> volume, mass;  ///< m^3, kg
  std::vector<double> radius;        ///< m, of the sphere (disc) of the same volume
  std::vector<double> lever;         ///< m, from the centre to the farthest point at most
  std::vector<Vector3> gyration;     ///< m^2
  // By member.
  std::vector<std::int32_t> owner;
  std::vector<Vector3> offset;  ///< m, body frame
  std::vector<double> share;    ///< of the mass and volume of the body
  // For the kernels (BodyArrays), padded.
  Buffer moments_about[3], inverse_moments_about[3], offset_along[3];
  std::vector<std::int32_t> row_of_owner;
  std::size_t size() const { return id.size(); }
  Vector3 moments(std::size_t b) const { return mass[b] * gyration[b]; }
};

/// A row of the kernels (body_row_length).
struct BodyMotion {
  Vector3 position = Vector3::Zero();
  double after_position = 0;
  Vector3 velocity = Vector3::Zero();
  double after_velocity = 0;
  Vector3 spin = Vector3::Zero();
  double after_spin = 0;
  Turn orientation;
};

/// What it changes. Bodies and members are padded to whole blocks of lanes.
struct BodyMotions {
  std::vector<BodyMotion, CacheLineAllocator<BodyMotion>> motion;  ///< by body
  // Follow from them and from the positions of the members: by member, m, cell frame; as numbers; by body, four each.
  Buffer arms[3], images[3];
  Buffer turning;

  Vector3 arm(std::size_t g) const { return {arms[0][g], arms[1][g], arms[2][g]}; }
  Image image(std::size_t g) const { return {int(images[0][g]), int(images[1][g]), int(images[2][g])}; }
  void set_arm(std::size_t g, const Vector3& arm);
  void set_image(std::size_t g, const Image& image);
};

std::size_t bytes_of(const BodyMotions& bodies);

/// Puts bodies and what follows from them into model and assembly, whose grains stand in their rows already.
void open_bodies(const Specimen& specimen, Model& model, Assembly& assembly);
void close_bodies(const Model& model, const Assembly& assembly, Specimen& specimen);
/// Masses and inertias of all grains, or of the members their shares, from the materials.
void set_physical_masses(Model& model);

/// Takes out the pairs of one body.
void leave_out_inner_pairs(const Model& model, const Assembly& assembly, std::vector<ListedPair>& pairs);
/// After a change of basis, and before the members are wrapped, by how much the bodies are.
void reduce_bodies(const Reduction& reduction, const Model& model, Assembly& assembly);
void wrap_bodies(const Model& model, Assembly& assembly);
void follow_wrapping(const std::vector<Image>& moved, Assembly& assembly);

/// Forces and torques of the contacts on each body; `forces` has a row for each and is overwritten.
void gather_on_bodies(const Model& model, const Assembly& assembly, std::vector<Resultant>& forces);
/// Sum of f (x) (b + arm_i - arm_j), N m.
Matrix3 virial_of_bodies(const Model& model, const Assembly& assembly);
/// The network with bodies for grains, and their members beside.
void join_members(const Model& model, const Assembly& assembly, Network& network);

}  // namespace rvelab
