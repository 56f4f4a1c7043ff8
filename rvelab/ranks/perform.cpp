#include "rvelab/ranks/perform.hpp"

#include <utility>

namespace rvelab::ranks {

namespace {

using pool::Status;
using pool::Verdict;

/// The beginning of an answer; what was found follows.
Packer answered(Status status, const char* text, bool failed) {
  return std::move(Packer().make_room(answer_room).put(status).put(failed).put_text(text));
}

}  // namespace

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

void Served::apply(Unpacker& given, Packer& found) {
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
}

void Served::perform(std::int32_t number, Unpacker& given, Packer& found) {
  if (number >= 0) return ShareCalls::serve(number, *share_, given, found);
  switch (RankCall(number)) {
    case RankCall::end:
      return;
    case RankCall::trial:
      return trial(given, found);
    case RankCall::apply:
      return apply(given, found);
    case RankCall::cost: {
      const auto ids = given.take_all<std::int64_t>();
      std::vector<std::int64_t> costs(ids.size());
      share_->cost(ids, costs.data());
      found.put_all(std::span<const std::int64_t>(costs));
      return;
    }
    case RankCall::save:
      for (const std::int64_t id : given.take_all<std::int64_t>()) {
        found.put(share_->is_pending(id));
        found.put_all(std::span<const std::byte>(share_->save(id)));
      }
      return;
    case RankCall::receive:
      while (!given.rest().empty()) {
        const auto pending = given.take<bool>();
        share_->receive(given.take_all<std::byte>(), pending);
      }
      return;
  }
}

Bytes Served::answer(std::span<const std::byte> message) noexcept {
  tried_.clear();
  try {
    try {
      Unpacker given(message);
      const auto number = given.take<std::int32_t>();
      if (number == ShareCalls::number<&pool::Share::settle>()) {
        share_->settle();
        return std::move(settled_);
      }
      if (number == ShareCalls::number<&pool::Share::prepare>()) settled_ = answered(Status::ok, "", false).take();
      // Whether there is memory for an answer or not.
      if (number == ShareCalls::number<&pool::Share::forget_received>()) share_->forget_received();
      Packer found = answered(Status::ok, "", false);
      perform(number, given, found);
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
