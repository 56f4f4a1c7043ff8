// Messages as the programs print them: on one line, printable, and of what a user wrote 80 letters at most.
#include "rvelab/io/utf8.hpp"

#include "tests/catch.hpp"

using namespace rvelab;

TEST_CASE("a message is one line of letters that can be printed") {
  CHECK(io::message_line("a.toml: first\nb.toml: second\n") == "a.toml: first | b.toml: second");
  CHECK(io::message_line("a\x1b[31mb\xff: there is no such file") == "a\\x1b[31mb\\xff: there is no such file");
  CHECK(io::message_line("Gr\xc3\xa8s  of two  blanks") == "Gr\xc3\xa8s  of two  blanks");
}

TEST_CASE("of a word in a message 80 letters are shown, its begin and its end") {
  std::string word;
  for (int k = 0; k < 9000; ++k) word += "\xc3\xa8";
  const std::string line = io::message_line("x.toml:3: unknown key " + word + "end; the nearest is friction");
  CHECK(io::first_non_utf8(line) == std::string::npos);
  CHECK(line.size() < 300);
  CHECK(line.starts_with("x.toml:3: unknown key \xc3\xa8"));
  CHECK(line.find("\xc3\xa8...\xc3\xa8") != std::string::npos);
  CHECK(line.ends_with("end; the nearest is friction"));
  const std::string eighty(80, 'k');
  CHECK(io::message_line(eighty + " " + eighty) == eighty + " " + eighty);
  CHECK(io::message_line(eighty + "k").size() == 80);
  CHECK(io::message_line(std::string(5000, '\x1b')).size() == 80);
}

TEST_CASE("a word of the command line with blanks is shortened as a whole") {
  std::string argument = "--set";
  while (argument.size() < 9000) argument += " a b";
  const std::string line = io::message_line("--case " + argument + ": is no case", {"x.toml", argument});
  CHECK(line.size() < 120);
  CHECK(line.starts_with("--case --set a b"));
  CHECK(line.ends_with("a b: is no case"));
}
