// Calls of a share of the pool as values: in this process the call is made, between processes its number, arguments and
// result travel as bytes. Any virtual function of Share can be called so that stands in ShareCalls (threaded_pool.hpp).
#pragma once

#include <functional>
#include <optional>
#include <tuple>
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

/// A member function by its parts: `put` writes its arguments, `serve` reads them, calls it and writes its result.
template <class Function>
struct Signature;
template <class Class, class Returned, class... Arguments>
struct Signature<Returned (Class::*)(Arguments...)> {
  using Result = Returned;

  static void put(Packer& to, const std::decay_t<Arguments>&... arguments) {
    (Travel<std::decay_t<Arguments>>::put(to, arguments), ...);
  }
  template <auto function>
  static void serve(Share& share, Unpacker& given, Packer& found) {
    std::tuple<decltype(Travel<std::decay_t<Arguments>>::take(given))...> arguments{
        Travel<std::decay_t<Arguments>>::take(given)...};  // braces: in their order
    const auto call = [&](auto&... each) -> Result { return (share.*function)(std::move(each)...); };
    if constexpr (std::is_void_v<Result>)
      std::apply(call, arguments);
    else
      Travel<Result>::put(found, std::apply(call, arguments));
  }
};
template <class Class, class Returned, class... Arguments>
struct Signature<Returned (Class::*)(Arguments...) noexcept> : Signature<Returned (Class::*)(Arguments...)> {};

template <auto function>
using SignatureOf = Signature<decltype(function)>;
template <auto function>
using ResultOf = typename SignatureOf<function>::Result;

/// Member functions that travel; the place of each is its number in a message.
template <auto... functions>
class CallList {
 public:
  template <auto wanted>
  static constexpr std::int32_t number() {
    std::int32_t at = 0, found = -1;
    ((std::is_same_v<Name<wanted>, Name<functions>> ? found = at++ : at++), ...);
    return found;
  }
  /// Number and arguments.
  template <auto function, class... Arguments>
  static void put(Packer& to, const Arguments&... arguments) {
    static_assert(number<function>() >= 0, "the function is missing in the list of calls");
    to.put(number<function>());
    SignatureOf<function>::put(to, arguments...);
  }
  /// Calls the function of that number.
  static void serve(std::int32_t number, Share& share, Unpacker& given, Packer& found) {
    std::int32_t at = 0;
    const bool known =
        ((at++ == number && (SignatureOf<functions>::template serve<functions>(share, given, found), true)) || ...);
    if (!known) throw Refused(Status::internal, "a message between ranks has an unknown number: please report this");
  }

 private:
  template <auto>
  struct Name;
};

/// A call on its way to the share that makes it: made there, or its number and arguments and then its result as bytes.
struct TravellingCall {
  std::function<void(Share&)> make;
  std::function<void(Packer&)> put;
  std::function<void(Unpacker&)> take_result;
};

/// The call of one function in `Calls`, by `way`(call); its result.
template <class Calls, auto function, class Way, class... Given>
ResultOf<function> travelled(const Way& way, const Given&... given) {
  using Result = ResultOf<function>;
  if constexpr (std::is_void_v<Result>) {
    way({[&](Share& share) { (share.*function)(given...); },
         [&](Packer& to) { Calls::template put<function>(to, given...); }, [](Unpacker&) {}});
  } else {
    std::optional<Result> result;
    way({[&](Share& share) { result = (share.*function)(given...); },
         [&](Packer& to) { Calls::template put<function>(to, given...); },
         [&](Unpacker& from) { result = Travel<Result>::take(from); }});
    return std::move(*result);
  }
}

}  // namespace rvelab::pool
