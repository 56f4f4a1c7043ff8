// Scenes of tests: their tables in short, models of them, and what is said of one that is refused.
#pragma once

#include <fstream>
#include <memory>

#include "tests/catch.hpp"
#include "tests/folder.hpp"
#include "tools/mpm/setup/setup.hpp"

namespace mpm::test {

// Tables of a scene; values as TOML has them. `more`: lines of further keys.

inline std::string head(const std::string& name, const std::string& cell, const std::string& duration, int d = 2,
                        const std::string& more = "") {
  return "[scene]\nname = \"" + name + "\"\ndimension = " + std::to_string(d) + "\n" + more +
         "[grid]\ncell_m = " + cell + "\n[time]\nduration_s = " + duration + "\n";
}
inline std::string soil_of(const std::string& name, const std::string& kind, const std::string& density,
                           const std::string& modulus, const std::string& more = "") {
  return "[[material]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\ndensity_kg_m3 = " + density +
         "\nyoung_modulus_Pa = " + modulus + "\n" + more;
}
inline std::string region(const std::string& material, const std::string& lower, const std::string& upper,
                          const std::string& more = "") {
  return "[[region]]\nmaterial = \"" + material + "\"\nlower_m = " + lower + "\nupper_m = " + upper + "\n" + more;
}
inline std::string boundary(const std::string& name, const std::string& kind, const std::string& axis,
                            const std::string& at, const std::string& more = "") {
  return "[[boundary]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\naxis = \"" + axis + "\"\nat_m = " + at +
         "\n" + more;
}
inline const std::string below = "soil = \"below\"\n";
inline std::string half_space(const std::string& name, const std::string& centre, const std::string& normal,
                              const std::string& more = "") {
  return "[[body]]\nname = \"" + name + "\"\nkind = \"half_space\"\ncentre_m = " + centre + "\nnormal = " + normal +
         "\n" + more;
}
inline std::string box_body(const std::string& name, const std::string& centre, const std::string& size,
                            const std::string& more = "") {
  return "[[body]]\nname = \"" + name + "\"\nkind = \"box\"\ncentre_m = " + centre + "\nsize_m = " + size + "\n" + more;
}
inline std::string basalt(const std::string& modulus = "1e8") {
  return "[[rock_material]]\nname = \"basalt\"\ndensity_kg_m3 = 2700\nyoung_modulus_Pa = " + modulus + "\n";
}
/// Of basalt, a sphere unless `more` says otherwise.
inline std::string rock(const std::string& name, const std::string& centre, const std::string& more) {
  return "[[rock]]\nname = \"" + name + "\"\nmaterial = \"basalt\"\ncentre_m = " + centre + "\n" + more;
}
inline std::string rocks(const std::string& name, const std::string& more) {
  return "[[rocks]]\nname = \"" + name + "\"\nmaterial = \"basalt\"\n" + more;
}
/// A scene of rocks alone; D = 2: the plane.
inline std::string rocks_alone(int d, const std::string& rocks) {
  return head("alone", "0.1", "0.5", d) + "[loads]\ngravity_m_s2 = " + (d == 2 ? "[0, -10]" : "[0, 0, -10]") + "\n" +
         basalt("1e7") + rocks;
}

// What is made of a scene.

/// How a scene differs: assignments; in its text `from` replaced by `to`; files beside it by name.
struct Change {
  std::vector<std::string> assignments = {};
  std::string from = "", to = "";
  std::vector<std::pair<std::string, std::string>> files = {};
};
inline Change set(const std::string& assignment) { return {{assignment}}; }
inline Change set(std::initializer_list<std::string> assignments) { return {assignments}; }
inline Change edit(const std::string& from, const std::string& to) { return {{}, from, to}; }

inline std::string edited(std::string text, const std::string& from, const std::string& to) {
  CAPTURE(from);
  REQUIRE(text.find(from) != std::string::npos);
  return text.replace(text.find(from), from.size(), to);
}

inline Scene scene_of(const std::string& text, const Change& change, const rvelab::test::Folder& folder) {
  std::ofstream(folder / "scene.toml") << (change.from.empty() ? text : edited(text, change.from, change.to));
  for (const auto& [name, content] : change.files) std::ofstream(folder / name) << content;
  return read_scene(folder / "scene.toml", {}, change.assignments);
}

template <int D>
std::unique_ptr<Model<D>> model_of(const std::string& text, const Change& change = {}) {
  const rvelab::test::Folder folder;
  return set_up<D>(scene_of(text, change, folder), 1, folder.path());
}

/// What is said of a scene that is refused when it is read or set up, or in `steps` steps; "accepted".
inline std::string outcome(const std::string& text, const Change& change = {}, int steps = 0) {
  const rvelab::test::Folder folder;
  const auto try_in = [&](auto dimension, const Scene& scene) {
    const auto model = set_up<decltype(dimension)::value>(scene, 1, folder.path());
    for (int k = 0; k < steps; ++k) model->solver.step(model->solver.stable_step());
  };
  try {
    const auto scene = scene_of(text, change, folder);
    if (scene.dimension == 2) {
      try_in(std::integral_constant<int, 2>(), scene);
    } else {
      try_in(std::integral_constant<int, 3>(), scene);
    }
  } catch (const InputError& mistake) {
    return mistake.what();
  }
  return "accepted";
}

/// A change, and words of what is said of it: the key, the value, a word of the remedy; "accepted".
struct Said {
  Change change;
  std::vector<std::string> words;
};
inline void expect_said(const std::string& scene, const std::vector<Said>& cases, int steps = 0) {
  for (const auto& [change, words] : cases) {
    CAPTURE(change.assignments, change.from, change.to);
    const auto said = outcome(scene, change, steps);
    for (const auto& word : words) CHECK_THAT(said, Catch::Matchers::Contains(word));
  }
}

}  // namespace mpm::test
