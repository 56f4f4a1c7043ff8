// Tables as spreadsheets and other programs write them: byte order mark, semicolons, decimal commas, quotation marks,
// capitals, CRLF; and bytes that are no text.
#include "rvelab/io/import/csv_table.hpp"

#include "rvelab/io/utf8.hpp"
#include "tests/catch.hpp"
#include "tests/refusal.hpp"

using namespace rvelab;
using Catch::Matchers::Contains;

namespace {

/// Two grains, whatever the dress.
void expect_two_grains(const std::string& text) {
  CAPTURE(text);
  const io::CsvTable table("grains.csv", text);
  REQUIRE(table.rows() == 2);
  CHECK(table.integer(1, table.column({"id"})) == 2);
  CHECK(table.number(0, table.column({"x"})) == 0.25);
  CHECK(table.number(1, table.column({"x"})) == -1.5e-3);
  CHECK(table.number(1, table.column({"r", "radius"})) == 0.5);
  CHECK(!table.has("z"));
}

std::string message_of(const std::string& text) {
  return test::input_error([&] {
    const io::CsvTable table("grains.csv", text);
    for (std::size_t row = 0; row < table.rows(); ++row) static_cast<void>(table.number(row, table.column({"x"})));
  });
}

}  // namespace

TEST_CASE("a table reads the same with a byte order mark, semicolons, quotation marks, capitals and CRLF") {
  expect_two_grains("id,x,radius\n1,0.25,0.5\n2,-1.5e-3,0.5\n");
  expect_two_grains("\xef\xbb\xbfid,x,radius\n1,0.25,0.5\n2,-1.5e-3,0.5\n");
  expect_two_grains("id;x;radius\n1;0.25;0.5\n2;-1.5e-3;0.5\n");
  expect_two_grains("\xef\xbb\xbf\"id\";\"x\";\"radius\"\r\n\"1\";\"0,25\";\"0,5\"\r\n2;-1,5e-3;0,5\r\n");
  expect_two_grains("ID,X,Radius\n1,0.25,0.5\n2,-1.5e-3,0.5\n");
  expect_two_grains("# made by hand\n\n \"ID\" , \"X\" ,R\r\n\"1\" , 0.25,0.5\r\n\r\n2,\"-1.5e-3\",+0.5");
}

TEST_CASE("a cell in quotation marks may hold the delimiter and doubled marks") {
  const io::CsvTable table("t.csv", "id,x,material\n1,2,\"glass, \"\"fine\"\"\"\n");
  CHECK(table.text(0, table.column({"material"})) == "glass, \"fine\"");
  CHECK_THAT(message_of("id,x\n1,\"2\n"), Contains("grains.csv:2: a quotation mark is not closed"));
  CHECK_THAT(message_of("id,x\n1,\"2\"3\n"), Contains("grains.csv:2: text follows a closing quotation mark"));
}

TEST_CASE("what could be read in two ways is refused") {
  CHECK_THAT(message_of("id;x\n1;1.000,5\n"), Contains("x = 1.000,5 is not a finite number"));
  CHECK_THAT(message_of("id,x\n1,0,5\n"), Contains("the row has 3 cells"));
  CHECK_THAT(message_of("id,X,x\n1,0,5\n"), !Contains("columns"));  // the name as it is goes first
  CHECK_THAT(message_of("id,X,X\n1,0,5\n"), Contains("the column X twice"));
  const io::CsvTable two("t.csv", "id,Radius,RADIUS\n1,2,3\n");
  CHECK_THROWS_WITH(two.column({"radius"}), Contains("has the columns Radius and RADIUS"));
}

TEST_CASE("bytes that are no UTF-8 are refused with their line, and shown as what they are") {
  CHECK(message_of("id,x\n1,2\xd3\x84\xd7\n") ==
        "grains.csv:2: holds the byte \\xd7, which is no UTF-8; allowed: text in UTF-8; save the file so, or give one "
        "that is undamaged");
  CHECK_THAT(message_of("\xff\xfei\0d\0"), Contains("grains.csv:1: holds the byte \\xff"));
  CHECK(message_of("id,x,Gr\xc3\xb6\xc3\x9f"
                   "e\n1,2,3\n")
            .empty());
  CHECK(message_of("# Latin-1: gr\xf6\xdf"
                   "er\nid,x\n1,2\n")
            .empty());  // a comment is not read
}

TEST_CASE("printable text is UTF-8 without control characters") {
  CHECK(io::printable("p = 20 kPa, \xcf\x86 = 30\xc2\xb0") == "p = 20 kPa, \xcf\x86 = 30\xc2\xb0");
  CHECK(io::printable("a\x1b[31m\n\x7f") == "a\\x1b[31m\\x0a\\x7f");
  // Stray continuation, cut off, overlong, surrogate, beyond U+10FFFF.
  for (const char* bad : {"\x80", "\xe2\x82", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff"}) {
    CAPTURE(io::printable(bad));
    CHECK(io::first_non_utf8(bad) == 0);
    CHECK(io::first_non_utf8(io::printable(bad)) == std::string::npos);
    CHECK(io::printable(bad).starts_with("\\x"));
  }
}
