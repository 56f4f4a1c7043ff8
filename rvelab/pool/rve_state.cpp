#include "rvelab/pool/rve_state.hpp"

#include "rvelab/pool/message.hpp"
#include "rvelab/pool/pool.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::pool {

namespace {

constexpr char magic[8] = {'r', 'v', 'e', 'p', 'o', 'o', 'l', '2'};

struct Head {
  char magic[8];
  std::uint64_t length;    ///< bytes that follow
  std::uint64_t checksum;  ///< of these
};

/// As it lies in the bytes, without padding.
struct Numbers {
  std::int64_t committed, next, trials;
  double initial_void_ratio, inertial_number, error_estimate;
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

}  // namespace

std::vector<std::byte> to_bytes(const RveState& state, std::span<const std::byte> specimen) {
  const Tokens& tokens = state.tokens;
  Head head{{}, sizeof(Numbers) + std::size_t(tokens.trials()) * sizeof(Trial) + specimen.size(), 0};
  std::memcpy(head.magic, magic, sizeof magic);
  Packer packer;
  packer.make_room(sizeof head + head.length).put(head);
  packer.put(Numbers{tokens.committed(), tokens.next(), tokens.trials(), state.initial_void_ratio,
                     state.last.inertial_number, state.last.error_estimate});
  for (int k = 0; k < tokens.trials(); ++k) {
    const TrialRecord& record = tokens.trial(k);
    Trial trial{record.token, {}, record.dt};
    store(record.displacement_gradient, trial.gradient);
    packer.put(trial);
  }
  Bytes bytes = packer.put_rest(specimen).take();
  head.checksum = snapshot_checksum(std::span(bytes).subspan(sizeof head));
  std::memcpy(bytes.data(), &head, sizeof head);
  return bytes;
}

RveState rve_state_of(std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof(Head) || std::memcmp(bytes.data(), magic, sizeof magic) != 0)
    refuse("its " + std::to_string(bytes.size()) + " bytes do not begin as those of a snapshot of this version (\"" +
           std::string(magic, sizeof magic) + "\")");
  Unpacker in(bytes);
  const auto head = in.take<Head>();
  bytes = in.rest();
  if (head.length != bytes.size())
    refuse("it has " + std::to_string(bytes.size()) + " bytes behind its head, which says " +
           std::to_string(head.length) + ": it was cut short or damaged");
  if (head.checksum != snapshot_checksum(bytes)) refuse("its checksum does not fit its bytes: it was damaged");
  const auto expect_more = [&in](std::size_t size) {
    if (in.rest().size() < size) refuse("it ends before its tokens do");
  };
  expect_more(sizeof(Numbers));
  const auto numbers = in.take<Numbers>();
  if (numbers.trials < 0 || numbers.trials > Tokens::kept || numbers.committed < 1 ||
      numbers.next <= numbers.committed || !(numbers.initial_void_ratio > -1))
    refuse("its tokens cannot be: it was damaged");
  RveState state;
  state.initial_void_ratio = numbers.initial_void_ratio;
  state.last = {numbers.inertial_number, numbers.error_estimate};
  state.tokens.restore(numbers.committed, numbers.next);
  expect_more(std::size_t(numbers.trials) * sizeof(Trial));
  for (std::int64_t k = 0; k < numbers.trials; ++k) {
    const auto trial = in.take<Trial>();
    state.tokens.add_again({trial.token, tensor_at(trial.gradient), trial.dt});
  }
  try {
    state.specimen = from_bytes(in.rest());
  } catch (const InputError& error) {
    refuse(error.what());
  }
  return state;
}

}  // namespace rvelab::pool
