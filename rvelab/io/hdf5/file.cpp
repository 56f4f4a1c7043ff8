#include "rvelab/io/hdf5/file.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <type_traits>
#include <utility>

#include "rvelab/error.hpp"
#include "rvelab/io/hdf5/seal.hpp"
#include "rvelab/keys/file_format.hpp"
#include "rvelab/keys/regular_file.hpp"

namespace rvelab::io {

using hdf5::Kind;
using hdf5::Type;
using hdf5::Values;

std::vector<std::string> texts_in(const Values& values) {
  std::vector<std::string> texts;
  for (std::size_t begin = 0; begin < values.bytes.size(); begin += values.type.bytes) {
    std::size_t length = values.type.bytes;
    while (length > 0 && values.bytes[begin + length - 1] == std::byte{0}) --length;
    texts.emplace_back(reinterpret_cast<const char*>(values.bytes.data()) + begin, length);
  }
  return texts;
}

namespace {

bool begins_as_hdf5(std::span<const std::byte> bytes) {
  constexpr unsigned char signature[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  return bytes.size() >= sizeof signature && std::memcmp(bytes.data(), signature, sizeof signature) == 0;
}

template <class Scalar>
constexpr Type type_of() {
  const Kind kind = std::is_floating_point_v<Scalar> ? Kind::floating
                    : std::is_signed_v<Scalar>       ? Kind::whole
                                                     : Kind::natural;
  return {kind, sizeof(Scalar)};
}

std::uint64_t count(const Shape64& shape) {
  std::uint64_t product = 1;
  for (const auto extent : shape) product *= extent;
  return product;
}

template <class Stored>
Stored value_at(std::span<const std::byte> bytes, std::size_t k) {
  Stored value;
  std::memcpy(&value, bytes.data() + k * sizeof value, sizeof value);
  return value;
}

/// Calls `with` with a value of the type that is stored.
template <class With>
void with_stored(Type type, With with) {
  if (type.kind == Kind::floating) return type.bytes == 4 ? with(float{}) : with(double{});
  const bool has_sign = type.kind == Kind::whole;
  switch (type.bytes) {
    case 1:
      return has_sign ? with(std::int8_t{}) : with(std::uint8_t{});
    case 2:
      return has_sign ? with(std::int16_t{}) : with(std::uint16_t{});
    case 4:
      return has_sign ? with(std::int32_t{}) : with(std::uint32_t{});
    default:
      return has_sign ? with(std::int64_t{}) : with(std::uint64_t{});
  }
}

std::string text_of(const hdf5::Object& object, const std::string& attribute) {
  const auto found = object.attributes.find(attribute);
  if (found == object.attributes.end() || found->second.type.kind != Kind::text) return {};
  const auto texts = texts_in(found->second);
  return texts.empty() ? std::string() : texts.front();
}

[[noreturn]] void fail_kind(const std::string& path, const std::string& name, const std::string& found,
                            const std::string& allowed) {
  throw InputError(path + ": dataset " + name + " has the type " + found + "; allowed: " + allowed +
                   "; the file is not one of rvelab's: write it again");
}

}  // namespace

std::string hdf5::name(Type type) {
  if (type.kind == Kind::text) return "text";
  const char* const kind = type.kind == Kind::floating ? "float" : type.kind == Kind::whole ? "int" : "uint";
  return kind + std::to_string(8 * type.bytes);
}

std::string in_words(const Shape64& shape) {
  std::string text;
  for (const auto extent : shape) text += (text.empty() ? "" : ", ") + std::to_string(extent);
  return "(" + text + ")";
}

Hdf5File Hdf5File::open(const std::string& path, Seal seal) {
  if (!std::filesystem::exists(path) && std::filesystem::exists(journal_of(path))) {
    throw InputError(path +
                     ": there is only the journal of a run that was killed or goes on; make the file with `rvelab "
                     "recover " +
                     path + "`");
  }
  auto bytes = keys::whole_file<std::vector<std::byte>>(path, "an HDF5 file that rvelab wrote");
  Hdf5File file(path, take_seal(bytes, path));
  if (!begins_as_hdf5(bytes)) {
    const keys::FileFormat* format = keys::format_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    throw InputError(path + ": is " + (format != nullptr ? format->what + std::string(", ") : "") +
                     "not an HDF5 file; give a file that rvelab wrote (make one with `rvelab import` or "
                     "`rvelab run`)");
  }
  if (seal == Seal::required) file.expect_seal();
  file.tree_ = hdf5::read(path, bytes);
  return file;
}

void Hdf5File::expect_seal() const {
  if (sealed_) return;
  throw InputError(path_ +
                   ": lacks the checksum at its end: it is truncated, or another program has changed it; copy it "
                   "again, or, if the change is meant, take it over with `rvelab seal " +
                   path_ + " -o NEW.h5`");
}

Hdf5File Hdf5File::from_image(const std::string& path, std::span<const std::byte> bytes) {
  if (!begins_as_hdf5(bytes)) throw InputError(path + ": holds a part that is not HDF5; it is damaged");
  Hdf5File file(path, true);
  file.tree_ = hdf5::read(path, bytes);
  return file;
}

Hdf5File Hdf5File::in_memory(const std::string& path) { return {path, false}; }

Values Hdf5File::kept(Type type, const Shape64& shape, std::span<const std::byte> bytes) {
  return {type, shape, tree_.storage.emplace_back(bytes.begin(), bytes.end())};
}

/// HDF5 has no text of no bytes: those of a list are as long as the longest, and one byte at least.
Values Hdf5File::kept(const std::vector<std::string>& texts, const Shape64& shape) {
  std::size_t longest = 1;
  for (const auto& text : texts) longest = std::max(longest, text.size());
  auto& letters = tree_.storage.emplace_back(texts.size() * longest);
  for (std::size_t k = 0; k < texts.size(); ++k) {
    std::memcpy(letters.data() + k * longest, texts[k].data(), texts[k].size());
  }
  return {{Kind::text, std::uint32_t(longest)}, shape, letters};
}

void Hdf5File::put(const std::string& name, Values values, const std::string& units) {
  for (auto slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    tree_.objects.try_emplace(name.substr(0, slash));
  }
  hdf5::Object object{std::move(values), {}};
  if (!units.empty()) object.attributes.emplace("units", kept({units}, {}));
  if (!tree_.objects.emplace(name, std::move(object)).second) throw Error(path_ + ": " + name + " is written twice");
}

template <class Scalar>
void Hdf5File::write(const std::string& name, std::span<const Scalar> values, const Shape64& shape,
                     const std::string& units) {
  if (values.size() != count(shape)) throw Error(path_ + ": " + name + ": number of values and shape differ");
  put(name, kept(type_of<Scalar>(), shape, std::as_bytes(values)), units);
}

void Hdf5File::write_text(const std::string& name, const std::vector<std::string>& values, const Shape64& shape) {
  if (values.size() != count(shape)) throw Error(path_ + ": " + name + ": number of values and shape differ");
  put(name, kept(values, shape), "-");
}

const Values& Hdf5File::dataset(const std::string& name) const {
  const auto found = tree_.objects.find(name);
  if (found == tree_.objects.end() || !found->second.dataset) {
    throw InputError(path_ + ": dataset " + name +
                     " is missing; the file is not one of rvelab's or is damaged: write it again");
  }
  return *found->second.dataset;
}

template <class Scalar>
std::vector<Scalar> Hdf5File::read(const std::string& name) const {
  const Values& values = dataset(name);
  constexpr bool floating = std::is_floating_point_v<Scalar>;
  if (values.type.kind == Kind::text || (values.type.kind == Kind::floating) != floating) {
    fail_kind(path_, name, hdf5::name(values.type), floating ? "float64" : "an integer");
  }
  std::vector<Scalar> read(values.bytes.size() / values.type.bytes);
  with_stored(values.type, [&]<class Stored>(Stored) {
    for (std::size_t k = 0; k < read.size(); ++k) {
      const auto stored = value_at<Stored>(values.bytes, k);
      if constexpr (std::is_integral_v<Stored> && std::is_integral_v<Scalar>) {
        if (!std::in_range<Scalar>(stored)) {
          throw InputError(path_ + ": dataset " + name + " holds " + std::to_string(stored) + "; allowed: " +
                           hdf5::name(type_of<Scalar>()) + "; the file is not one of rvelab's: write it again");
        }
      }
      read[k] = static_cast<Scalar>(stored);
    }
  });
  return read;
}

std::vector<std::string> Hdf5File::read_text(const std::string& name) const {
  const Values& values = dataset(name);
  if (values.type.kind != Kind::text) fail_kind(path_, name, hdf5::name(values.type), "text");
  return texts_in(values);
}

void Hdf5File::set_attribute(const std::string& name, const std::string& value) {
  tree_.objects["/"].attributes.insert_or_assign(name, kept({value}, {}));
}

std::string Hdf5File::attribute(const std::string& name) const { return text_of(tree_.objects.at("/"), name); }

std::vector<std::string> Hdf5File::attributes() const {
  std::vector<std::string> names;
  for (const auto& [name, values] : tree_.objects.at("/").attributes) names.push_back(name);
  return names;
}

std::vector<Hdf5Entry> Hdf5File::entries() const {
  std::vector<Hdf5Entry> found;
  for (const auto& [name, object] : tree_.objects) {
    if (!object.dataset) continue;
    found.push_back({name, hdf5::name(object.dataset->type), object.dataset->shape, text_of(object, "units")});
  }
  return found;
}

std::vector<std::string> Hdf5File::groups(const std::string& group) const {
  const std::string within = group + "/";
  std::vector<std::string> names;
  for (auto at = tree_.objects.lower_bound(within); at != tree_.objects.end() && at->first.starts_with(within); ++at) {
    const std::string name = at->first.substr(within.size());
    if (name.find('/') == std::string::npos) names.push_back(name);
  }
  return names;
}

void publish(const std::string& path, const Hdf5File& file, Sync sync) {
  const auto bytes = file.image();
  publish_bytes(path, {bytes, seal_of(bytes)}, sync);
}

void publish(const std::string& path, const std::function<void(Hdf5File&)>& fill) {
  auto file = Hdf5File::in_memory(path);
  fill(file);
  publish(path, file);
}

template void Hdf5File::write(const std::string&, std::span<const double>, const Shape64&, const std::string&);
template void Hdf5File::write(const std::string&, std::span<const std::int32_t>, const Shape64&, const std::string&);
template void Hdf5File::write(const std::string&, std::span<const std::int64_t>, const Shape64&, const std::string&);
template void Hdf5File::write(const std::string&, std::span<const std::uint64_t>, const Shape64&, const std::string&);
template void Hdf5File::write(const std::string&, std::span<const std::uint8_t>, const Shape64&, const std::string&);
template std::vector<double> Hdf5File::read(const std::string&) const;
template std::vector<std::int32_t> Hdf5File::read(const std::string&) const;
template std::vector<std::int64_t> Hdf5File::read(const std::string&) const;
template std::vector<std::uint64_t> Hdf5File::read(const std::string&) const;
template std::vector<std::uint8_t> Hdf5File::read(const std::string&) const;

}  // namespace rvelab::io
