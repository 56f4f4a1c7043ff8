#include "rvelab/ranks/perform.hpp"

#include <algorithm>
#include <utility>

#include "rvelab/pool/rve_state.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::ranks {

namespace {

using pool::Status;
using pool::Verdict;

std::span<const std::int64_t> ids_or_all(const std::vector<std::int64_t>& ids, bool all) {
  if (all) return {};
  static constexpr std::int64_t none = 0;  // a pointer that is not null: no ids are meant, not all
  return {ids.empty() ? &none : ids.data(), ids.size()};
}

/// Each number of an Info, tensors by their elements.
template <class Info, class Field>
void each_field(Info& info, Field field) {
  field(info.cell.dimension);
  for (int k = 0; k < 9; ++k) field(info.cell.lattice(k / 3, k % 3));
  for (int k = 0; k < 9; ++k) field(info.cell.rotation(k / 3, k % 3));
  field(info.cell.increments);
  field(info.grains);
  field(info.contacts);
  field(info.void_ratio);
  field(info.coordination_number);
  for (int k = 0; k < 9; ++k) field(info.fabric(k / 3, k % 3));
  field(info.fabric_anisotropy);
  field(info.sliding_fraction);
  field(info.p);
  field(info.q);
  field(info.unbalanced_force_ratio);
  field(info.inertial_number);
  field(info.permeability_ratio);
  field(info.min_height_ratio);
  field(info.grain_steps);
  field(info.memory.state);
  field(info.memory.list);
  field(info.memory.working);
  field(info.memory.trial);
  field(info.token);
}

/// Begins an answer; what was found follows.
Packer answered(Status status, const char* text, bool failed) {
  return std::move(Packer().make_room(answer_room).put(status).put(failed).put_text(text));
}

}  // namespace

pool::Info take_info(Unpacker& from) {
  pool::Info info;
  each_field(info, [&](auto& value) { value = from.take<std::decay_t<decltype(value)>>(); });
  return info;
}

void Served::trial(Unpacker& given, Packer& found) {
  pool::Batch batch;
  batch.dt = given.take<double>();
  const auto wanted = given.take<Wanted>();
  const auto ids = given.take_all<std::int64_t>(), places = given.take_all<std::int64_t>(),
             tokens = given.take_all<std::int64_t>();
  const auto gradients = given.take_all<double>();
  const std::size_t n = ids.size();
  std::vector<double> stress(9 * n), contact, reynolds, tangent, estimate, scale(n);
  std::vector<std::int64_t> tokens_out(wanted.tokens_out ? n : 0), costs(n);
  std::vector<std::int32_t> status(n);
  const auto asked = [n](bool is, std::vector<double>& values, std::size_t each) {
    if (is) values.resize(each * n);
    return is ? values.data() : nullptr;
  };
  batch.n = std::int64_t(n);
  batch.ids = ids.data();
  batch.places = places.data();
  batch.displacement_gradients = gradients.data();
  batch.tokens_in = wanted.tokens_in ? tokens.data() : nullptr;
  batch.stress = stress.data();
  batch.contact_stress = asked(wanted.contact_stress, contact, 9);
  batch.reynolds_stress = asked(wanted.reynolds_stress, reynolds, 9);
  batch.tangent = asked(wanted.tangent, tangent, 36);
  batch.error_estimate = asked(wanted.error_estimate, estimate, 1);
  batch.dt_scale = scale.data();
  batch.status = status.data();
  batch.tokens_out = wanted.tokens_out ? tokens_out.data() : nullptr;
  tried_ = ids;
  std::size_t room = answer_room + n * (sizeof status[0] + sizeof costs[0]) + tokens_out.size() * sizeof tokens_out[0];
  for (const auto* values : {&stress, &contact, &reynolds, &tangent, &estimate, &scale})
    room += values->size() * sizeof(double);
  found.make_room(room);
  const Verdict worst = share_->trial(batch);
  share_->cost(ids, costs.data());
  found.put_text(worst.text);
  found.put_all(std::span<const std::int32_t>(status)).put_all(std::span<const std::int64_t>(costs));
  for (const auto* values : {&stress, &contact, &reynolds, &tangent, &estimate, &scale})
    found.put_all(std::span<const double>(*values));
  found.put_all(std::span<const std::int64_t>(tokens_out));
}

