// Declared in text.hpp.
#include "rvelab/io/import/text.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>

#include "rvelab/error.hpp"
#include "rvelab/io/utf8.hpp"
#include "rvelab/keys/file_format.hpp"
#include "rvelab/keys/regular_file.hpp"

namespace rvelab::io {
namespace {

constexpr std::string_view gzip_magic{"\x1f\x8b", 2};

[[noreturn]] void refuse(const std::string& path, const std::string& what) { throw InputError(path + ": " + what); }

/// zlib's state of one member of a gzip file.
class Inflation {
 public:
  Inflation() {
    constexpr int gzip_only = 16 + MAX_WBITS;
    if (inflateInit2(&stream_, gzip_only) != Z_OK) throw std::bad_alloc();
  }
  ~Inflation() { inflateEnd(&stream_); }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;
  z_stream* operator->() { return &stream_; }
  int inflate_on() { return inflate(&stream_, Z_NO_FLUSH); }

 private:
  z_stream stream_{};
};

/// Appends what one member holds; returns the bytes that it took of `packed`.
std::size_t unpack_member(const std::string& path, std::string_view packed, std::size_t most, std::string& text) {
  Inflation state;
  std::array<char, 1 << 16> block;
  std::size_t taken = 0;
  for (int code = Z_OK; code != Z_STREAM_END;) {
    if (state->avail_in == 0) {
      const auto portion = std::min<std::size_t>(packed.size() - taken, 1 << 20);
      if (portion == 0) refuse(path, "the gzip file ends early; allowed: a whole one; copy or write it again");
      state->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + taken));
      state->avail_in = static_cast<uInt>(portion);
      taken += portion;
    }
    state->next_out = reinterpret_cast<Bytef*>(block.data());
    state->avail_out = block.size();
    code = state.inflate_on();
    if (code == Z_MEM_ERROR) throw std::bad_alloc();
    if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR) {
      refuse(path, "the gzip file is damaged (" + std::string(state->msg != nullptr ? state->msg : "zlib") +
                       "); allowed: one that gzip -t finds right; copy or write it again");
    }
    text.append(block.data(), block.size() - state->avail_out);
    if (text.size() > most) {
      refuse(path, "unpacks to more than " + std::to_string(most) +
                       " bytes; allowed: 64 MiB and 40 times the packed size, which no text exceeds; unpack it "
                       "with gunzip if it is right, and give the unpacked file");
    }
  }
  return taken - state->avail_in;
}

void append_utf8(std::string& text, std::uint32_t letter) {
  if (letter < 0x80) {
    text += char(letter);
    return;
  }
  const int more = letter < 0x800 ? 1 : letter < 0x10000 ? 2 : 3;
  constexpr std::uint32_t first[] = {0, 0xc0, 0xe0, 0xf0};
  text += char(first[more] | letter >> 6 * more);
  for (int k = more - 1; k >= 0; --k) text += char(0x80 | (letter >> 6 * k & 0x3f));
}

std::string utf8_of_utf16(std::string_view text, bool big_end_first) {
  const auto unit = [&](std::size_t at) {
    const auto low = static_cast<unsigned char>(text[at + big_end_first]),
               high = static_cast<unsigned char>(text[at + !big_end_first]);
    return std::uint32_t(high) << 8 | low;
  };
  std::string found;
  for (std::size_t at = 0; at + 1 < text.size(); at += 2) {
    std::uint32_t letter = unit(at);
    if (letter >= 0xd800 && letter < 0xdc00 && at + 3 < text.size()) {
      at += 2;
      letter = 0x10000 + ((letter & 0x3ff) << 10) + (unit(at) & 0x3ff);
    }
    if (letter != 0xfeff) append_utf8(found, letter);
  }
  return found;
}

std::string unpacked(const std::string& path, std::string_view packed) {
  const std::size_t most = (std::size_t{64} << 20) + 40 * packed.size();
  std::string text;
  while (packed.starts_with(gzip_magic)) packed.remove_prefix(unpack_member(path, packed, most, text));
  if (packed.find_first_not_of('\0') != std::string_view::npos) {  // padding is allowed, as gzip allows it
    refuse(path, "other bytes follow the gzip data; allowed: nothing behind it; copy or write the file again");
  }
  return text;
}

}  // namespace

std::string as_utf8(std::string_view text) {
  const auto zeros = [&](std::size_t first) {
    std::size_t count = 0, at = first;
    for (; at < std::min<std::size_t>(text.size(), 200); at += 2) count += text[at] == 0;
    return 2 * count > at / 2;
  };
  std::string found;
  if (text.starts_with("\xff\xfe") || (text.size() > 3 && zeros(1))) {
    found = utf8_of_utf16(text, false);
  } else if (text.starts_with("\xfe\xff") || (text.size() > 3 && zeros(0))) {
    found = utf8_of_utf16(text, true);
  } else if (first_non_utf8(text) != std::string_view::npos) {
    for (const char letter : text) append_utf8(found, static_cast<unsigned char>(letter));
  } else {
    found = text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0);
  }
  if (found.find('\n') == std::string::npos) std::replace(found.begin(), found.end(), '\r', '\n');
  return found;
}

std::string whole_text(const std::string& path, const std::string& wanted) {
  auto text = keys::whole_file<std::string>(path, wanted);
  if (std::string_view(text).starts_with(gzip_magic)) text = unpacked(path, text);
  if (const keys::FileFormat* format = keys::format_of(text))
    refuse(path, std::string("is ") + format->what + "; allowed: text, or text packed by gzip; " + format->remedy);
  return text;
}

}  // namespace rvelab::io
