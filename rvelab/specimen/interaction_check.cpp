#include "rvelab/specimen/interaction_check.hpp"

#include <cmath>
#include <numeric>
#include <type_traits>

namespace rvelab {

namespace {

class InteractionCheck : CheckedSpecimen {
 public:
  explicit InteractionCheck(const CheckedSpecimen& checked) : CheckedSpecimen(checked) {}

  void check() const {
    each_interaction_law([&](auto, auto law) {
      using Law = decltype(law);
      if constexpr (FormsByItself<Law>) check_settings<Law>();
      const auto& items = static_cast<const ListOf<Law>&>(s).items;
      if (!items.empty() && !is_round(s.shape))
        refuse(std::string(Law::name) + " of grains that are not round; allowed: between discs or spheres");
      check_pairs(Law::name, "pair", items);
      for (std::size_t k = 0; k < items.size(); ++k) check_interaction<Law>(items[k], k);
    });
  }

 private:
  /// The parameters from which interactions of a law form.
  template <class Law>
  void check_settings() const {
    const auto& rows = static_cast<const SettingsOf<Law>&>(s).settings;
    const std::string name = Law::settings_name;
    if (rows.empty() && !static_cast<const ListOf<Law>&>(s).items.empty())
      refuse(std::string(Law::name) + " without " + name + "; allowed: with one row of " + name +
             ", the parameters from which they form");
    if (rows.size() > 1)
      refuse(name + " has " + std::to_string(rows.size()) + " rows; allowed: none, or one for all grains");
    if (rows.empty()) return;
    if (!is_round(s.shape)) refuse(name + " between grains that are not round; allowed: between discs or spheres");
    const bool hertz = with_law(s.contact.law, [](auto law) { return decltype(law)::Force::is_hertz; });
    const double mean = std::accumulate(s.grains.radius.begin(), s.grains.radius.end(), 0.0) / double(s.grains.size());
    if (const double reach = Law::reach(rows.front()); reach > mean)
      refuse(name + " makes grains act on one another up to a gap of " + in_words(reach) +
             " m; allowed: up to their mean radius, " + in_words(mean) + " m");
    const char* misfit = Law::misfit(rows.front(), {s.cell.dimension, hertz});
    if (misfit == nullptr) return;
    std::string values;
    for (const auto& field : Law::settings_fields)
      values += (values.empty() ? "" : ", ") + name + "/" + field.name + " = " + in_words(rows.front().*field.value);
    refuse(values + "; allowed: " + misfit);
  }

  /// Numbers that encode a state are whole; stored interactions are present; an active one has about its initial
  /// length. Otherwise its image is wrong, and it would tear the grains apart in one step.
  template <class Law>
  void check_interaction(const Interaction<Law>& item, std::size_t k) const {
    double columns[interaction_columns<Law>()];
    put_columns<Law>(item, columns);
    const auto column = [&](int number) { return columns[number]; };
    each_field<Law>(item, [&](const InteractionField& field, const auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
        if (!field.whole) return;
        const bool presence = field.allowed.high == 1;  // files contain only present interactions
        if (presence ? value != 1 : value != std::floor(value))
          refuse(at(std::string(Law::name) + "/" + field.name, k) + " = " + in_words(value) +
                 " is out of range; allowed: " + (presence ? "1, of what is there" : "a whole number"));
      }
    });
    const double radii = s.grains.radius[std::size_t(item.i)] + s.grains.radius[std::size_t(item.j)];
    const Vector3 branch = s.grains.position[std::size_t(item.j)] + translation(s.cell, item.image) -
                           s.grains.position[std::size_t(item.i)];
    const double now = branch.stableNorm();
    const auto check_length = [&](const char* field, double value, double made) {
      if (now > 10 * made || made > 10 * now)
        refuse(at(std::string(Law::name) + "/" + field, k) + " = " + in_words(value) + " of a pair whose centres are " +
               in_words(now) +
               " m apart; allowed: a distance as it was made of a tenth to ten times that, of what still acts");
    };
    if (!Law::acts(column, now - radii)) return;
    if constexpr (requires { Law::length; }) check_length("length_m", columns[Law::length], columns[Law::length]);
    if constexpr (requires { Law::first_gap; })
      check_length("gap_m", columns[Law::first_gap], columns[Law::first_gap] + radii);
  }
};

}  // namespace

void check_interactions(const CheckedSpecimen& checked) { InteractionCheck(checked).check(); }

}  // namespace rvelab
