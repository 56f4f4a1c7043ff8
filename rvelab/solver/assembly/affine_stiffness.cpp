#include "rvelab/solver/assembly/affine_stiffness.hpp"

#include "rvelab/solver/assembly/contact_stiffness.hpp"
#include "rvelab/solver/assembly/interactions.hpp"
#include "rvelab/solver/assembly/pair_geometry.hpp"

namespace rvelab {

namespace {

/// Sums of l^2 (kn - kt) n n n n and l^2 kt n n over the contacts, cell frame: what the stiffness is made of.
struct Moments {
  Matrix6 fourth = Matrix6::Zero();  ///< [(i, j), (k, l)] in the order xx yy zz yz xz xy
  Matrix3 second = Matrix3::Zero();
};

/// Normal and tangential coefficient of a contact.
struct Coefficients {
  double normal, tangential;
};

/// Interactions other than contacts, as the contacts that they are beside: add(branch, kn, kt).
template <class Add>
void each_interaction(const Model& model, const Assembly& assembly, const Add& add) {
  if (!has_interactions(assembly)) return;
  for (const ActingInteraction& a : acting_interactions(model, assembly))
    add(Branch{a.branch[0], a.branch[1], a.branch[2]}, a.stiffness.normal, a.stiffness.tangential);
}

/// `interactions`: whether those other than contacts count, by their stiffness.
template <Shape shape, class Of>
Moments moments_of(const Model& model, const Assembly& assembly, const Of& coefficients, bool interactions) {
  constexpr int D = dimension_of(shape), pairs = D == 2 ? 3 : 6;
  constexpr int voigt[6] = {0, 1, D == 2 ? 5 : 2, 3, 4, 5};  // of the products of two components of n
  // Monomials of n of degree four and two; the servo renews its gain every few dozen sub-steps.
  double four[D][pairs] = {}, two[pairs] = {};
  const auto add = [&](const Branch& b, double kn, double kt) {
    const double part = (kn - kt) / (b.x * b.x + b.y * b.y + b.z * b.z);
    const double all[6] = {b.x * b.x, b.y * b.y, b.z * b.z, b.y * b.z, b.x * b.z, b.x * b.y};
    double products[pairs];
    for (int k = 0; k < pairs; ++k) products[k] = all[voigt[k]];
    for (int k = 0; k < pairs; ++k) two[k] += kt * products[k];
    for (int i = 0; i < D; ++i)
      for (int k = i; k < pairs; ++k) four[i][k] += part * (products[i] * products[k]);
  };
  each_touching<shape>(model, assembly, [&](std::size_t p, const PairPlace& at) {
    const auto [kn, kt] = coefficients(p, at);
    add(at.branch, kn, kt);
  });
  if (interactions) each_interaction(model, assembly, add);
  Moments m;
  Vector6 second = Vector6::Zero();
  for (int k = 0; k < pairs; ++k) second[voigt[k]] = two[k];
  m.second << second[0], second[5], second[4], second[5], second[1], second[3], second[4], second[3], second[2];
  for (int i = 0; i < D; ++i)
    for (int k = i; k < pairs; ++k) m.fourth(i, voigt[k]) = m.fourth(voigt[k], i) = four[i][k];
  // The same monomials: yz yz is yyzz, yz xz is zzxy, and so on.
  const Matrix6& known = m.fourth;
  m.fourth.bottomRightCorner<3, 3>() << known(1, 2), known(2, 5), known(1, 4), known(2, 5), known(0, 2), known(0, 3),
      known(1, 4), known(0, 3), known(0, 1);
  return m;
}

/// Strain components of the cell frame from those of the laboratory frame, as a matrix.
Matrix6 strain_turn(const Matrix3& rotation) {
  Matrix6 turn;
  for (int k = 0; k < 6; ++k)
    turn.col(k) = strain_components(rotation.transpose() * strain_matrix(Vector6::Unit(k)) * rotation);
  return turn;
}

/// sum kn (n b)(n b) + kt (t b)(t b) over contacts whose normal is not along the branch, with symmetric parts of the
/// dyads: under eps such a contact changes by n . eps b along n and by t . eps b across it. Cell frame, in the plane.
template <Shape shape, class Of>
Matrix6 sum_over_outlines(const Model& model, const Assembly& assembly, const Of& coefficients) {
  Matrix6 sum = Matrix6::Zero();
  const auto dyad = [](double x, double y, const Branch& b) {
    Vector6 components = Vector6::Zero();
    components[0] = x * b.x;
    components[1] = y * b.y;
    components[5] = 0.5 * (x * b.y + y * b.x);
    return components;
  };
  each_touching<shape>(model, assembly, [&](std::size_t p, const OutlinePlace& at) {
    const auto [kn, kt] = coefficients(p, at);
    const Vector6 along = dyad(at.normal.x, at.normal.y, at.branch),
                  across = dyad(-at.normal.y, at.normal.x, at.branch);
    sum += kn * along * along.transpose() + kt * across * across.transpose();
  });
  return sum;
}

template <Shape shape, class Of>
Matrix6 sum_over_round(const Model& model, const Assembly& assembly, const Of& coefficients, bool interactions) {
  // C_ijkl = sum l^2 [(kn - kt) n_i n_j n_k n_l
  //                   + kt/4 (n_i n_k d_jl + n_i n_l d_jk + n_j n_k d_il + n_j n_l d_ik)], see README.md.
  const Moments m = moments_of<shape>(model, assembly, coefficients, interactions);
  constexpr int first[6] = {0, 1, 2, 1, 0, 0}, second[6] = {0, 1, 2, 2, 2, 1};
  Matrix6 stiffness = m.fourth;
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c) {
      const int i = first[r], j = second[r], k = first[c], l = second[c];
      stiffness(r, c) += 0.25 * ((j == l ? m.second(i, k) : 0) + (j == k ? m.second(i, l) : 0) +
                                 (i == l ? m.second(j, k) : 0) + (i == k ? m.second(j, l) : 0));
    }
  return stiffness;
}

/// The same of bodies, by the branch between their centres: along n and across it in space.
template <Shape shape, class Of>
Matrix6 sum_over_bodies(const Model& model, const Assembly& assembly, const Of& coefficients) {
  Matrix6 sum = Matrix6::Zero();
  each_touching<shape>(model, assembly, [&](std::size_t p, const auto& at) {
    const auto [kn, kt] = coefficients(p, at);
    const Vector3 n = Vector3(at.along().x, at.along().y, at.along().z) / at.along_length();
    const Vector3 b = Vector3(at.branch.x, at.branch.y, at.branch.z) +
                      assembly.bodies.arm(std::size_t(assembly.pairs.i[p])) -
                      assembly.bodies.arm(std::size_t(assembly.pairs.j[p]));
    // Of e b = rows e: motion of the branch by the six strains.
    Eigen::Matrix<double, 3, 6> motion;
    for (int k = 0; k < 6; ++k) motion.col(k) = strain_matrix(Vector6::Unit(k)) * b;
    if (dimension_of(shape) == 2)
      for (const int k : {2, 3, 4}) motion.col(k).setZero();
    const Eigen::Matrix<double, 1, 6> along = n.transpose() * motion;
    sum += (kn - kt) * along.transpose() * along + kt * motion.transpose() * motion;
  });
  return sum;
}

template <class Of>
Matrix6 affine_sum(const Model& model, const Assembly& assembly, const Of& coefficients, bool interactions) {
  const Matrix6 stiffness = with_shape(model.shape, [&](auto shape) -> Matrix6 {
    if (moves_as_body(shape.value) || model.bodies) return sum_over_bodies<shape.value>(model, assembly, coefficients);
    if constexpr (is_round(shape.value))
      return sum_over_round<shape.value>(model, assembly, coefficients, interactions);
    else if constexpr (keeps_axis(shape.value))
      return sum_over_outlines<shape.value>(model, assembly, coefficients);
    else
      return {};  // of bodies
  });
  const Matrix6 turn = strain_turn(assembly.cell.rotation);
  return turn.transpose() * stiffness * turn / assembly.cell.volume();
}

}  // namespace

