#include "rvelab/h5/file_calls.hpp"

#include <cstring>
#include <string>

#include "rvelab/h5/pool_file.hpp"
#include "rvelab/io/hdf5/specimen_file.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/pool/status.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::h5 {

namespace {

using pool::Status;

/// Makes a call on a file and returns its status. All faults of the file have one status.
template <class Call>
std::int32_t status_of(const Receiver& failure, Call call) noexcept {
  try {
    call();
    return std::int32_t(Status::ok);
  } catch (...) {
    char text[1024];
    Status status = pool::status_of_exception(text, sizeof text);
    if (status == Status::bad_input || status == Status::bad_snapshot || status == Status::internal)
      status = Status::bad_file;
    failure.take(failure.self, text, std::strlen(text));
    return std::int32_t(status);
  }
}

std::int32_t give_specimen(const char* path, const Receiver& specimen, const Receiver& failure) noexcept {
  return status_of(failure, [&] {
    const std::vector<std::byte> bytes = to_bytes(io::read_specimen(path, io::Seal::required));
    specimen.take(specimen.self, bytes.data(), bytes.size());
  });
}

std::int32_t keep_pool(const char* path, const PoolNumbers& numbers, const StateSource& states,
                       const Receiver& failure) noexcept {
  return status_of(failure, [&] {
    const pool::Population population{numbers.tag,
                                      {numbers.generations, numbers.generations + numbers.slots},
                                      {numbers.ids, numbers.ids + numbers.rves}};
    h5::write_pool(path, population, [&](std::size_t k) {
      std::vector<std::byte> bytes;
      bool whole = true;
      struct Taken {
        std::vector<std::byte>& bytes;
        bool& whole;
      } taken{bytes, whole};
      const Receiver to{&taken, [](void* self, const void* from, std::size_t size) {
                          Taken& into = *static_cast<Taken*>(self);
                          try {
                            into.bytes.resize(size);
                            std::memcpy(into.bytes.data(), from, size);
                          } catch (...) {
                            into.whole = false;
                          }
                        }};
      if (!states.give(states.self, k, to) || !whole) throw std::bad_alloc();
      return bytes;
    });
  });
}

std::int32_t give_pool(const char* path, const Receiver& state, const PoolReceiver& receiver,
                       const Receiver& failure) noexcept {
  return status_of(failure, [&] {
    const pool::Population population = h5::read_pool(
        path, [&](std::span<const std::byte> bytes) { state.take(state.self, bytes.data(), bytes.size()); });
    receiver.take(receiver.self, {population.tag, population.generations.data(), population.generations.size(),
                                  population.ids.data(), population.ids.size()});
  });
}

}  // namespace
}  // namespace rvelab::h5

const rvelab::h5::FileCalls* rvelab_h5_file_calls() {
  static const rvelab::h5::FileCalls calls{rvelab::io::version, rvelab::h5::give_specimen, rvelab::h5::keep_pool,
                                           rvelab::h5::give_pool};
  return &calls;
}
