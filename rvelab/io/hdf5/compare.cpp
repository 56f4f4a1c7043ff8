#include "rvelab/io/hdf5/compare.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <iterator>

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

class Comparer {
 public:
  Comparer(const std::string& path_a, const std::string& path_b) : path_a_(path_a), path_b_(path_b) {}

  Comparison compare() {
    const auto a = Hdf5File::open(path_a_), b = Hdf5File::open(path_b_);
    for (const auto* file : {&a, &b}) {
      if (is_rvelab(*file)) checked_kind(*file);
    }
    const auto objects_a = compared(a), objects_b = compared(b);
    for (auto in_a = objects_a.begin(), in_b = objects_b.begin(); in_a != objects_a.end() || in_b != objects_b.end();) {
      if (in_b == objects_b.end() || (in_a != objects_a.end() && in_a->first < in_b->first)) {
        found(in_a->first + " is in " + path_a_ + " only");
      } else if (in_a == objects_a.end() || in_b->first < in_a->first) {
        found(in_b->first + " is in " + path_b_ + " only");
      } else if (in_a->second.is_dataset != in_b->second.is_dataset) {
        found(in_a->first + " is a " + (in_a->second.is_dataset ? "dataset" : "group") + " in " + path_a_ + " and a " +
              (in_b->second.is_dataset ? "dataset" : "group") + " in " + path_b_);
      } else {
        attributes(in_a->second, in_b->second);
        if (in_a->second.is_dataset && !result_.difference) {
          values(in_a->first, a.stored(in_a->first), b.stored(in_a->first));
          if (!result_.difference) ++result_.datasets;
        }
      }
      if (result_.difference) break;
      ++in_a;
      ++in_b;
    }
    return result_;
  }

 private:
  using Objects = std::map<std::string, Hdf5Object>;

  static Objects compared(const Hdf5File& file) {
    Objects objects;
    for (auto& object : file.objects()) {
      const bool provenance = object.name == "/provenance" || object.name.starts_with("/provenance/");
      if (!provenance) objects.emplace(object.name, std::move(object));
    }
    return objects;
  }

  void found(const std::string& difference) {
    if (!result_.difference) result_.difference = difference;
  }

  void differ(const std::string& what, const std::string& in_a, const std::string& in_b) {
    found(what + ": " + in_a + " in " + path_a_ + ", " + in_b + " in " + path_b_);
  }

  void attributes(const Hdf5Object& a, const Hdf5Object& b) {
    const auto whose = [&](const std::string& name) { return "attribute " + name + " of " + a.name; };
    for (const auto& [name, value] : a.attributes) {
      const auto other = b.attributes.find(name);
      if (other == b.attributes.end()) {
        found(whose(name) + " is in " + path_a_ + " only");
      } else {
        values(whose(name), value, other->second);
      }
    }
    for (const auto& [name, value] : b.attributes) {
      if (!a.attributes.contains(name)) found(whose(name) + " is in " + path_b_ + " only");
    }
  }

  void values(const std::string& what, const StoredValues& a, const StoredValues& b) {
    if (a.type != b.type) return differ(what + " has another type", a.type, b.type);
    if (a.shape != b.shape) return differ(what + " has another shape", in_words(a.shape), in_words(b.shape));
    for (std::size_t k = 0; k < a.texts.size(); ++k) {
      if (a.texts[k] != b.texts[k]) {
        return differ(what + index_in_words(k, a.shape) + " differs", quoted(a.texts[k]), quoted(b.texts[k]));
      }
    }
    if (a.bytes == b.bytes) return;
    std::size_t number = 1;
    for (const auto extent : a.shape) number *= extent;
    const std::size_t size = a.bytes.size() / number;
    std::size_t k = 0;
    while (std::memcmp(a.bytes.data() + k * size, b.bytes.data() + k * size, size) == 0) ++k;
    const std::byte *in_a = a.bytes.data() + k * size, *in_b = b.bytes.data() + k * size;
    std::string text_a = value_in_words(a.type, in_a, size), text_b = value_in_words(b.type, in_b, size);
    if (text_a == text_b) {  // NaNs of different bits
      text_a += " (" + as_bytes(in_a, size) + ")";
      text_b += " (" + as_bytes(in_b, size) + ")";
    }
    differ(what + index_in_words(k, a.shape) + " differs", text_a, text_b);
  }

  const std::string &path_a_, &path_b_;
  Comparison result_;
};

}  // namespace

Comparison compare_files(const std::string& path_a, const std::string& path_b) {
  return Comparer(path_a, path_b).compare();
}

}  // namespace rvelab::io
