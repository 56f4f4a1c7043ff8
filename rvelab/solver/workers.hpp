// A team of threads for independent pieces of work. Which thread does which piece must not matter to the result.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace rvelab {

class Workers {
 public:
  /// `threads` in all, the caller's included; 0 counts as 1.
  explicit Workers(unsigned threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  unsigned threads() const;

  /// Calls work(0) .. work(count - 1), each once, each on some thread, in no order; returns when all are done. An
  /// exception of a piece does not stop the others; the one of the lowest piece is thrown at the end.
  void run(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  struct Team;
  std::unique_ptr<Team> team_;
};

}  // namespace rvelab
