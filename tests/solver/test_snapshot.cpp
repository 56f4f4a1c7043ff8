// The head of a snapshot: bytes of another layout, cut or damaged ones are refused in one line.
#include "rvelab/solver/snapshot.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "rvelab/error.hpp"
#include "tests/refusal.hpp"
#include "tests/specimens.hpp"

using namespace rvelab;
using namespace rvelab::test;
using Catch::Matchers::Contains;

namespace {

using Bytes = std::vector<std::byte>;

Bytes with_head(Bytes bytes, const SnapshotHead& head) {
  std::memcpy(bytes.data(), &head, sizeof head);
  return bytes;
}

SnapshotHead head_of(const Bytes& bytes) {
  SnapshotHead head;
  std::memcpy(&head, bytes.data(), sizeof head);
  return head;
}

/// The same fields behind a head that fits them.
Bytes fitting(const Bytes& bytes) {
  SnapshotHead head = head_of(bytes);
  head.length = bytes.size() - sizeof head;
  head.checksum = snapshot_checksum(std::span(bytes).subspan(sizeof head));
  return with_head(bytes, head);
}

}  // namespace

TEST_CASE("a snapshot of another layout, cut short or damaged is refused in one line that says which") {
  Rve rve(disordered(Shape::disc, 5, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.53, 3));
  const Bytes good = rve.save();
  const auto message = [&](const Bytes& bytes) -> std::string {
    const std::string text = input_error([&] { rve.restore(bytes); });
    if (!text.empty()) CHECK(bool(rve.save() == good));
    CHECK(text.find('\n') == std::string::npos);
    return text;
  };
  CHECK(message(good).empty());
  CHECK(message(fitting(good)).empty());
  CHECK(head_of(good).length == good.size() - sizeof(SnapshotHead));

  SnapshotHead head = head_of(good);
  head.magic[7] = '3';
  CHECK_THAT(message(with_head(good, head)), Contains("\"rvesnap5\"") && Contains("specimen file"));
  head = head_of(good);
  head.layout ^= 1;
  CHECK_THAT(message(with_head(good, head)), Contains("layout") && Contains("that of this build"));
  CHECK_THAT(message({}), Contains("its 0 bytes"));
  CHECK_THAT(message(Bytes(good.begin(), good.begin() + 31)), Contains("its 31 bytes"));
  CHECK_THAT(message(Bytes(good.begin(), good.end() - 1)), Contains("its head, which says"));
  Bytes longer = good;
  longer.push_back(std::byte{0});
  CHECK_THAT(message(longer), Contains("its head, which says"));
  CHECK_THAT(message(fitting(longer)), Contains("1 bytes are left behind its last field"));
  CHECK_THAT(message(fitting(Bytes(good.begin(), good.end() - 1))),
             Contains("state/energy_balance/interactions is beyond its end"));
  for (std::size_t at = sizeof(SnapshotHead); at < good.size(); at += 97) {
    Bytes bad = good;
    bad[at] ^= std::byte{16};
    CHECK_THAT(message(bad), Contains("its checksum does not fit its bytes"));
  }
}

TEST_CASE("a length that the bytes cannot hold is refused before there is room made for it") {
  Rve rve(disordered(Shape::disc, 5, linear_material(2e6, 1e6, 0.4), Law::linear_stiffness, 0.53, 3));
  const Bytes good = rve.save();
  std::size_t refused = 0;
  for (std::size_t at = sizeof(SnapshotHead); at + 8 <= good.size(); ++at) {
    for (const std::uint64_t entries : {std::uint64_t(1) << 61, std::uint64_t(good.size())}) {
      Bytes bad = good;
      std::memcpy(bad.data() + at, &entries, sizeof entries);
      try {
        rve.restore(fitting(bad));
      } catch (const Error& error) {  // never std::bad_alloc or std::length_error
        refused +=
            std::string(error.what()).find("more than the bytes that are left can hold") == std::string::npos ? 0 : 1;
      }
      rve.restore(good);
    }
  }
  CHECK(refused > 20);
}

TEST_CASE("the checksum tells bytes apart that differ in one bit, in two bits, in length") {
  Bytes bytes(1000);
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = std::byte(k * 37 % 251);
  std::vector<std::uint64_t> sums{snapshot_checksum(bytes)};
  const auto add = [&](const Bytes& changed) { sums.push_back(snapshot_checksum(changed)); };
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    Bytes changed = bytes;
    changed[bit / 8] ^= std::byte(1u << bit % 8);
    add(changed);
  }
  // Two bits in neighbouring words of one sum, the signs of two doubles among them.
  for (std::size_t first = 0; first < 64; ++first) {
    for (std::size_t second = 0; second < 64; ++second) {
      Bytes changed = bytes;
      changed[8 * 20 + first / 8] ^= std::byte(1u << first % 8);
      changed[8 * 28 + second / 8] ^= std::byte(1u << second % 8);
      add(changed);
    }
  }
  for (std::size_t length = 0; length < bytes.size(); ++length) add(Bytes(bytes.begin(), bytes.begin() + long(length)));
  for (std::size_t zeros = 2; zeros < 130; ++zeros) add(Bytes(zeros));
  std::sort(sums.begin(), sums.end());
  CHECK(std::adjacent_find(sums.begin(), sums.end()) == sums.end());
}
