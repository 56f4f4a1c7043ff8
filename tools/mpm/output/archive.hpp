// What a checkpoint holds, each part described once: the same visit of its numbers writes and reads it.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "rvelab/io/hdf5/file.hpp"
#include "tools/mpm/error.hpp"

namespace mpm {

// Each number of what takes part in a description.
template <class Visit, class Number>
requires std::is_arithmetic_v<Number>
void each_number(const Visit& visit, Number& number) { visit(number); }
template <class Visit, class Derived>
void each_number(const Visit& visit, Eigen::PlainObjectBase<Derived>& matrix) {
  for (double& x : matrix.reshaped()) visit(x);
}
template <class Visit>
void each_number(const Visit& visit, Eigen::Quaterniond& orientation) {
  for (double& x : orientation.coeffs()) visit(x);
}
template <class Visit, class Part>
void each_number(const Visit& visit, std::vector<Part>& parts) {
  for (Part& part : parts) each_number(visit, part);
}
template <class Visit, class... Parts>
requires(sizeof...(Parts) > 1) void each_number(const Visit& visit, Parts&... parts) {
  (each_number(visit, parts), ...);
}

class Archive {
 public:
  /// Into a file, or out of one. `folder`: the run's, for messages.
  Archive(rvelab::io::Hdf5File& file, std::string folder, bool reads)
      : file_(file), folder_(std::move(folder)), reads_(reads) {}
  bool reads() const { return reads_; }
  rvelab::io::Hdf5File& file() { return file_; }

  /// Doubles, or whole numbers as int64, which describe(visit) visits by reference; in rows of `width`. Reading:
  /// InputError where the file has another number of them, or one that is not finite, but for NaN in the column
  /// `undefined`.
  template <class Value = double, class Describe>
  void numbers(const std::string& name, const Describe& describe, std::size_t width = 1,
               std::size_t undefined = std::size_t(-1)) {
    std::vector<Value> values;
    if (!reads_) {
      describe([&](auto& each) { values.push_back(Value(each)); });
      using Shape = rvelab::io::Shape64;
      file_.write<Value>("/" + name, values, width == 1 ? Shape{values.size()} : Shape{values.size() / width, width});
      return;
    }
    values = file_.read<Value>("/" + name);
    std::size_t wanted = 0, k = 0;
    describe([&](auto&) { ++wanted; });
    if (wanted != values.size()) of_another_scene(name, values.size() / width, wanted / width);
    describe([&](auto& each) {
      const auto value = double(values[k]);
      const std::size_t row = k / width, column = k % width;
      if (!std::isfinite(value) && !(column == undefined && std::isnan(value))) {
        no_state(name + "[" + std::to_string(row) + (width == 1 ? "" : ", " + std::to_string(column)) + "]", value,
                 "a finite number");
      }
      each = std::decay_t<decltype(each)>(values[k++]);
    });
  }
  /// Lists of any length; describe(visit, item).
  template <class Item, class Describe>
  void items(const std::string& name, std::vector<Item>& all, const Describe& describe) {
    if (!reads_) {
      numbers(name, [&](const auto& visit) {
        for (Item& item : all) describe(visit, item);
      });
      return;
    }
    const auto values = file_.read<double>("/" + name);
    all.clear();
    for (std::size_t k = 0; k < values.size();) {
      const auto take = [&](auto& each) {
        if (k >= values.size()) of_another_scene(name, values.size(), k + 1);
        each = std::decay_t<decltype(each)>(values[k++]);
      };
      describe(take, all.emplace_back());
    }
  }
  template <class Value>
  void list(const std::string& name, std::vector<Value>& values) {
    using Stored = std::conditional_t<std::is_integral_v<Value>, std::int64_t, double>;
    if (reads_) {
      const auto read = file_.read<Stored>("/" + name);
      values.assign(read.begin(), read.end());
    } else {
      file_.write<Stored>("/" + name, std::vector<Stored>(values.begin(), values.end()), {values.size()});
    }
  }

  [[noreturn]] void refuse(const std::string& why) const { throw InputError(folder_ + ": " + why); }
  [[noreturn]] void of_another_scene(const std::string& what, std::size_t found, std::size_t wanted) const {
    refuse("its checkpoint holds " + std::to_string(found) + " " + what + ", this scene needs " +
           std::to_string(wanted) + "; leave out the --set that changes their number, or start the run again in " +
           "another folder");
  }
  /// Of a checkpoint that was edited and sealed again.
  [[noreturn]] void no_state(const std::string& what, double value, const std::string& allowed) const {
    refuse("checkpoint.h5: " + what + " = " + in_words(value) + "; allowed: " + allowed +
           "; put the file back from a copy, or start the run again");
  }

 private:
  rvelab::io::Hdf5File& file_;
  std::string folder_;
  bool reads_;
};

}  // namespace mpm
