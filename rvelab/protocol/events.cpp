// Events: conditions that end a stage. Declared in drive.hpp.
#include "rvelab/protocol/drive.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "rvelab/error.hpp"
#include "rvelab/keys/table_reader.hpp"
#include "rvelab/measure/measures.hpp"
#include "rvelab/protocol/protocol.hpp"
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
            {Quantity::text.name, [](Test test) { return Quantity::measure(records::MeasuredState(test.rve)); }});
      }
    });
    list.push_back({"cycles", [](Test test) { return 0.5 * double(test.run.progress.turns); }});
    list.push_back({"visits", [](Test test) {
                      const records::Progress& at = test.run.progress;
                      return double(at.visits[std::size_t(at.stage)]);
                    }});
    return list;
  }();
  return all;
}

std::vector<Event> read_events(TableReader& reader) {
  keys::Choices quantities;
  for (const EventQuantity& each : event_quantities()) quantities.emplace_back(each.name);
  const auto read_event = [&](TableReader& until) {
    Event event;
    event.quantity = until.required_choice(
        "quantity", quantities,
        "quantity that is checked at each record after the first; strain: of the record; eps_v is compression "
        "positive, stresses tension positive; p_over_first: p over p at the start of the stage");
    int given = 0;
    const auto take = [&](const std::optional<double>& value, Event::When when) {
      if (!value) return;
      event.when = when;
      event.value = *value;
      ++given;
    };
    const char* const any = "any finite number";
    take(until.optional_number("above", "1", keys::every, "the stage ends when the quantity is above this, in its unit",
                               "", any),
         Event::When::above);
    take(until.optional_number("below", "1", keys::every, "the stage ends when the quantity is below this, in its unit",
                               "", any),
         Event::When::below);
    take(until.optional_number("falls_by", "1", keys::ratio,
                               "the stage ends when the quantity has fallen by this fraction of its largest value in "
                               "the stage (after a peak)"),
         Event::When::falls_by);
    if (given != 1) until.mistake("quantity", "needs one of above, below, falls_by; allowed: exactly one; give one");
    until.text("then", event.then, "name of the stage that follows, \"end\" for none", "(the next)");
    return event;
  };
  return reader.tables("until", "stage.until", false, "[[stage.until]], any number",
                       "events, each of which ends the stage; not with " + kinds_with_events(false), read_event);
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
    if (above || below || fallen) met = int(k);
  }
  return met;
}

}  // namespace rvelab::protocol
