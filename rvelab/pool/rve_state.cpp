#include "rvelab/pool/rve_state.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "rvelab/pool/status.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::pool {

namespace {

constexpr char magic[8] = {'r', 'v', 'e', 'p', 'o', 'o', 'l', '1'};

struct Head {
  char magic[8];
  std::uint64_t length;    ///< bytes that follow
  std::uint64_t checksum;  ///< of these
};

/// As it lies in the bytes, without padding.
struct Numbers {
  std::int64_t committed, next, trials;
  double initial_void_ratio, inertial_number;
};
struct Trial {
  std::int64_t token;
  double gradient[9], dt;
};

[[noreturn]] void refuse(const std::string& what) {
  throw Refused(Status::bad_snapshot, "snapshot: " + what +
                                          "; save it again, or carry the state with rvelab_pool_write, whose files "
                                          "go from build to build");
}

template <class Value>
Value take(std::span<const std::byte>& left) {
  Value value;
  if (left.size() < sizeof value) refuse("it ends before its tokens do");
  std::memcpy(&value, left.data(), sizeof value);
  left = left.subspan(sizeof value);
  return value;
}

/// Puts a value where `to` is, and moves it behind.
template <class Value>
void put(std::byte*& to, const Value& value) {
  std::memcpy(to, &value, sizeof value);
  to += sizeof value;
}

}  // namespace

std::vector<std::byte> to_bytes(const RveState& state, std::span<const std::byte> specimen) {
  const Tokens& tokens = state.tokens;
  std::vector<std::byte> bytes(sizeof(Head) + sizeof(Numbers) + std::size_t(tokens.trials()) * sizeof(Trial) +
                               specimen.size());
  std::byte* to = bytes.data() + sizeof(Head);
  put(to, Numbers{tokens.committed(), tokens.next(), tokens.trials(), state.initial_void_ratio, state.inertial_number});
  for (int k = 0; k < tokens.trials(); ++k) {
    const TrialRecord& record = tokens.trial(k);
    Trial trial{record.token, {}, record.dt};
    for (int e = 0; e < 9; ++e) trial.gradient[e] = record.displacement_gradient(e / 3, e % 3);
    put(to, trial);
  }
  std::copy(specimen.begin(), specimen.end(), to);
  Head head{{}, 0, 0};
  std::memcpy(head.magic, magic, sizeof magic);
  head.length = bytes.size() - sizeof head;
  head.checksum = snapshot_checksum(std::span(bytes).subspan(sizeof head));
  std::memcpy(bytes.data(), &head, sizeof head);
  return bytes;
}

RveState rve_state_of(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(Head) || std::memcmp(bytes.data(), magic, sizeof magic) != 0)
    refuse("its " + std::to_string(bytes.size()) + " bytes do not begin as those of a snapshot of this version (\"" +
           std::string(magic, sizeof magic) + "\")");
  const Head head = take<Head>(bytes);
  if (head.length != bytes.size())
    refuse("it has " + std::to_string(bytes.size()) + " bytes behind its head, which says " +
           std::to_string(head.length) + ": it was cut short or damaged");
  if (head.checksum != snapshot_checksum(bytes)) refuse("its checksum does not fit its bytes: it was damaged");
  const auto numbers = take<Numbers>(bytes);
  if (numbers.trials < 0 || numbers.trials > Tokens::kept || numbers.committed < 1 ||
      numbers.next <= numbers.committed || !(numbers.initial_void_ratio > -1))
    refuse("its tokens cannot be: it was damaged");
  RveState state;
  state.initial_void_ratio = numbers.initial_void_ratio;
  state.inertial_number = numbers.inertial_number;
  state.tokens.restore(numbers.committed, numbers.next);
  for (int k = 0; k < int(numbers.trials); ++k) {
    const auto trial = take<Trial>(bytes);
    TrialRecord record{trial.token, Matrix3::Zero(), trial.dt};
    for (int e = 0; e < 9; ++e) record.displacement_gradient(e / 3, e % 3) = trial.gradient[e];
    state.tokens.add_again(record);
  }
  try {
    state.specimen = from_bytes(bytes);
  } catch (const InputError& error) {
    refuse(error.what());
  }
  return state;
}

}  // namespace rvelab::pool
