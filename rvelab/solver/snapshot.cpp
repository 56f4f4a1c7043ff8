// Snapshots: a specimen as bytes, for this build's layout, and back.
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "rvelab/error.hpp"
#include "rvelab/solver/rve_impl.hpp"

namespace rvelab {

namespace {

constexpr char magic[8] = {'r', 'v', 'e', 's', 'n', 'a', 'p', '3'};

/// FNV-1a over the payload: a flipped bit or a cut is noticed before anything is used.
std::uint64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t sum = 14695981039346656037ULL;
  for (std::byte b : bytes) sum = (sum ^ std::uint64_t(b)) * 1099511628211ULL;
  return sum;
}

struct Writer {
  std::vector<std::byte> bytes;
  void raw(const void* from, std::size_t n) {
    const auto* p = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), p, p + n);
  }
  template <class T>
  void operator()(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&v, sizeof v);
  }
  void operator()(const Vector3& v) { raw(v.data(), sizeof(double) * 3); }
  void operator()(const Matrix3& v) { raw(v.data(), sizeof(double) * 9); }
  void operator()(const std::string& s) {
    (*this)(std::uint64_t(s.size()));
    raw(s.data(), s.size());
  }
  template <class T>
  void sequence(const std::vector<T>& v) {
    (*this)(std::uint64_t(v.size()));
  }
};

struct Reader {
  std::span<const std::byte> bytes;
  void raw(void* to, std::size_t n) {
    if (n > bytes.size()) throw InputError("snapshot: it ends too early; it was cut short");
    std::memcpy(to, bytes.data(), n);
    bytes = bytes.subspan(n);
  }
  template <class T>
  void operator()(T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&v, sizeof v);
  }
  void operator()(Vector3& v) { raw(v.data(), sizeof(double) * 3); }
  void operator()(Matrix3& v) { raw(v.data(), sizeof(double) * 9); }
  // A checksum is no proof of what is below it: a kind that is none would choose a kernel that is none.
  void operator()(bool& v) {
    std::uint8_t byte = 0;
    raw(&byte, sizeof byte);
    if (byte > 1) throw InputError("snapshot: a truth value is " + std::to_string(byte) + "; it was damaged");
    v = byte == 1;
  }
  void operator()(Shape& v) {
    raw(&v, sizeof v);
    if (v != Shape::disc && v != Shape::sphere) throw InputError("snapshot: its grains have no shape; it was damaged");
  }
  void operator()(Law& v) {
    raw(&v, sizeof v);
    v = law_from(name(v));
  }
  void operator()(Slip& v) {
    raw(&v, sizeof v);
    v = slip_from(name(v));
  }
  void operator()(Dashpot& v) {
    raw(&v, sizeof v);
    v = dashpot_from(name(v));
  }
  void operator()(LocalDampingForm& v) {
    raw(&v, sizeof v);
    v = local_damping_form_from(name(v));
  }
  std::size_t count() {
    std::uint64_t n = 0;
    raw(&n, sizeof n);
    if (n > bytes.size()) throw InputError("snapshot: an array is longer than the snapshot; it was damaged");
    return std::size_t(n);
  }
  void operator()(std::string& s) {
    s.resize(count());
    raw(s.data(), s.size());
  }
  template <class T>
  void sequence(std::vector<T>& v) {
    v.resize(count());
  }
};

template <class Archive, class T>
void each(Archive& ar, T& values) {
  ar.sequence(values);
  for (auto& v : values) ar(v);
}

/// Every field, once, in one order, for both directions.
template <class Archive, class S>
void visit(Archive& ar, S& s) {
  ar(s.shape);
  ar(s.cell.dimension);
  ar(s.cell.lattice);
  ar(s.cell.rotation);
  ar(s.cell.increments);
  ar.sequence(s.materials);
  for (auto& m : s.materials) {
    ar(m.name);
    for (auto* v : {&m.density, &m.young_modulus, &m.stiffness_ratio, &m.poisson_ratio, &m.normal_stiffness,
                    &m.tangential_stiffness, &m.friction, &m.rolling_stiffness, &m.rolling_friction})
      ar(*v);
  }
  // Field by field: the padding of a struct is no state, and a snapshot must be equal where the states are.
  ar(s.contact.law);
  ar(s.contact.slip);
  ar(s.contact.rolling);
  ar(s.contact.unload_rescale);
  auto& damping = s.damping;
  for (auto* v : {&damping.local, &damping.local_quasi_static, &damping.normal_coefficient, &damping.restitution,
                  &damping.tangential_ratio, &damping.global_viscous})
    ar(*v);
  ar(damping.local_form);
  ar(damping.dashpot);
  ar(damping.no_tension);
  auto& solver = s.solver;
  for (auto* v : {&solver.skin, &solver.time_step_factor, &solver.fixed_time_step, &solver.target_unbalanced,
                  &solver.min_height, &solver.max_overlap_ratio})
    ar(*v);
  ar(solver.collision_steps);
  ar(solver.fixed_substeps);
  ar(solver.max_substeps);
  ar(solver.ledger);
  each(ar, s.grains.id);
  each(ar, s.grains.radius);
  each(ar, s.grains.material);
  each(ar, s.grains.position);
  each(ar, s.grains.velocity);
  each(ar, s.grains.spin);
  ar.sequence(s.contacts);
  for (auto& c : s.contacts) {
    ar(c.i);
    ar(c.j);
    ar(c.image);
    ar(c.tangential_force);
    ar(c.rolling_moment);
    ar(c.last_root_overlap);
  }
  auto& t = s.state;
  ar(t.has_reference);
  each(ar, t.list_positions);
  for (auto* m : {&t.list_lattice, &t.servo_strain, &t.servo_rate, &t.last_rate}) ar(*m);
  for (auto* v : {&t.list_travel, &t.list_skin, &t.strain_per_step, &t.reference_contact_force, &t.reference_overlap,
                  &t.reference_pressure, &t.last_step})
    ar(*v);
  ar(t.quasi_static);
  ar(t.mean_velocity);
  ar(t.mean_spin);
  ar(t.grain_steps);
  ar(t.list_steps);
  ar(t.list_builds);
  each(ar, t.memory_order);
  ar(t.ledger);
}

}  // namespace

std::vector<std::byte> to_bytes(const Specimen& specimen) {
  Writer body;
  visit(body, specimen);
  Writer whole;
  whole.raw(magic, sizeof magic);
  whole(checksum(body.bytes));
  whole.raw(body.bytes.data(), body.bytes.size());
  return std::move(whole.bytes);
}

Specimen from_bytes(std::span<const std::byte> bytes) {
  Reader in{bytes};
  char found[sizeof magic];
  in.raw(found, sizeof found);
  if (std::memcmp(found, magic, sizeof magic) != 0)
    throw InputError("snapshot: it is not a snapshot of this build; write a specimen file to carry a state across");
  std::uint64_t sum = 0;
  in(sum);
  if (sum != checksum(in.bytes)) throw InputError("snapshot: its checksum is wrong; it was cut short or damaged");
  Specimen s;
  visit(in, s);
  return s;
}

}  // namespace rvelab
