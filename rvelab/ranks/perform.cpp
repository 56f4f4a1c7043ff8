#include "rvelab/ranks/perform.hpp"

#include <array>
#include <iterator>
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
  std::vector<std::int64_t> tokens_out(wanted.tokens_out ? n : 0), costs(n);
  std::vector<std::int32_t> status(n);
  batch.n = std::int64_t(n);
  batch.ids = ids.data();
  batch.places = places.data();
  batch.dH = gradients.data();
  batch.tokens_in = wanted.tokens_in ? tokens.data() : nullptr;
  batch.status = status.data();
  batch.tokens_out = wanted.tokens_out ? tokens_out.data() : nullptr;
  std::size_t room = answer_room + n * (sizeof status[0] + sizeof costs[0]) + tokens_out.size() * sizeof tokens_out[0];
  std::vector<double> values[std::size(pool::batch_outputs)];
  for (std::size_t k = 0; k < std::size(values); ++k) {
    if ((wanted.outputs >> k & 1) == 0) continue;
    values[k].resize(pool::batch_outputs[k].each * n);
    batch.*pool::batch_outputs[k].values = values[k].data();
    room += values[k].size() * sizeof(double);
  }
  tried_ = ids;
  found.make_room(room);
  const Verdict worst = share_->trial(batch);
  share_->cost(ids, costs.data());
  found.put_text(worst.text).put_all(std::span<const std::int32_t>(status));
  found.put_all(std::span<const std::int64_t>(costs));
  for (const auto& each : values) found.put_all(std::span<const double>(each));
  found.put_all(std::span<const std::int64_t>(tokens_out));
}

void Served::apply(Unpacker& given, Packer& found) {
  const auto id = given.take<std::int64_t>();
  const auto dt = given.take<double>();
  const auto gradient = given.take<std::array<double, 9>>();
  std::array<double, 9> stress;
  const Verdict verdict = share_->apply(id, pool::tensor_at(gradient.data()), dt, stress.data());
  std::int64_t cost = 0;
  share_->cost({&id, 1}, &cost);
  found.put(verdict.status).put_text(verdict.text).put(cost).put(stress);
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
      if (number == std::int32_t(RankCall::trial))
        trial(given, found);
      else if (number == std::int32_t(RankCall::apply))
        apply(given, found);
      else if (number == pool::call_by_name)
        share_->serve(given.take_text(), given, found);
      else
        ShareCalls::serve(number, *share_, given, found);
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
