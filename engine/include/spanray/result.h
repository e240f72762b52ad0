// Errors as values: what went wrong, where, in words for the user.
#pragma once
#include <string>
#include <utility>
#include <variant>

namespace spanray {

struct Error {
  std::string message;
  std::string file = {};  // empty: no file concerned
  int line = 0;      // 1-based; 0: no line concerned
  // "file:line: message", leaving out what is not known.
  std::string to_string() const {
    if (file.empty()) return message;
    return line > 0 ? file + ":" + std::to_string(line) + ": " + message : file + ": " + message;
  }
};

template <class T> class [[nodiscard]] Result {
 public:
  Result(T value) : data_(std::move(value)) {}
  Result(Error error) : data_(std::move(error)) {}
  explicit operator bool() const { return data_.index() == 0; }
  T& value() { return std::get<0>(data_); }
  const T& value() const { return std::get<0>(data_); }
  const Error& error() const { return std::get<1>(data_); }

 private:
  std::variant<T, Error> data_;
};

template <> class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), failed_(true) {}
  explicit operator bool() const { return !failed_; }
  const Error& error() const { return error_; }

 private:
  Error error_;
  bool failed_ = false;
};

}  // namespace spanray
