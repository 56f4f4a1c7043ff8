#include "rvelab/pool/status.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

namespace rvelab::pool {

namespace {

Status reported(Status status, const char* what, char* text, std::size_t size) noexcept {
  const std::size_t length = std::min(std::strlen(what), size - 1);
  std::memcpy(text, what, length);
  text[length] = '\0';
  return status;
}

}  // namespace

Status status_of_exception(char* text, std::size_t size) noexcept {
  try {
    throw;
  } catch (const Refused& refused) {
    return reported(refused.status, refused.what(), text, size);
  } catch (const Interrupted&) {
    return reported(Status::interrupted, "stopped by rvelab_interrupt; the RVE is as before the call", text, size);
  } catch (const IncrementFailed& failed) {
    return reported(Status::discard, failed.what(), text, size);
  } catch (const InputError& error) {
    return reported(Status::bad_input, error.what(), text, size);
  } catch (const std::bad_alloc&) {
    return reported(Status::no_memory, "there is not enough memory; free some, or use fewer or smaller RVEs", text,
                    size);
  } catch (const std::length_error&) {
    return reported(Status::no_memory, "more memory was asked for than there can be; use fewer RVEs", text, size);
  } catch (const std::exception& error) {
    return reported(Status::internal, error.what(), text, size);
  } catch (...) {
    return reported(Status::internal, "an exception of no known kind", text, size);
  }
}

Verdict verdict_of_failure() noexcept {
  char text[1024];
  Verdict verdict{status_of_exception(text, sizeof text), {}};
  try {
    verdict.text = text;
  } catch (...) {  // no memory for words: the status says it
  }
  return verdict;
}

void put_before(Verdict& verdict, const char* words) noexcept {
  try {
    verdict.text.insert(0, words);
  } catch (const std::bad_alloc&) {
  }
}

Verdict of_entry(Verdict verdict, std::int64_t entry, std::int64_t id) noexcept {
  if (verdict.status == Status::ok) return verdict;
  char words[96];
  std::snprintf(words, sizeof words, "entry %lld (id %lld): ", static_cast<long long>(entry),
                static_cast<long long>(id));
  put_before(verdict, words);
  return verdict;
}

}  // namespace rvelab::pool