Matrix3 strain_matrix(const Vector6& e) {
  Matrix3 m;
  m << e[0], 0.5 * e[5], 0.5 * e[4], 0.5 * e[5], e[1], 0.5 * e[3], 0.5 * e[4], 0.5 * e[3], e[2];
  return m;
}

Vector6 strain_components(const Matrix3& m) {
  Vector6 e;
  e << m(0, 0), m(1, 1), m(2, 2), m(1, 2) + m(2, 1), m(0, 2) + m(2, 0), m(0, 1) + m(1, 0);
  return e;
}

Matrix6 affine_stiffness(const Model& model, const Assembly& assembly) {
  return with_force(model, [&](auto force) {
    return affine_sum(
        model, assembly,
        [&](std::size_t p, const auto& at) -> Coefficients {
          const ContactStiffness k =
              stiffness_of<decltype(force)>(model, parameters_of(model, assembly.pairs, p), at.overlap,
                                            hertz_radius_ratio(model, assembly.pairs, p, at));
          return {k.normal, k.tangential};
        },
        true);
  });
}

Matrix6 affine_viscosity(const Model& model, const Assembly& assembly) {
  if (model.damping.dashpot == Dashpot::none) return Matrix6::Zero();
  return with_force(model, [&](auto force) {
    return affine_sum(
        model, assembly,
        [&](std::size_t p, const auto& at) -> Coefficients {
          const double c = stiffness_of<decltype(force)>(model, parameters_of(model, assembly.pairs, p), at.overlap,
                                                         hertz_radius_ratio(model, assembly.pairs, p, at))
                               .dashpot;
          return {c, model.damping.tangential_ratio * c};
        },
        false);
  });
}

}  // namespace rvelab
