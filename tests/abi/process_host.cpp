// A host whose process is not as the libraries know it: with an HDF5 of its own among its global symbols, an operator
// new of its own, a locale that writes 50,000,000 and 0,4, and one that unloads librvelab.so while a pool lives.
//
//     process_host LIBRVELAB.so LIBRVELAB-H5.so SPECIMEN.h5 FOLDER hdf5|loaded|locale|unload
//
// Prints "ok", or what is wrong.
#include <dlfcn.h>
#include <rvelab/rvelab.h>
#include <unistd.h>

#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <locale>
#include <new>
#include <string>
#include <vector>

namespace {

int calls_of_hdf5 = 0;

}  // namespace

// Another HDF5, as a host has it that links one without symbol versions.
extern "C" {
int H5open() { return ++calls_of_hdf5; }
int H5check_version(unsigned, unsigned, unsigned) { return ++calls_of_hdf5; }
long H5Fopen(const char*, unsigned, long) { return ++calls_of_hdf5, 4711; }
long H5Fcreate(const char*, unsigned, long, long) { return ++calls_of_hdf5, 4712; }
int H5Fclose(long) { return ++calls_of_hdf5; }
long H5Pcreate(long) { return ++calls_of_hdf5, 4713; }
int H5E_printf_stack() { return ++calls_of_hdf5; }  // of those that an HDF5 calls within
}

