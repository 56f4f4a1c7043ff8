// Comparison of two files, bit by bit: `rvelab compare`, and every test of a restart. Declared in specimen_file.hpp.
#include "rvelab/io/hdf5/specimen_file.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <set>

#include "rvelab/io/hdf5/file.hpp"
#include "rvelab/io/hdf5/schema.hpp"
#include "rvelab/keys/shortened.hpp"

namespace rvelab::io {
namespace {

/// Row-major number of a value as its index: "[3, 0, 2]"; nothing for a scalar.
std::string index_in_words(std::size_t number, const Shape64& shape) {
  std::string text;
  for (auto extent = shape.rbegin(); extent != shape.rend(); ++extent) {
    text = std::to_string(number % *extent) + (text.empty() ? "" : ", ") + text;
    number /= *extent;
  }
  return text.empty() ? "" : "[" + text + "]";
}

template <class Scalar>
std::string as_number(const std::byte* bytes) {
  Scalar value;
  std::memcpy(&value, bytes, sizeof value);
  char text[32];
  return {text, std::to_chars(std::begin(text), std::end(text), value).ptr};
}

std::string as_bytes(const std::byte* bytes, std::size_t size) {
  static const char* digits = "0123456789abcdef";
  std::string text = "0x";
  for (std::size_t k = size; k-- > 0;) {  // the most significant first
    text += digits[std::to_integer<unsigned>(bytes[k]) >> 4];
    text += digits[std::to_integer<unsigned>(bytes[k]) & 15];
  }
  return text;
}

/// Every bit of a number in decimal; types that rvelab does not write, in hexadecimal.
std::string value_in_words(const std::string& type, const std::byte* bytes, std::size_t size) {
  if (type == "float64") return as_number<double>(bytes);
  if (type == "float32") return as_number<float>(bytes);
  if (type == "int32") return as_number<std::int32_t>(bytes);
  if (type == "int64") return as_number<std::int64_t>(bytes);
  if (type == "uint64") return as_number<std::uint64_t>(bytes);
  if (type == "uint8") return std::to_string(std::to_integer<unsigned>(*bytes));
  return as_bytes(bytes, size);
}

std::string quoted(const std::string& text) { return "\"" + keys::shortened(text) + "\""; }

/// The first difference that is found.
class Comparer {
 public:
  Comparer(const std::string& path_a, const std::string& path_b) : path_a_(path_a), path_b_(path_b) {}

  Comparison compare() {
    const auto a = Hdf5File::open(path_a_, Seal::if_any), b = Hdf5File::open(path_b_, Seal::if_any);
    for (const auto* file : {&a, &b}) {
      if (!is_rvelab(*file)) continue;
      file->expect_seal();
      checked_kind(*file);
    }
    const auto &in_a = a.tree().objects, &in_b = b.tree().objects;
    auto names = names_in(in_a);
    names.merge(names_in(in_b));
    for (auto name = names.begin(); name != names.end() && !result_.difference; ++name) {
      if (name->starts_with("/provenance/") || *name == "/provenance") continue;
      const auto at_a = in_a.find(*name), at_b = in_b.find(*name);
      if (at_a == in_a.end() || at_b == in_b.end())
        found(*name + " is in " + (at_a == in_a.end() ? path_b_ : path_a_) + " only");
      else
        objects(*name, at_a->second, at_b->second);
    }
    return result_;
  }

 private:
  template <class Value>
  static std::set<std::string> names_in(const std::map<std::string, Value>& map) {
    std::set<std::string> names;
    for (const auto& [name, value] : map) names.insert(name);
    return names;
  }

  void found(const std::string& difference) {
    if (!result_.difference) result_.difference = difference;
  }

  void differ(const std::string& what, const std::string& in_a, const std::string& in_b) {
    found(what + ": " + in_a + " in " + path_a_ + ", " + in_b + " in " + path_b_);
  }

  void objects(const std::string& name, const hdf5::Object& a, const hdf5::Object& b) {
    const auto kind = [](const hdf5::Object& object) { return object.dataset ? "dataset" : "group"; };
    if (a.dataset.has_value() != b.dataset.has_value())
      return found(name + " is a " + kind(a) + " in " + path_a_ + " and a " + kind(b) + " in " + path_b_);
    const auto whose = [&](const std::string& attribute) { return "attribute " + attribute + " of " + name; };
    for (const auto& [attribute, value] : a.attributes) {
      const auto other = b.attributes.find(attribute);
      if (other == b.attributes.end())
        found(whose(attribute) + " is in " + path_a_ + " only");
      else
        values(whose(attribute), value, other->second);
    }
    for (const auto& [attribute, value] : b.attributes) {
      if (!a.attributes.contains(attribute)) found(whose(attribute) + " is in " + path_b_ + " only");
    }
    if (!a.dataset || result_.difference) return;
    values(name, *a.dataset, *b.dataset);
    if (!result_.difference) ++result_.datasets;
  }

  void values(const std::string& what, const hdf5::Values& a, const hdf5::Values& b) {
    const auto is_text = [](const hdf5::Values& each) { return each.type.kind == hdf5::Kind::text; };
    if (hdf5::name(a.type) != hdf5::name(b.type))
      return differ(what + " has another type", hdf5::name(a.type), hdf5::name(b.type));
    if (a.shape != b.shape) return differ(what + " has another shape", in_words(a.shape), in_words(b.shape));
    if (is_text(a)) {
      const auto texts_a = texts_in(a), texts_b = texts_in(b);
      for (std::size_t k = 0; k < texts_a.size(); ++k) {
        if (texts_a[k] != texts_b[k])
          return differ(what + index_in_words(k, a.shape) + " differs", quoted(texts_a[k]), quoted(texts_b[k]));
      }
      return;
    }
    const std::size_t size = a.type.bytes;
    for (std::size_t at = 0; at < a.bytes.size(); at += size) {
      const std::byte *in_a = a.bytes.data() + at, *in_b = b.bytes.data() + at;
      if (std::memcmp(in_a, in_b, size) == 0) continue;
      const std::string type = hdf5::name(a.type);
      std::string text_a = value_in_words(type, in_a, size), text_b = value_in_words(type, in_b, size);
      if (text_a == text_b) {  // NaNs of different bits
        text_a += " (" + as_bytes(in_a, size) + ")";
        text_b += " (" + as_bytes(in_b, size) + ")";
      }
      return differ(what + index_in_words(at / size, a.shape) + " differs", text_a, text_b);
    }
  }

  const std::string &path_a_, &path_b_;
  Comparison result_;
};

}  // namespace

Comparison compare_files(const std::string& path_a, const std::string& path_b) {
  return Comparer(path_a, path_b).compare();
}

}  // namespace rvelab::io