void Served::perform(Call call, Unpacker& given, Packer& found) {
  switch (call) {
    case Call::end:
      return;
    case Call::add_template: {
      const auto number = given.take<std::int64_t>();  // 0: this is the first rank, whose own number it will be
      const std::int64_t own = share_->add_template(from_bytes(given.rest()));
      try {
        templates_[number != 0 ? number : own] = own;
      } catch (...) {
        share_->release_template(own);
        throw;
      }
      found.put(own);
      return;
    }
    case Call::release_template: {  // one that this share has not is released already
      const auto own = templates_.find(given.take<std::int64_t>());
      if (own == templates_.end()) return;
      share_->release_template(own->second);
      templates_.erase(own);
      return;
    }
    case Call::spawn: {
      const auto number = given.take<std::int64_t>();
      const auto own = templates_.find(number);  // the share refuses a number that it does not know
      share_->spawn_as(own == templates_.end() ? number : own->second, given.take_all<std::int64_t>());
      return;
    }
    case Call::clone: {
      const auto source = given.take<std::int64_t>();
      share_->clone_as(source, given.take<std::int64_t>());
      return;
    }
    case Call::give_up:
      share_->give_up(given.take_all<std::int64_t>());
      return;
    case Call::apply: {
      const auto id = given.take<std::int64_t>();
      const auto dt = given.take<double>();
      Matrix3 gradient;
      for (int k = 0; k < 9; ++k) gradient(k / 3, k % 3) = given.take<double>();
      double stress[9];
      const Verdict verdict = share_->apply(id, gradient, dt, stress);
      std::int64_t cost = 0;
      share_->cost({&id, 1}, &cost);
      found.put(verdict.status).put_text(verdict.text).put(cost);
      for (const double component : stress) found.put(component);
      return;
    }
    case Call::trial:
      trial(given, found);
      return;
    case Call::prepare: {
      const auto what = given.take<pool::Settling>();
      const auto all = given.take<bool>();
      const auto ids = given.take_all<std::int64_t>(), places = given.take_all<std::int64_t>();
      settled_ = answered(Status::ok, "", false).take();
      share_->prepare(what, ids_or_all(ids, all), places);
      return;
    }
    case Call::settle:  // answered before
      return;
    case Call::cost: {
      const auto ids = given.take_all<std::int64_t>();
      std::vector<std::int64_t> costs(ids.size());
      share_->cost(ids, costs.data());
      found.put_all(std::span<const std::int64_t>(costs));
      return;
    }
    case Call::info: {
      const pool::Info info = share_->info(given.take<std::int64_t>());
      each_field(info, [&](const auto& value) { found.put(value); });
      return;
    }
    case Call::save:
      for (const std::int64_t id : given.take_all<std::int64_t>()) {
        found.put(share_->is_pending(id));
        found.put_all(std::span<const std::byte>(share_->save(id)));
      }
      return;
    case Call::load: {
      const auto id = given.take<std::int64_t>();
      share_->load(id, given.rest());
      return;
    }
    case Call::receive:
      while (!given.rest().empty()) {
        const auto pending = given.take<bool>();
        share_->receive(given.take_all<std::byte>(), pending);
      }
      return;
    case Call::place:
      share_->place(given.take_all<std::int64_t>());
      return;
    case Call::forget_received:
      share_->forget_received();
      return;
  }
}

Bytes Served::answer(std::span<const std::byte> message) noexcept {
  tried_.clear();
  try {
    try {
      Unpacker given(message);
      const auto call = given.take<Call>();
      if (call == Call::settle) {
        share_->settle();
        return std::move(settled_);
      }
      if (call == Call::forget_received) share_->forget_received();  // whether there is room for an answer or not
      Packer found = answered(Status::ok, "", false);
      perform(call, given, found);
      return found.take();
    } catch (...) {
      char text[1024];
      const Status status = pool::status_of_exception(text, sizeof text);
      if (!tried_.empty()) share_->revert(tried_);  // of what fails no trial is pending
      return answered(status, text, true).take();
    }
  } catch (...) {
    return {};
  }
}

Answer::Answer(Bytes bytes) : bytes_(std::move(bytes)), found_(bytes_) {
  if (bytes_.empty()) {
    status_ = Status::no_memory;
    text_ = "a rank has no memory left for its answer; use fewer RVEs, or more ranks";
    failed_ = true;
    return;
  }
  status_ = found_.take<Status>();
  failed_ = found_.take<bool>();
  text_ = found_.take_text();
}

void Answer::expect_done() const {
  if (failed_) throw pool::Refused(status_, std::string(text_));
}

}  // namespace rvelab::ranks
