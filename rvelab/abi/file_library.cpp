#include "rvelab/abi/file_library.hpp"

#include <dlfcn.h>

#include <exception>
#include <mutex>

#include "rvelab/h5/file_calls.hpp"
#include "rvelab/io/version.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::abi {

namespace {

using pool::Refused;
using pool::Status;

constexpr const char* library_name = "librvelab-h5.so.1";

std::mutex library_mutex;
const h5::FileCalls* loaded_calls = nullptr;

/// Folder of the library (or program) that this code is in, with its last stroke; "" if the loader does not know it.
std::string own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&library_mutex), &info) == 0 || info.dli_fname == nullptr) return {};
  const std::string name = info.dli_fname;
  const auto stroke = name.rfind('/');
  return stroke == std::string::npos ? std::string() : name.substr(0, stroke + 1);
}

const h5::FileCalls& file_calls() {
  const std::lock_guard lock(library_mutex);
  if (loaded_calls != nullptr) return *loaded_calls;
  const std::string beside = own_folder() + library_name;
  void* library = dlopen(beside.c_str(), RTLD_NOW | RTLD_LOCAL);
  std::string reasons = library == nullptr ? dlerror() : "";
  if (library == nullptr) {
    library = dlopen(library_name, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) reasons += std::string("; ") + dlerror();
  }
  const auto refuse = [&](const std::string& what) {
    throw Refused(Status::no_library, std::string("files are read and written by ") + library_name + ": " + what +
                                          "; put the one of this version beside librvelab.so, or its folder into "
                                          "LD_LIBRARY_PATH");
  };
  if (library == nullptr) refuse(reasons);
  const auto get = reinterpret_cast<h5::GetFileCalls>(dlsym(library, h5::file_calls_name));
  const h5::FileCalls* const calls = get == nullptr ? nullptr : get();
  if (calls == nullptr || calls->version != std::string(io::version)) {
    const std::string found = calls == nullptr
                                  ? "it is none of rvelab's"
                                  : std::string("it is of rvelab ") + calls->version + ", this is " + io::version;
    dlclose(library);
    refuse(found);
  }
  loaded_calls = calls;
  return *calls;
}

/// Text of a failure.
struct Failure {
  std::string text;
  h5::Receiver receiver() {
    return {this, [](void* self, const void* bytes, std::size_t size) {
              try {
                static_cast<Failure*>(self)->text.assign(static_cast<const char*>(bytes), size);
              } catch (...) {  // no memory for words
              }
            }};
  }
};

/// Work that the other library asks for; an exception waits here until the other library has returned.
struct Deferred {
  std::exception_ptr exception;
  template <class Work>
  bool run(Work work) noexcept {
    if (exception) return false;
    try {
      work();
      return true;
    } catch (...) {
      exception = std::current_exception();
      return false;
    }
  }
  void expect_done(std::int32_t status, const Failure& failure) const {
    if (exception) std::rethrow_exception(exception);
    if (status != std::int32_t(Status::ok)) throw Refused(Status(status), failure.text);
  }
};

std::span<const std::byte> span_of(const void* bytes, std::size_t size) {
  return {static_cast<const std::byte*>(bytes), size};
}

using Take = std::function<void(std::span<const std::byte>)>;

/// What is wrong with a state is wrong with the file that it came from.
void take_from_file(const Take& take, std::span<const std::byte> bytes) {
  try {
    take(bytes);
  } catch (const Error& error) {
    throw Refused(Status::bad_file, error.what());
  }
}

}  // namespace

Specimen read_specimen(const std::string& path) {
  struct Read : Deferred {
    Specimen specimen;
  } read;
  Failure failure;
  const h5::Receiver take{&read, [](void* self, const void* bytes, std::size_t size) {
                            Read& into = *static_cast<Read*>(self);
                            into.run([&] { into.specimen = from_bytes(span_of(bytes, size)); });
                          }};
  const std::int32_t status = file_calls().read_specimen(path.c_str(), take, failure.receiver());
  read.expect_done(status, failure);
  return std::move(read.specimen);
}

void write_pool(pool::Pool& pool, const std::string& path) {
  pool.write([&](const pool::Population& population, const auto& state) {
    const h5::FileCalls& calls = file_calls();
    using State = std::remove_reference_t<decltype(state)>;
    struct Source : Deferred {
      State* state;
    } source;
    source.state = &state;
    Failure failure;
    const h5::StateSource give{&source, [](void* self, std::size_t k, const h5::Receiver& to) {
                                 Source& from = *static_cast<Source*>(self);
                                 return from.run([&] {
                                   const std::vector<std::byte> bytes = (*from.state)(k);
                                   to.take(to.self, bytes.data(), bytes.size());
                                 });
                               }};
    const h5::PoolNumbers numbers{population.tag, population.generations.data(), population.generations.size(),
                                  population.ids.data(), population.ids.size()};
    const std::int32_t status = calls.write_pool(path.c_str(), numbers, give, failure.receiver());
    source.expect_done(status, failure);
  });
}

void read_pool(pool::Pool& pool, const std::string& path) {
  pool.read([&](const Take& take) {
    const h5::FileCalls& calls = file_calls();
    struct Read : Deferred {
      const Take* take;
      pool::Population population;
    } read;
    read.take = &take;
    Failure failure;
    const h5::Receiver state{&read, [](void* self, const void* bytes, std::size_t size) {
                               Read& into = *static_cast<Read*>(self);
                               into.run([&] { take_from_file(*into.take, span_of(bytes, size)); });
                             }};
    const h5::PoolReceiver numbers{&read, [](void* self, const h5::PoolNumbers& found) {
                                     Read& into = *static_cast<Read*>(self);
                                     into.run([&] {
                                       into.population = {found.tag,
                                                          {found.generations, found.generations + found.slots},
                                                          {found.ids, found.ids + found.rves}};
                                     });
                                   }};
    const std::int32_t status = calls.read_pool(path.c_str(), state, numbers, failure.receiver());
    read.expect_done(status, failure);
    return std::move(read.population);
  });
}

}  // namespace rvelab::abi
