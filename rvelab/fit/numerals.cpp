#include "rvelab/fit/numerals.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "rvelab/io/import/text.hpp"

namespace rvelab::fit {
namespace {

constexpr const char* digits = "0123456789";

/// The cell with an apostrophe for each blank or apostrophe that may group digits, and '-' for a minus sign.
std::string plain(std::string_view cell) {
  std::string text(cell);
  const auto replace = [&](std::string_view from, char to) {
    for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
      text.replace(at, from.size(), 1, to);
  };
  for (const char* blank : {" ", "\xc2\xa0", "\xe2\x80\xaf", "\xe2\x80\x89", "\xe2\x80\x99"}) replace(blank, '\'');
  replace("\xe2\x88\x92", '-');
  return text;
}

/// "1,234", "12,345,678": up to three digits, then groups of three.
bool is_grouped(std::string_view whole, char mark) {
  auto end = whole.find(mark);
  if (end == 0 || end > 3 || whole.find_first_not_of(digits) != end || whole[0] == '0') return false;
  for (whole.remove_prefix(end); !whole.empty(); whole.remove_prefix(4))
    if (whole[0] != mark || whole.size() < 4 || whole.substr(1, 3).find_first_not_of(digits) != std::string_view::npos)
      return false;
  return true;
}

std::optional<double> value_of(std::string text) {
  double value = 0;
  if (!io::parsed(std::string_view(text), value) || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Numeral> numeral(std::string_view cell) {
  const std::string text = plain(cell);
  const std::size_t begin = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const std::size_t end = std::min(text.find_first_of("eE", begin), text.size());
  const std::string sign = text.substr(0, begin), body = text.substr(begin, end - begin), power = text.substr(end);
  if (body.find_first_not_of("0123456789.,'") != std::string::npos || body.find_first_of(digits) == std::string::npos)
    return std::nullopt;
  Numeral found;
  const auto count = [&](char mark) { return std::count(body.begin(), body.end(), mark); };
  const auto last = body.find_last_of(".,");
  if (last != std::string::npos && count(body[last]) == 1) found.mark = body[last];
  for (const char mark : {'.', ',', '\''})
    if (mark != found.mark && count(mark) > 0) {
      if (found.groups != 0) return std::nullopt;
      found.groups = mark;
    }
  const auto point = found.mark == 0 ? body.size() : last;
  std::string whole = body.substr(0, point);
  if (found.groups != 0 && !is_grouped(whole, found.groups)) return std::nullopt;
  std::erase(whole, found.groups);
  const auto value = value_of(sign + whole + (found.mark == 0 ? "" : "." + body.substr(point + 1)) + power);
  if (!value) return std::nullopt;
  found.value = *value;
  if (found.mark == 0 && (found.groups == ',' || found.groups == '.')) found.mark = found.groups == ',' ? '.' : ',';
  found.certain = found.mark != 0 && (found.groups != 0 || !power.empty() || !is_grouped(body, found.mark));
  if (found.mark != 0 && !found.certain) found.grouped = *value_of(sign + whole + body.substr(point + 1));
  return found;
}

}  // namespace rvelab::fit
