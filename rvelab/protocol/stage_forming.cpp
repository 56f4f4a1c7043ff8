// Stages that give a specimen what interactions form from (water), change it, or take it away: one kind for each law
// whose interactions form by themselves, with the keys that the law declares. Declared in stage_kinds.hpp.
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "rvelab/error.hpp"
#include "rvelab/interaction/interaction.hpp"
#include "rvelab/interaction/outside.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/protocol/drive.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {
namespace {

using namespace keys;

template <class Law>
struct FormingSettings {
  typename Law::Settings settings;
  bool removed = false;
  std::optional<double> target;
};

/// Pairs that have such an interaction, or get one since they touch; without the stiffness of their contact.
template <class Law>
std::vector<GrainPair> formed_pairs(const Network& net) {
  using Key = std::tuple<std::int32_t, std::int32_t, Image>;
  std::map<Key, const ContactState*> pairs;  // in order: sums have the same bits
  for (const ContactState& contact : net.contacts) pairs[{contact.i, contact.j, contact.image}] = &contact;
  each_interaction_law([&](auto kind, auto law) {
    if constexpr (std::is_same_v<decltype(law), Law>)
      for (const InteractionState& other : net.interactions)
        if (other.kind == kind) pairs[{other.i, other.j, other.image}] = &other;
  });
  std::vector<GrainPair> found;
  for (const auto& [key, pair] : pairs)
    found.push_back({net.grains[std::size_t(pair->i)].radius, net.grains[std::size_t(pair->j)].radius,
                     net.dimension() == 2 ? net.cell.lattice(2, 2) : 0, -pair->overlap, 0});
  return found;
}

/// The same with that stiffness; where no grains touch, two of each radius that do.
template <class Law>
std::vector<GrainPair> pairs_of(const Specimen& specimen, const Network& net) {
  std::vector<GrainPair> pairs = formed_pairs<Law>(net);
  const double thickness = net.dimension() == 2 ? net.cell.lattice(2, 2) : 0;
  if (pairs.empty())
    for (const double radius : specimen.grains.radius) pairs.push_back({radius, radius, thickness, 0, 0});
  if (!with_law(specimen.contact.law, [](auto law) { return decltype(law)::Force::is_hertz; })) return pairs;
  const Material& material = specimen.materials.front();
  for (GrainPair& pair : pairs)
    pair.contact_stiffness = mix(specimen.contact, specimen.damping, material, pair.radius_i, 1, material,
                                 pair.radius_j, 1, grain_section(specimen.shape, pair.radius_i, thickness))
                                 .kn;
  return pairs;
}

template <class Law>
struct Forming : KindOf<FormingSettings<Law>> {
  using Settings = typename Law::Settings;
  using KindOf<FormingSettings<Law>>::stage;

  const char* name() const override { return Law::settings_name; }
  bool takes_events() const override { return false; }

  void read(TableReader& reader, Protocol&) override {
    reader.boolean(Law::removal.name, stage.removed, Law::removal.meaning);
    Settings& settings = stage.settings;
    const char *given = nullptr, *first = nullptr;
    bool allowed = true;
    for (const SettingsField<Settings>& field : Law::settings_fields) {
      double& value = settings.*field.value;
      const double usual = value;
      if (!field.none_at_zero)
        reader.number(field.name, value, field.unit, field.allowed, field.meaning);
      else
        value = reader.optional_number(field.name, field.unit, field.allowed, field.meaning).value_or(0);
      if (value != usual) given = field.name;
      if (field.none_at_zero && first == nullptr) first = field.name;
      allowed &= field.allowed.contains(value);
    }
    if constexpr (HasTarget<Law>) {
      stage.target =
          reader.optional_number(Law::target.name, Law::target.unit, Law::target.allowed, Law::target.meaning);
      if (stage.target) {
        // What the target makes must not be given; the others may.
        Settings made = settings;
        if (Law::misfit(made, {3, true}) == nullptr || stage.removed)
          reader.mistake(Law::target.name, std::string("contradicts ") + (stage.removed ? Law::removal.name : given) +
                                               "; remove one of them");
        return;
      }
    }
    const char* misfit = Law::misfit(settings, {3, true});
    if (stage.removed && given != nullptr)
      reader.mistake(Law::removal.name, std::string("contradicts ") + given + "; remove one of them");
    else if (!stage.removed && allowed && misfit != nullptr)
      reader.mistake(given != nullptr ? given : first,
                     std::string(given != nullptr ? "contradicts the others, or lacks one" : "is missing") + "; give " +
                         misfit + ", or " + Law::removal.name + " = true");
  }

  std::string misfit(int dimension) const override {
    const char* why = stage.removed || stage.target ? nullptr : Law::misfit(stage.settings, {dimension, true});
    return why == nullptr ? "" : std::string("give ") + why;
  }

  /// Those of the stage, or those that make its target.
  Settings settings_in(const Rve& rve) const {
    Settings settings = stage.settings;
    if constexpr (HasTarget<Law>) {
      const Network net = rve.network();
      const std::vector<GrainPair> pairs = formed_pairs<Law>(net);
      const double pores = pore_volume(net);
      const std::string key = std::string("stage.") + name() + "." + Law::target.name;
      if (stage.target) {
        const char* why = Law::settings_for(*stage.target, pores, pairs.data(), long(pairs.size()), settings);
        if (why != nullptr)
          throw InputError(key + " = " + in_words(*stage.target) + " cannot be reached: " + why +
                           "; give another one, or the settings themselves");
      } else if (const double made = Law::target_of(settings, pores, pairs.data(), long(pairs.size())); made > 1) {
        throw InputError(key + " would be " + in_words(made) + " with these settings; allowed: at most 1; give " +
                         Law::target.name + " instead, or others");
      }
    }
    return settings;
  }

  std::vector<std::string> outside_ranges(const Specimen& specimen) const override {
    if (stage.removed || !is_round(specimen.shape) || specimen.grains.radius.empty()) return {};
    const Rve rve(specimen);
    const Network net = rve.network();
    try {
      return rvelab::outside_ranges(settings_in(rve), pairs_of<Law>(specimen, net), pore_volume(net));
    } catch (const InputError&) {  // the stage says so when it is reached, of the specimen as it is then
      return {};
    }
  }

  void drive(RunningTest& test) const override {
    Interactions all = test.rve.interactions();
    auto& list = static_cast<ListOf<Law>&>(all);
    list.settings.clear();
    if (stage.removed)
      list.items.clear();
    else
      list.settings.push_back(settings_in(test.rve));
    test.rve.set_interactions(all);
  }
};

template <class First, class... Rest>
std::unique_ptr<StageKind> made(int which, TypeList<First, Rest...>) {
  if constexpr (FormsByItself<First>) {
    if (which == 0) return std::make_unique<Forming<First>>();
    --which;
  }
  if constexpr (sizeof...(Rest) > 0)
    return made(which, TypeList<Rest...>{});
  else
    return nullptr;
}

}  // namespace

std::unique_ptr<StageKind> forming_kind(int which) { return made(which, InteractionLaws{}); }

}  // namespace rvelab::protocol
