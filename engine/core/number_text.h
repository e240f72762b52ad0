// Numbers in messages and files.
#pragma once
#include <charconv>
#include <string>

namespace spanray {

// Shortest decimal that reads back as the very same number; independent of the locale.
template <class T> std::string number_text(T value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace spanray
