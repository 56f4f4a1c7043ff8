// Calls of a share of the pool as values: in this process the call is made, between processes its name, arguments and
// result travel as bytes. Any member of Share can be called so, and any function whose first argument is a Share&.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <tuple>
#include <typeinfo>
#include <utility>

#include "rvelab/pool/message.hpp"
#include "rvelab/solver/snapshot.hpp"

namespace rvelab::pool {

class ThreadedPool;
using Share = ThreadedPool;  ///< of a rank: what it holds of a pool over many

/// How a value travels, and what holds it on arrival. Numbers and plain structs: as they lie in memory.
template <class Value>
struct Travel {
  static void put(Packer& to, const Value& value) { to.put(value); }
  static Value take(Unpacker& from) { return from.take<Value>(); }
};
template <class Value>
struct Travel<std::vector<Value>> {
  static void put(Packer& to, const std::vector<Value>& values) { to.put_all(std::span<const Value>(values)); }
  static std::vector<Value> take(Unpacker& from) { return from.take_all<Value>(); }
};
template <>
struct Travel<Specimen> {
  static void put(Packer& to, const Specimen& specimen) { Travel<std::vector<std::byte>>::put(to, to_bytes(specimen)); }
  static Specimen take(Unpacker& from) { return from_bytes(from.take_all<std::byte>()); }
};
/// A span without data stays one: to commit and revert it means all RVEs.
template <class Value>
struct Travel<std::span<const Value>> {
  struct Held {
    bool all;
    std::vector<Value> values;
    operator std::span<const Value>() const {
      static constexpr Value none{};
      return all ? std::span<const Value>() : std::span(values.empty() ? &none : values.data(), values.size());
    }
  };
  static void put(Packer& to, std::span<const Value> values) { to.put(values.data() == nullptr).put_all(values); }
  static Held take(Unpacker& from) {
    const bool all = from.take<bool>();
    return {all, from.take_all<Value>()};
  }
};

/// A function by its parts: `put` writes its arguments, `serve` reads them, calls it and writes its result.
template <class Returned, class... Arguments>
struct SignatureBy {
  using Result = Returned;

  static void put(Packer& to, const std::decay_t<Arguments>&... arguments) {
    (Travel<std::decay_t<Arguments>>::put(to, arguments), ...);
  }
  template <auto function>
  static void serve(Share& share, Unpacker& given, Packer& found) {
    std::tuple<decltype(Travel<std::decay_t<Arguments>>::take(given))...> arguments{
        Travel<std::decay_t<Arguments>>::take(given)...};  // braces: in their order
    const auto call = [&](auto&... each) -> Result { return std::invoke(function, share, std::move(each)...); };
    if constexpr (std::is_void_v<Result>)
      std::apply(call, arguments);
    else
      Travel<Result>::put(found, std::apply(call, arguments));
  }
};
template <class Function>
struct Signature;
template <class Class, class Returned, class... Arguments>
struct Signature<Returned (Class::*)(Arguments...)> : SignatureBy<Returned, Arguments...> {};
template <class Class, class Returned, class... Arguments>
struct Signature<Returned (Class::*)(Arguments...) noexcept> : SignatureBy<Returned, Arguments...> {};
template <class Returned, class... Arguments>
struct Signature<Returned (*)(Share&, Arguments...)> : SignatureBy<Returned, Arguments...> {};

template <auto function>
using SignatureOf = Signature<decltype(function)>;
template <auto function>
using ResultOf = typename SignatureOf<function>::Result;

/// A function under the name by which the share of another rank finds it. It stands in no list: to be called by
/// Pool::at or Pool::everywhere makes it known.
class NamedCall {
 public:
  using Serve = void (*)(Share&, Unpacker& given, Packer& found);

  NamedCall(const char* name, Serve serve) noexcept : name_(name), serve_(serve), next_(std::exchange(last, this)) {}
  NamedCall(const NamedCall&) = delete;
  NamedCall& operator=(const NamedCall&) = delete;

  const char* name() const { return name_; }
  static void serve(std::string_view name, Share& share, Unpacker& given, Packer& found) {
    for (const NamedCall* call = last; call != nullptr; call = call->next_)
      if (name == call->name_) return call->serve_(share, given, found);
    throw Refused(Status::internal, "a message between ranks has an unknown name: please report this");
  }

 private:
  inline static const NamedCall* last = nullptr;

  const char* name_;
  Serve serve_;
  const NamedCall* next_;
};

template <auto function>
struct NameOf;
/// All ranks are of one version, so that a function has the same name on each.
template <auto function>
inline const NamedCall named_call{typeid(NameOf<function>*).name(), &SignatureOf<function>::template serve<function>};

/// In the place of the number of a message: the name of a function follows.
inline constexpr std::int32_t call_by_name = -4;

/// A call on its way to the share that makes it: made there, or its name and arguments and then its result as bytes.
class TravellingCall {
 public:
  virtual void make(Share& share) = 0;
  virtual void put(Packer& to) const = 0;
  virtual void take_result(Unpacker& from) = 0;

 protected:
  ~TravellingCall() = default;
};

/// The call of one function, and its result.
template <auto function, class... Given>
class CallOf final : public TravellingCall {
 public:
  using Result = ResultOf<function>;

  explicit CallOf(const Given&... given) : given_(given...) {}
  void make(Share& share) override {
    const auto call = [&](const Given&... each) -> Result { return std::invoke(function, share, each...); };
    if constexpr (std::is_void_v<Result>)
      std::apply(call, given_);
    else
      result_ = std::apply(call, given_);
  }
  void put(Packer& to) const override {
    to.put(call_by_name).put_text(named_call<function>.name());
    std::apply([&](const Given&... each) { SignatureOf<function>::put(to, each...); }, given_);
  }
  void take_result([[maybe_unused]] Unpacker& from) override {
    if constexpr (!std::is_void_v<Result>) result_ = Travel<Result>::take(from);
  }
  Result result() {
    if constexpr (!std::is_void_v<Result>) return std::move(*result_);
  }

 private:
  std::tuple<const Given&...> given_;
  std::optional<std::conditional_t<std::is_void_v<Result>, bool, Result>> result_;
};

}  // namespace rvelab::pool
