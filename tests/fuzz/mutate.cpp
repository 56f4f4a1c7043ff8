#include "tests/fuzz/mutate.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace rvelab::fuzz {
namespace {

constexpr std::string_view edge_numerals[] = {"0",
                                              "-0",
                                              "1",
                                              "-1",
                                              "2",
                                              "1e308",
                                              "-1e308",
                                              "5e-324",
                                              "1e-308",
                                              "1e80",
                                              "1e-80",
                                              "1e160",
                                              "nan",
                                              "inf",
                                              "-inf",
                                              "2147483648",
                                              "4294967296",
                                              "9223372036854775807",
                                              "-9223372036854775808",
                                              "18446744073709551616",
                                              "1e9",
                                              "1e999",
                                              "0.1",
                                              "0.9999999",
                                              "1_000",
                                              "0x10",
                                              "1e6",
                                              "1e-6"};
constexpr std::string_view oddities[] = {"true",
                                         "false",
                                         "\"\"",
                                         "\"x\"",
                                         "[]",
                                         "[[]]",
                                         "{}",
                                         "null",
                                         "\xff",
                                         std::string_view("\0", 1),
                                         "\n",
                                         "\r\n",
                                         "\"",
                                         "'",
                                         "\"\"\"",
                                         "=",
                                         ",",
                                         ";",
                                         "#",
                                         ".",
                                         "[",
                                         "]",
                                         "{",
                                         "}",
                                         "[1, 2]",
                                         "1979-05-27",
                                         "\xef\xbb\xbf",
                                         "====\n",
                                         "\t",
                                         "\\u0000"};

class Mutation {
 public:
  Mutation(Bytes& input, const std::vector<Bytes>& seeds, std::mt19937_64& random)
      : input_(input), seeds_(seeds), random_(random) {}

  void of_bytes() {
    switch (below(7)) {
      case 0:
      case 1:
        if (!input_.empty()) input_[below(input_.size())] ^= std::byte(1u << below(8));
        return;
      case 2:
        if (!input_.empty()) input_[below(input_.size())] = std::byte(below(256));
        return;
      case 3:
        return input_.resize(below(input_.size() + 1));
      case 4:
        return splice();
      case 5: {
        const auto [begin, end] = range();
        return replace(begin, end, {});
      }
      default:
        return write_integer();
    }
  }

  void of_text() {
    switch (below(8)) {
      case 0: {  // a line twice
        const auto [begin, end] = line();
        const Bytes copy(input_.begin() + begin, input_.begin() + end);
        return replace(begin, begin, copy);
      }
      case 1: {  // a line gone
        const auto [begin, end] = line();
        return replace(begin, end, {});
      }
      case 2:
        return exchange(line(), line());
      case 3:
        return exchange(word(), word());
      case 4:
      case 5: {
        const auto [begin, end] = number();
        return replace(begin, end, bytes_of(edge_numerals[below(std::size(edge_numerals))]));
      }
      case 6: {
        const auto [begin, end] = below(2) == 0 ? word() : number();
        return replace(begin, end, bytes_of(oddities[below(std::size(oddities))]));
      }
      default: {
        const auto at = static_cast<long>(below(input_.size() + 1));
        return replace(at, at, bytes_of(oddities[below(std::size(oddities))]));
      }
    }
  }

 private:
  using Range = std::pair<long, long>;

  std::size_t below(std::size_t number) { return random_() % number; }

  static Bytes bytes_of(std::string_view text) {
    const View bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
  }

  void replace(long begin, long end, const Bytes& by) {
    input_.erase(input_.begin() + begin, input_.begin() + end);
    input_.insert(input_.begin() + begin, by.begin(), by.end());
  }

  Range range() {
    const auto begin = static_cast<long>(below(input_.size() + 1));
    const auto most = std::min<std::size_t>(input_.size() - static_cast<std::size_t>(begin), 64);
    return {begin, begin + static_cast<long>(below(most + 1))};
  }

  /// The characters of one kind around a random place, or after it.
  template <class Is>
  Range all_that(Is is) {
    const auto size = static_cast<long>(input_.size());
    auto begin = static_cast<long>(below(input_.size() + 1));
    while (begin < size && !is(at(begin))) ++begin;
    long end = begin;
    while (begin > 0 && is(at(begin - 1))) --begin;
    while (end < size && is(at(end))) ++end;
    return {begin, end};
  }
  char at(long place) const { return static_cast<char>(input_[static_cast<std::size_t>(place)]); }

  Range number() {
    return all_that([](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == 'e'; });
  }
  Range word() {
    return all_that([](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; });
  }
  Range line() {
    Range found = all_that([](char c) { return c != '\n'; });
    if (found.second < static_cast<long>(input_.size())) ++found.second;
    return found;
  }

  void exchange(Range a, Range b) {
    if (b < a) std::swap(a, b);
    if (a.second > b.first) return;
    const Bytes first(input_.begin() + a.first, input_.begin() + a.second),
        second(input_.begin() + b.first, input_.begin() + b.second);
    replace(b.first, b.second, first);
    replace(a.first, a.second, second);
  }

  /// The start of this input and the end of another.
  void splice() {
    const Bytes& other = seeds_[below(seeds_.size())];
    const std::size_t from = below(other.size() + 1);
    const std::size_t most = std::min<std::size_t>(other.size() - from, 1 << below(17));
    const auto [begin, end] = range();
    replace(begin, end, Bytes(other.begin() + static_cast<long>(from), other.begin() + static_cast<long>(from + most)));
  }

  /// Lengths and counts are stored in four or eight bytes.
  void write_integer() {
    const std::size_t bytes = below(2) == 0 ? 4 : 8;
    if (input_.size() < bytes) return;
    const std::uint64_t value = below(3) == 0 ? below(256) : ~std::uint64_t{0} >> below(64);
    std::memcpy(input_.data() + below(input_.size() - bytes + 1), &value, bytes);
  }

  Bytes& input_;
  const std::vector<Bytes>& seeds_;
  std::mt19937_64& random_;
};

}  // namespace

void change(Bytes& input, const std::vector<Bytes>& seeds, bool is_text, std::mt19937_64& random) {
  Mutation mutation(input, seeds, random);
  if (is_text && random() % 4 != 0) return mutation.of_text();
  mutation.of_bytes();
}

Bytes mutated(const std::vector<Bytes>& seeds, bool is_text, std::mt19937_64& random) {
  Bytes input = seeds[random() % seeds.size()];
  const std::uint64_t changes = std::uint64_t{1} << random() % 4;
  for (std::uint64_t k = 0; k < changes; ++k) change(input, seeds, is_text, random);
  return input;
}

}  // namespace rvelab::fuzz
