// The ways of a call in rvelab/solver/README.md are those of the code: each function of a list is defined in the file
// that the list names, and calls those that stand below it, one step further in, in their order.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.hpp"

namespace {

const std::filesystem::path sources = RVELAB_SOURCE_DIR;

struct Step {
  std::size_t depth;
  std::string function, file;
};

/// The rows "- `function`, file: what" of a text.
std::vector<Step> steps_in(const std::string& text) {
  std::vector<Step> steps;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto begin = line.find_first_not_of(' ');
    if (begin == std::string::npos || line.compare(begin, 3, "- `") != 0) continue;
    const auto end = line.find("`, ", begin);
    if (end == std::string::npos) continue;
    const std::string file = line.substr(end + 3, line.find(':', end) - end - 3);
    steps.push_back({begin / 2, line.substr(begin + 3, end - begin - 3), file});
  }
  return steps;
}

std::string last_name(const std::string& function) {
  const auto colons = function.rfind("::");
  return colons == std::string::npos ? function : function.substr(colons + 2);
}

/// Behind the bracket that closes the one at `open`; npos without.
std::size_t behind_bracket(const std::string& code, std::size_t open) {
  const char opening = code[open], closing = opening == '(' ? ')' : '}';
  int depth = 0;
  for (std::size_t k = open; k < code.size(); ++k) {
    if (code[k] == opening) ++depth;
    if (code[k] == closing && --depth == 0) return k + 1;
  }
  return std::string::npos;
}

/// Where `name(` stands as a whole word, from `from` on; npos: nowhere.
std::size_t call_of(const std::string& code, const std::string& name, std::size_t from = 0) {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (auto at = code.find(name + "(", from); at != std::string::npos; at = code.find(name + "(", at + 1))
    if (at == 0 || !in_word(code[at - 1])) return at;
  return std::string::npos;
}

/// The bodies of the functions of that name in the code of a file; of a class where its name stands before: "" without.
std::string body_of(const std::string& function, const std::string& code) {
  std::string name = function;
  std::size_t from = 0;
  if (call_of(code, name) == std::string::npos && function.find("::") != std::string::npos) {
    name = last_name(function);  // defined in its class
    from = code.find("class " + function.substr(0, function.find("::")) + " {");
    if (from == std::string::npos) return "";
  }
  std::string bodies;
  for (auto at = call_of(code, name, from); at != std::string::npos; at = call_of(code, name, at + 1)) {
    auto next = behind_bracket(code, at + name.size());
    for (const char* word : {" const", " noexcept"})
      if (next != std::string::npos && code.compare(next, std::string(word).size(), word) == 0)
        next += std::string(word).size();
    if (next == std::string::npos || code.compare(next, 2, " {") != 0) continue;
    bodies += code.substr(next, behind_bracket(code, next + 1) - next);
  }
  return bodies;
}

/// What does not hold of a list, with the code of each file.
std::vector<std::string> broken(const std::vector<Step>& steps, const std::map<std::string, std::string>& code) {
  std::vector<std::string> found;
  std::vector<std::string> bodies;   // of the step and those that it is below
  std::vector<std::size_t> reached;  // in each of these bodies, by the calls listed so far
  for (const Step& step : steps) {
    const auto file = code.find(step.file);
    const std::string body = file == code.end() ? "" : body_of(step.function, file->second);
    if (body.empty()) found.push_back(step.function + " is not defined in " + step.file);
    if (step.depth > bodies.size()) {
      found.push_back(step.function + " stands below nothing");
      continue;
    }
    bodies.resize(step.depth);
    reached.resize(step.depth);
    if (!bodies.empty()) {
      const auto call = call_of(bodies.back(), last_name(step.function), reached.back());
      if (call == std::string::npos) found.push_back(step.function + " is not called there by what it stands below");
      if (call != std::string::npos) reached.back() = call + 1;
    }
    bodies.push_back(body);
    reached.push_back(0);
  }
  return found;
}

}  // namespace

TEST_CASE("a list of calls that is not that of the code is seen") {
  const std::map<std::string, std::string> code = {
      {"a.cpp", "int load(int x);\nint apply(int x) {\n  if (x > 0) { return 0; }\n  return load(x);\n}\n"},
      {"b.cpp",
       "class Steps {\n  int make() const { return reload(1); }\n};\nint load(int x) {\n  return "
       "Steps{}.make();\n}\n"}};
  const auto list = [](const std::string& apply, const std::string& load, const std::string& make) {
    return steps_in("text\n- `" + apply + "`, a.cpp: first\n  - `" + load + "`, b.cpp\n    - `" + make +
                    "`, b.cpp: last\n\n- a point of another list\n");
  };
  const auto good = list("apply", "load", "Steps::make");
  REQUIRE(good.size() == 3);
  CHECK(good[2].depth == 2);
  CHECK(good[2].file == "b.cpp");
  CHECK(broken(good, code).empty());
  CHECK(!broken(list("apply_", "load", "Steps::make"), code).empty());  // names
  CHECK(!broken(list("apply", "reload", "Steps::make"), code).empty());
  CHECK(!broken(list("apply", "load", "Other::make"), code).empty());
  CHECK(!broken(steps_in("- `load`, a.cpp\n"), code).empty());  // declared there, not defined
  CHECK(!broken(steps_in("- `load`, b.cpp\n  - `apply`, a.cpp\n"), code).empty());
  CHECK(!broken(steps_in("- `apply`, a.cpp\n    - `load`, b.cpp\n"), code).empty());
  const std::map<std::string, std::string> two = {
      {"a.cpp", "int first() { return 1; }\nint second() { return 2; }\nint both() { return first() + second(); }\n"}};
  CHECK(broken(steps_in("- `both`, a.cpp\n  - `first`, a.cpp\n  - `second`, a.cpp\n"), two).empty());
  CHECK(!broken(steps_in("- `both`, a.cpp\n  - `second`, a.cpp\n  - `first`, a.cpp\n"), two).empty());  // order
}

TEST_CASE("the ways from dH to sigma in the README of the solver are those of the code") {
  const auto text_at = [](const std::filesystem::path& path) {
    std::ifstream input(path);
    return std::string(std::istreambuf_iterator<char>(input), {});
  };
  const auto steps = steps_in(text_at(sources / "rvelab/solver/README.md"));
  for (const char* way : {"rvelab_apply", "load_at_rate", "run_test", "RunningTest::apply"})
    CHECK(std::any_of(steps.begin(), steps.end(), [&](const Step& s) { return s.depth == 0 && s.function == way; }));
  std::map<std::string, std::string> code;
  for (const Step& step : steps) code[step.file] = text_at(sources / step.file);
  for (const std::string& what : broken(steps, code)) FAIL_CHECK(what);
}
