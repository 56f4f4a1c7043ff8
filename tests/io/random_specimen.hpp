// Specimens whose every field holds random bits, and their comparison bit by bit. The structs are taken apart by
// structured bindings: a field that is added to one does not compile here until it is filled and compared too.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/records/progress.hpp"
#include "rvelab/records/record.hpp"
#include "rvelab/solver/specimen.hpp"

namespace rvelab::test {

class RandomFill;

/// Calls visit(a.field, b.field) for every scalar, tensor, text or vector of two values.
template <class Visit>
struct Pairs {
  Visit visit;

  void operator()(Specimen& a, Specimen& b) {
    auto& [shape, cell, materials, contact, damping, solver, grains, contacts, state] = a;
    auto& [shape2, cell2, materials2, contact2, damping2, solver2, grains2, contacts2, state2] = b;
    visit(shape, shape2);
    fields(cell, cell2);
    lists(materials, materials2);
    fields(contact, contact2);
    fields(damping, damping2);
    fields(solver, solver2);
    fields(grains, grains2);
    lists(contacts, contacts2);
    fields(state, state2);
  }
  void operator()(TestResult& a, TestResult& b) {
    auto& [protocol, axis, pressure, stages, records, probes, wall, steps] = a;
    auto& [protocol2, axis2, pressure2, stages2, records2, probes2, wall2, steps2] = b;
    all(protocol, protocol2, axis, axis2, pressure, pressure2, wall, wall2, steps, steps2);
    visit(stages, stages2);
    lists(records, records2);
    lists(probes, probes2);
  }
  void operator()(Checkpoint& a, Checkpoint& b) {
    (*this)(a.specimen, b.specimen);
    fields(a.progress, b.progress);
  }

 private:
  template <class Item>
  void lists(std::vector<Item>& a, std::vector<Item>& b) {
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) fields(a[k], b[k]);
  }
  template <class A, class B, class... Rest>
  void all(A& a, B& b, Rest&... rest) {
    visit(a, b);
    if constexpr (sizeof...(rest) > 0) all(rest...);
  }
  void fields(Cell& a, Cell& b) {
    auto& [k, l, m, n] = a;
    auto& [k2, l2, m2, n2] = b;
    all(k, k2, l, l2, m, m2, n, n2);
  }
  void fields(Material& a, Material& b) {
    auto& [k, l, m, n, o, p, q, r, s, t] = a;
    auto& [k2, l2, m2, n2, o2, p2, q2, r2, s2, t2] = b;
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2, q, q2, r, r2, s, s2, t, t2);
  }
  void fields(ContactModel& a, ContactModel& b) {
    auto& [k, l, m, n] = a;
    auto& [k2, l2, m2, n2] = b;
    all(k, k2, l, l2, m, m2, n, n2);
  }
  void fields(Damping& a, Damping& b) {
    auto& [k, l, m, n, o, p, q, r, s] = a;
    auto& [k2, l2, m2, n2, o2, p2, q2, r2, s2] = b;
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2, q, q2, r, r2, s, s2);
  }
  void fields(SolverOptions& a, SolverOptions& b) {
    auto& [k, l, m, steps, n, o, p, q, r, s] = a;
    auto& [k2, l2, m2, steps2, n2, o2, p2, q2, r2, s2] = b;
    all(k, k2, l, l2, m, m2, steps, steps2, n, n2, o, o2, p, p2, q, q2, r, r2, s, s2);
  }
  void fields(Grains& a, Grains& b) {
    auto& [k, l, m, n, o, p] = a;
    auto& [k2, l2, m2, n2, o2, p2] = b;
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2);
  }
  void fields(Contact& a, Contact& b) {
    auto& [k, l, m, n, o, p] = a;
    auto& [k2, l2, m2, n2, o2, p2] = b;
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2);
  }
  void fields(EnergyLedger& a, EnergyLedger& b) {
    auto& [k, l, m, n, o, p, q, r] = a;
    auto& [k2, l2, m2, n2, o2, p2, q2, r2] = b;
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2, q, q2, r, r2);
  }
  void fields(SolverState& a, SolverState& b) {
    auto& [k, l, positions, m, n, o, p, q, servo_rate, r, s, t, u, v, w, x, y, z, c, order, ledger] = a;
    auto& [k2, l2, positions2, m2, n2, o2, p2, q2, servo_rate2, r2, s2, t2, u2, v2, w2, x2, y2, z2, c2, order2,
           ledger2] = b;
    visit(servo_rate, servo_rate2);
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2, q, q2, r, r2, s, s2, t, t2, u, u2, v, v2, w, w2, x, x2, y, y2);
    all(z, z2, c, c2, positions, positions2, order, order2);
    fields(ledger, ledger2);
  }
  void fields(ProbeResult& a, ProbeResult& b) {
    auto& [stage, stiffness] = a;
    auto& [stage2, stiffness2] = b;
    visit(stage, stage2);
    for (Eigen::Index k = 0; k < std::min(stiffness.size(), stiffness2.size()); ++k) {
      visit(stiffness.data()[k], stiffness2.data()[k]);
    }
  }
  void fields(Progress& a, Progress& b) {
    auto& [k, l, m, n, o, p, q, r, s, t, u, v, strains, first, turns, place, visits, largest, w, x, y, z] = a;
    auto& [k2, l2, m2, n2, o2, p2, q2, r2, s2, t2, u2, v2, strains2, first2, turns2, place2, visits2, largest2, w2, x2,
           y2, z2] = b;
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2, q, q2, r, r2, s, s2, t, t2, u, u2, v, v2, w, w2, x, x2, y, y2, z, z2);
    all(strains, strains2, first, first2, turns, turns2, place, place2, visits, visits2, largest, largest2);
  }
  void fields(Record& a, Record& b) {
    auto& [k, l, m, n, o, p, q, r, s, balanced, asked] = static_cast<RecordedState&>(a);
    auto& [k2, l2, m2, n2, o2, p2, q2, r2, s2, balanced2, asked2] = static_cast<RecordedState&>(b);
    visit(balanced, balanced2);
    all(k, k2, l, l2, m, m2, n, n2, o, o2, p, p2, q, q2, r, r2, s, s2);
    records::Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t) {
      visit(a.*Quantity::member, b.*Quantity::member);
    });
    // What was not asked for is not kept: a record with random bits in all fields has asked for all.
    if constexpr (std::is_same_v<Visit, RandomFill>) {
      asked |= records::all_quantities;
    } else {
      visit(asked, asked2);
    }
  }
};