// Memory that no other operator delete can free.
void* operator new(std::size_t size) {
  auto* const memory = static_cast<unsigned char*>(std::malloc(size + 64));
  if (memory == nullptr) throw std::bad_alloc();
  return memory + 64;
}
void operator delete(void* memory) noexcept {
  if (memory != nullptr) std::free(static_cast<unsigned char*>(memory) - 64);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace {

#define EXPECT(holds, ...)                                                    \
  do {                                                                        \
    if (!(holds)) {                                                           \
      std::printf("%s, line %d: %s\n", #holds, __LINE__, calls.last_error()); \
      __VA_OPT__(std::printf(__VA_ARGS__);)                                   \
      std::exit(1);                                                           \
    }                                                                         \
  } while (false)

/// The functions of a library that is loaded.
struct Calls {
  void* library;
  template <class Function>
  Function* get(const char* name) const {
    return reinterpret_cast<Function*>(dlsym(library, name));
  }
  explicit Calls(const char* path) : library(dlopen(path, RTLD_NOW | RTLD_LOCAL)) {
    if (library == nullptr) std::puts(dlerror()), std::exit(1);
  }
  const char* last_error() const { return get<decltype(rvelab_last_error)>("rvelab_last_error")(); }
#define CALL(name) decltype(rvelab_##name)* const name = get<decltype(rvelab_##name)>("rvelab_" #name)
  CALL(pool_create);
  CALL(pool_destroy);
  CALL(template_load);
  CALL(spawn);
  CALL(apply);
  CALL(batch_init);
  CALL(pool_def_init);
  CALL(trial);
  CALL(get_parameters);
  CALL(set_parameters);
  CALL(pool_write);
  CALL(pool_read);
#undef CALL
};

void with_another_hdf5(const Calls& calls, const char* specimen, const std::string& folder) {
  rvelab_pool *pool = nullptr, *other = nullptr;
  std::int64_t made = 0, id = 0;
  double dH[9] = {0, 1e-4}, sigma[9], again[9];
  const std::string file = folder + "/pool.h5";
  EXPECT(calls.pool_create(nullptr, &pool) == RVELAB_OK && calls.pool_create(nullptr, &other) == RVELAB_OK);
  EXPECT(calls.template_load(pool, specimen, &made) == RVELAB_OK);
  EXPECT(calls.spawn(pool, made, 1, &id) == RVELAB_OK && calls.pool_write(pool, file.c_str()) == RVELAB_OK);
  EXPECT(calls.pool_read(other, file.c_str()) == RVELAB_OK);
  EXPECT(calls.apply(pool, id, dH, 0, sigma) >= RVELAB_OK && calls.apply(other, id, dH, 0, again) >= RVELAB_OK);
  EXPECT(std::memcmp(sigma, again, sizeof sigma) == 0);
  EXPECT(calls.template_load(pool, "none.h5", &made) == RVELAB_E_FILE);  // an exception from the other library
  EXPECT(calls_of_hdf5 == 0, "%d calls of the host's HDF5\n", calls_of_hdf5);
  EXPECT(H5Fopen("x", 0, 0) == 4711 &&
         reinterpret_cast<long (*)(const char*, unsigned, long)>(dlsym(RTLD_DEFAULT, "H5Fopen"))("x", 0, 0) == 4711);
}

/// The host has loaded the second library by itself, which then calls the host's HDF5.
void with_the_library_loaded(const Calls& calls, const char* specimen, const char* h5) {
  if (dlopen(h5, RTLD_NOW | RTLD_GLOBAL) == nullptr) std::puts(dlerror());
  rvelab_pool* pool = nullptr;
  std::int64_t made = 0;
  EXPECT(calls.pool_create(nullptr, &pool) == RVELAB_OK);
  EXPECT(calls.template_load(pool, specimen, &made) == RVELAB_E_LIBRARY);
  EXPECT(std::strstr(calls.last_error(), "another HDF5 of the host") != nullptr);
}

/// en_US groups digits, de_DE has a comma before decimals: both at once.
struct Grouped : std::numpunct<char> {
  char do_thousands_sep() const override { return '.'; }
  char do_decimal_point() const override { return ','; }
  std::string do_grouping() const override { return "\3"; }
};

void with_a_locale(const Calls& calls, const char* specimen) {
  rvelab_pool* pool = nullptr;
  std::int64_t made = 0, id = 0;
  EXPECT(calls.pool_create(nullptr, &pool) == RVELAB_OK && calls.template_load(pool, specimen, &made) == RVELAB_OK);
  EXPECT(calls.spawn(pool, made, 1, &id) == RVELAB_OK);
  const auto parameters = [&] {
    std::size_t need = 0;
    EXPECT(calls.get_parameters(pool, id, nullptr, 0, &need) == RVELAB_OK);
    std::vector<char> text(need);
    EXPECT(calls.get_parameters(pool, id, text.data(), need, &need) == RVELAB_OK);
    return std::string(text.data());
  };
  double dH[9] = {1e-4, 0.25}, sigma[9];
  dH[8] = 0.5;  // out of the plane, or of no cell: refused with numbers
  const auto refused = [&] {
    EXPECT(calls.apply(pool, id, dH, -0.125, sigma) == RVELAB_E_INPUT);
    std::string words = calls.last_error();
    EXPECT(calls.set_parameters(pool, id, "solver.relative_tolerance = 12500.5\nsolver.max_substeps = -50000") <
           RVELAB_OK);
    return words + "\n" + calls.last_error();
  };
  const std::string before = parameters(), words = refused();
  const char* const comma = std::getenv("RVELAB_COMMA_LOCALE");  // of C, where one is installed
  if (comma != nullptr) EXPECT(std::setlocale(LC_ALL, comma) != nullptr && std::localeconv()->decimal_point[0] == ',');
  std::locale::global(std::locale(std::locale(), new Grouped));
  EXPECT(parameters() == before, "%s\nand before\n%s\n", parameters().c_str(), before.c_str());
  EXPECT(calls.set_parameters(pool, id, before.c_str()) == RVELAB_OK);
  EXPECT(refused() == words, "%s\nand before\n%s\n", refused().c_str(), words.c_str());
  EXPECT(words.find("-0.125") != std::string::npos && words.find("12500.5") != std::string::npos, "%s\n",
         words.c_str());
  if (comma != nullptr) EXPECT(std::localeconv()->decimal_point[0] == ',');  // as the host has set it
}

void unloaded(const char* path, const char* specimen) {
  for (int k = 0; k < 3; ++k) {
    const Calls calls(path);
    rvelab_pool_def def;
    rvelab_pool* pool = nullptr;
    std::int64_t made = 0, ids[8];
    EXPECT(calls.pool_def_init(&def, sizeof def) == RVELAB_OK);
    def.workers = 2;
    EXPECT(calls.pool_create(&def, &pool) == RVELAB_OK && calls.template_load(pool, specimen, &made) == RVELAB_OK);
    EXPECT(calls.spawn(pool, made, 8, ids) == RVELAB_OK);
    rvelab_batch batch;
    EXPECT(calls.batch_init(&batch, sizeof batch) == RVELAB_OK);
    double dH[72] = {}, sigma[72];
    for (int i = 0; i < 8; ++i) dH[9 * i + 1] = 1e-4;
    batch.n = 8;
    batch.ids = ids;
    batch.dH = dH;
    batch.sigma = sigma;
    EXPECT(calls.trial(pool, &batch) >= RVELAB_OK);
    dlclose(calls.library);
    usleep(20000);  // a thread of the pool goes to sleep, and runs on
  }
}

}  // namespace

int main(int n, char** words) {
  if (n != 6)
    return std::puts("process_host LIBRVELAB.so LIBRVELAB-H5.so SPECIMEN.h5 FOLDER hdf5|loaded|locale|unload"), 2;
  const std::string kind = words[5];
  if (kind == "unload") unloaded(words[1], words[3]);
  if (kind != "unload") {
    const Calls calls(words[1]);
    if (kind == "hdf5") with_another_hdf5(calls, words[3], words[4]);
    if (kind == "loaded") with_the_library_loaded(calls, words[3], words[2]);
    if (kind == "locale") with_a_locale(calls, words[3]);
  }
  std::puts("ok");
}
