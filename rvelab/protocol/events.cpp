#include "rvelab/protocol/events.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "rvelab/error.hpp"
#include "rvelab/keys/key_builders.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/protocol/protocol_keys.hpp"
#include "rvelab/protocol/stage_kinds.hpp"

namespace rvelab::protocol {

using keys::TableReader;

namespace {

double pressure(const RunningTest& test) { return mean_pressure(test.run.progress.stress, test.dimension()); }
double deviator(const RunningTest& test) { return deviatoric_stress(test.run.progress.stress, test.dimension()); }
template <int i, int j>
double stress(const RunningTest& test) {
  const Matrix3& s = test.run.progress.stress;
  return 0.5 * (s(i, j) + s(j, i));
}

}  // namespace

const std::vector<EventQuantity>& event_quantities() {
  using Test = const RunningTest&;
  static const std::vector<EventQuantity> all = [] {
    std::vector<EventQuantity> list{
        {"strain", [](Test test) { return test.run.result.records.back().strain; }},
        {"eps_v", [](Test test) { return 1 - test.run.progress.deformation.determinant(); }},
        {"eps_q",
         [](Test test) {
           return deviatoric_strain(test.run.progress.deformation - Matrix3::Identity(), test.dimension());
         }},
        {"p_Pa", pressure},
        {"p_over_first", [](Test test) { return pressure(test) / test.run.progress.first_pressure; }},
        {"q_Pa", deviator},
        {"q_over_p", [](Test test) { return deviator(test) / pressure(test); }},
        {"stress_xx_Pa", stress<0, 0>},
        {"stress_yy_Pa", stress<1, 1>},
        {"stress_zz_Pa", stress<2, 2>},
        {"stress_yz_Pa", stress<1, 2>},
        {"stress_xz_Pa", stress<0, 2>},
        {"stress_xy_Pa", stress<0, 1>}};
    records::Quantities::for_each([&]<class Quantity>(std::type_identity<Quantity>, std::uint64_t) {
      if constexpr (std::is_same_v<records::ValueOf<Quantity>, double>) {
        list.push_back(
            {Quantity::text.name, [](Test test) { return Quantity::measure(test.rve, test.rve.network()); }});
      }
    });
    list.push_back({"cycles", [](Test test) { return 0.5 * static_cast<double>(test.run.progress.turns); }});
    list.push_back({"visits", [](Test test) {
                      const records::Progress& at = test.run.progress;
                      return static_cast<double>(at.visits[static_cast<std::size_t>(at.stage)]);
                    }});
    return list;
  }();
  return all;
}

std::vector<keys::TableKey> event_keys() {
  using namespace keys;
  const char* t = "stage.until";
  Choices names;
  for (const EventQuantity& each : event_quantities()) names.emplace_back(each.name);
  return {
      required(
          choice(t, "quantity", names,
                 "quantity that is checked at each record after the first; strain: of the record; eps_v is compression "
                 "positive, stresses tension positive; p_over_first: p over p at the start of the stage",
                 "")),
      with_range(number(t, "above", "1", "", every, "the stage ends when the quantity is above this, in its unit"),
                 "any finite number"),
      with_range(number(t, "below", "1", "", every, "the stage ends when the quantity is below this, in its unit"),
                 "any finite number"),
      number(t, "falls_by", "1", "", ratio,
             "the stage ends when the quantity has fallen by this fraction of its largest value in the stage (after a "
             "peak)"),
      text(t, "then", "(the next)", "name of the stage that follows, \"end\" for none"),
  };
}

std::vector<Event> read_events(TableReader& reader, const Stage& stage, std::vector<keys::KeyError>& errors) {
  std::vector<Event> events;
  toml::array resolved;
  for (const toml::table* table : reader.tables("until")) {
    TableReader until(*table, protocol_keys(), "stage.until",
                      "stage." + stage.name + ".until." + std::to_string(events.size()), keys::line_of(*table), errors);
    Event event;
    event.quantity = until.choice("quantity");
    const auto above = until.optional_number("above"), below = until.optional_number("below"),
               falls_by = until.optional_number("falls_by");
    if (above) event = {event.quantity, Event::When::above, *above, ""};
    if (below) event = {event.quantity, Event::When::below, *below, ""};
    if (falls_by) event = {event.quantity, Event::When::falls_by, *falls_by, ""};
    if (int(above.has_value()) + int(below.has_value()) + int(falls_by.has_value()) != 1) {
      until.mistake("quantity", "needs one of above, below, falls_by; allowed: exactly one; give one");
    }
    event.then = until.text("then", "");
    until.finish();
    resolved.push_back(until.resolved());
    events.push_back(event);
  }
  if (events.empty()) return events;
  reader.resolve("until", resolved);
  if (!stage.what->takes_events()) {
    reader.mistake("until", "has no records to look at in kind = \"" + stage.kind + "\"; allowed: with " +
                                kinds_with_events(true) + "; remove it");
  }
  return events;
}

std::string event_in_words(const Event& event) {
  using When = Event::When;
  const char* const when = event.when == When::above ? " above " : event.when == When::below ? " below " : " fell by ";
  return event.quantity + when + in_words(event.value);
}

int met_event(RunningTest& test, const Stage& stage) {
  records::Progress& at = test.run.progress;
  int met = -1;
  for (std::size_t k = 0; k < stage.until.size(); ++k) {
    const Event& event = stage.until[k];
    const auto& all = event_quantities();
    const auto quantity = std::find_if(all.begin(), all.end(), [&](const auto& q) { return q.name == event.quantity; });
    const double value = quantity->value(test);
    at.largest[k] = std::max(at.largest[k], value);
    if (at.step == 0 || met >= 0) continue;
    const bool above = event.when == Event::When::above && value > event.value;
    const bool below = event.when == Event::When::below && value < event.value;
    const bool fallen = event.when == Event::When::falls_by && value < (1 - event.value) * at.largest[k];
    if (above || below || fallen) met = static_cast<int>(k);
  }
  return met;
}

}  // namespace rvelab::protocol