/// Random bits: any double comes up, infinities, subnormals and NaN with any payload among them.
class RandomFill {
 public:
  explicit RandomFill(unsigned seed) : bits_(seed) {}

  template <class Value>
  void operator()(Value& value, Value&) {
    put(value);
  }

 private:
  void put(bool& value) { value = bits_() % 2 == 1; }
  void put(std::string& value) {
    value = "grès ";
    for (int k = 0; k < 8; ++k) value += static_cast<char>('a' + bits_() % 26);
  }
  void put(Shape& value) { value = Shape(bits_() % 2); }
  void put(Law& value) { value = Law(bits_() % 4); }
  void put(Slip& value) { value = Slip(bits_() % 3); }
  void put(Dashpot& value) { value = Dashpot(bits_() % 5); }
  void put(LocalDampingForm& value) { value = LocalDampingForm(bits_() % 2); }
  void put(Vector3& value) {
    for (int k = 0; k < 3; ++k) put(value[k]);
  }
  void put(Matrix3& value) {
    for (int k = 0; k < 9; ++k) put(value(k / 3, k % 3));
  }
  void put(Image& value) {
    for (int& entry : value) put(entry);
  }
  template <class Value>
  void put(std::vector<Value>& values) {
    for (Value& value : values) put(value);
  }
  template <class Value>
  requires std::is_arithmetic_v<Value>
  void put(Value& value) {
    const auto random = bits_();
    std::memcpy(&value, &random, sizeof value);
  }

  std::mt19937_64 bits_;
};

/// Counts the fields that differ in a bit.
struct BitComparison {
  int* differences;

  template <class Value>
  void operator()(const Value& a, const Value& b) {
    if (!same(a, b)) ++*differences;
  }

  static bool same(const std::string& a, const std::string& b) { return a == b; }
  template <class Value>
  static bool same(const std::vector<Value>& a, const std::vector<Value>& b) {
    bool equal = a.size() == b.size();
    for (std::size_t k = 0; equal && k < a.size(); ++k) equal = same(a[k], b[k]);
    return equal;
  }
  template <class Value>
  static bool same(const Value& a, const Value& b) {
    return std::memcmp(&a, &b, sizeof(Value)) == 0;  // no type here has padding
  }
};

template <class Value>
int differences(Value a, Value b) {
  int count = 0;
  Pairs<BitComparison>{BitComparison{&count}}(a, b);
  return count;
}

inline int differences_in_sizes(const Specimen& a, const Specimen& b) {
  return int(a.materials.size() != b.materials.size()) + int(a.contacts.size() != b.contacts.size());
}

/// Random in every field, with indices that point at something.
inline Specimen random_specimen(unsigned seed, std::size_t grain_count = 17, std::size_t contact_count = 31) {
  Specimen specimen;
  Grains& grains = specimen.grains;
  grains.id.resize(grain_count);
  grains.radius.resize(grain_count);
  grains.material.resize(grain_count);
  for (auto* vectors : {&grains.position, &grains.velocity, &grains.spin}) vectors->resize(grain_count);
  specimen.state.list_positions.resize(grain_count);
  specimen.state.memory_order.resize(grain_count);
  specimen.contacts.resize(contact_count);
  specimen.materials.resize(3);
  Pairs<RandomFill>{RandomFill(seed)}(specimen, specimen);

  specimen.cell.dimension = dimension_of(specimen.shape);
  std::mt19937 choose(seed);
  const auto below = [&](std::size_t limit) { return static_cast<std::int32_t>(choose() % limit); };
  for (auto& material : grains.material) material = below(3);
  for (auto& contact : specimen.contacts) {
    contact.j = below(grain_count);
    contact.i = below(static_cast<std::size_t>(contact.j) + 1);
  }
  return specimen;
}

inline TestResult random_result(unsigned seed, std::size_t record_count = 23) {
  TestResult result;
  result.stages = {"isotropic", "shear"};
  result.records.resize(record_count);
  result.probes.resize(5);
  for (ProbeResult& probe : result.probes) probe.stiffness.setZero(6, 6);
  Pairs<RandomFill>{RandomFill(seed)}(result, result);
  return result;
}

inline Checkpoint random_checkpoint(unsigned seed) {
  Checkpoint checkpoint{{}, random_specimen(seed)};
  checkpoint.progress.visits.resize(2);
  checkpoint.progress.largest.resize(7);
  Checkpoint filled = checkpoint;
  Pairs<RandomFill>{RandomFill(seed + 1)}(filled, filled);
  return {filled.progress, checkpoint.specimen};
}

/// A folder of its own that vanishes with the test.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rvelab-test-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw Error("no temporary folder could be made");
    path_ = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}
inline std::string bytes_of(const std::string& path) {
  std::ifstream input(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), {}};
}

/// The message of the InputError that a call throws; "" if it throws none.
template <class Call>
std::string input_error(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace rvelab::test
