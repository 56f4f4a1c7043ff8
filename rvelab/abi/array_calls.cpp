// Arrays of a state by name. Declared in c_boundary.hpp.
#include "rvelab/abi/c_boundary.hpp"
#include "rvelab/abi/structs.hpp"
#include "rvelab/pool/arrays.hpp"

using namespace rvelab;
using namespace rvelab::abi;

namespace {

/// The array of that name in a state with these rows.
std::size_t array_named(const char* name, const std::vector<std::int64_t>& rows) {
  const auto texts = pool::array_texts();
  std::string names;
  for (std::size_t k = 0; k < texts.size(); ++k) {
    if (rows[k] < 0) continue;
    if (std::strcmp(texts[k].name, name) == 0) return k;
    names += (names.empty() ? "" : ", ") + std::string(texts[k].name);
  }
  throw pool::Refused(pool::Status::bad_input,
                      "get_array: there is no array \"" + std::string(name).substr(0, 80) + "\"; allowed: " + names);
}

}  // namespace

int32_t rvelab_array_init(rvelab_array* array, size_t struct_size) {
  return at_c_boundary([&] { init_struct(array, "array", struct_size); });
}

int32_t rvelab_list_arrays(rvelab_pool* handle, int64_t id, int64_t cap, rvelab_array* arrays, int64_t* n) {
  return of_pool(handle, {{n, "n"}, {cap > 0 ? static_cast<const void*>(arrays) : n, "arrays"}}, [&](pool::Pool& rves) {
    if (cap < 0) throw pool::Refused(pool::Status::bad_input, "list_arrays: cap is " + std::to_string(cap));
    const std::size_t size = cap > 0 ? read_struct(arrays).struct_size : 0;
    auto* const bytes = reinterpret_cast<unsigned char*>(arrays);
    for (std::int64_t k = 0; k < cap; ++k) {
      if (read_struct(reinterpret_cast<const rvelab_array*>(bytes + std::size_t(k) * size)).struct_size != size)
        throw pool::Refused(pool::Status::bad_input, "list_arrays: arrays[" + std::to_string(k) +
                                                         "].struct_size is not that of arrays[0]; call "
                                                         "rvelab_array_init for each");
    }
    const std::vector<std::int64_t> rows = rves.at<&pool::Share::array_rows>(id);
    const auto texts = pool::array_texts();
    *n = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (rows[k] < 0 || (*n)++ >= cap) continue;
      const pool::ArrayText& text = texts[k];
      const rvelab_array found{std::uint32_t(size), 0,       text.name,   text.unit, text.meaning, text.of,
                               text.type,           rows[k], text.columns};
      std::memcpy(bytes + std::size_t(*n - 1) * size, &found, std::min(size, sizeof found));
    }
  });
}

int32_t rvelab_get_array(rvelab_pool* handle, int64_t id, const char* name, void* buf, size_t cap, size_t* need) {
  return of_pool(handle, {{name, "name"}, {need, "need"}, {cap > 0 ? buf : need, "buf"}}, [&](pool::Pool& rves) {
    const std::vector<std::int64_t> rows = rves.at<&pool::Share::array_rows>(id);
    const std::size_t k = array_named(name, rows);
    *need = 8 * std::size_t(rows[k] * pool::array_texts()[k].columns);
    if (buf == nullptr) return;
    if (cap < *need)
      throw pool::Refused(pool::Status::small_buffer, "get_array: cap is " + std::to_string(cap) + " bytes; " + name +
                                                          " takes " + std::to_string(*need));
    const std::vector<std::byte> entries = rves.at<&pool::Share::array>(id, std::int64_t(k));
    std::memcpy(buf, entries.data(), entries.size());
  });
}
