// Ctrl-C as a wish, not an end.
#pragma once
#include <csignal>

namespace spanray::demo {

// While one of these lives, the first SIGINT or SIGTERM only makes asked() true; the second ends the program as it always did.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  bool asked() const;

 private:
  struct sigaction before_[2];
};

}  // namespace spanray::demo
